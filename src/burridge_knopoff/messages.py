"""The words of messages: a refused value, the closest known name, values as texts of one line, and commands."""

from __future__ import annotations

import os
import re
import shlex
from collections.abc import Iterable, Iterator, Mapping, Sequence
from difflib import SequenceMatcher
from typing import Any

import numpy as np

#: Most characters of a value in a message.
LONGEST = 60
#: Least share of common letters of two close names, and least number of letters that stand for a longer name.
_CLOSE, _START = 0.6, 3
#: Most bits of a whole number that is written in decimals; Python refuses 4300 digits and more.
MOST_BITS = 10_000
#: Keys of earlier configs, and their present names.
RENAMED = {"fraction_samples": "fraction_width", "pushes": "perturbations"}


def refusal(key: str, value: Any, allowed: object) -> ValueError:
    """Return the error of a refused value: `key: got X, expected Y`."""
    return ValueError(f"{key}{': ' if key else ''}got {format_value(value)}, expected {allowed}")


def suggestion(name: Any, words: Iterable[str]) -> str:
    """Return ` (did you mean X?)` with the known name closest to an unknown one; empty if none is close.

    Case does not count, and equal first letters count more than others (W. E. Winkler, Proc. Section on Survey Research
    Methods, Am. Stat. Assoc. (1990) 354-359): nobody who writes `linear` means `nonlinear`.
    """
    if not isinstance(name, str) or len(name) > LONGEST:
        return ""
    folded, near = name.casefold(), []
    for word in words:
        meant = word.casefold()
        ratio = SequenceMatcher(None, folded, meant).ratio()
        if ratio >= _CLOSE or (len(folded) >= _START and meant.startswith(folded)):
            shared = sum(folded[:k] == meant[:k] for k in (1, 2, 3, 4))
            near.append((ratio + 0.1 * shared * (1.0 - ratio), word))
    return f" (did you mean {max(near, key=lambda pair: pair[0])[1]}?)" if near else ""


def cut(text: str, longest: int = LONGEST) -> str:
    """Return a text as one printable line, cut if it is long."""
    # Only the head is read, however long the text is.
    head = escape_unprintable(" ".join(text[: 4 * longest].split()))
    return head if len(head) <= longest and len(text) <= 4 * longest else f"{head[: longest - 3]}..."


def escape_unprintable(text: str) -> str:
    """Return a text with escapes for unprintable characters, such as a line break in the name of a file."""
    return "".join(letter if letter.isprintable() else ascii(letter)[1:-1] for letter in text)


def command(*words: str | os.PathLike[str]) -> str:
    """Return a command for a shell, quoted word by word; unprintable characters as in $'two\\x0alines'.

    Every command that is printed is made here, since its words may come from files.
    """
    return " ".join(_quote(os.fspath(word)) for word in words)


def _quote(word: str) -> str:
    if word.isprintable():
        return shlex.quote(word)
    escapes = {"\\": "\\\\", "'": "\\'"}
    letters = (
        escapes.get(letter, letter)
        if letter.isprintable()
        else "".join(f"\\x{byte:02x}" for byte in letter.encode(errors="surrogateescape"))
        for letter in word
    )
    return f"$'{''.join(letters)}'"


def format_value(value: Any) -> str:
    """Return any value as Python writes it, in one line and cut.

    Only the part that is shown is written: with aliases, a few bytes of YAML can describe a very long value.
    """
    text = ""
    for part in _parts(value):
        if len(text) > LONGEST:
            return cut(text + "." * LONGEST)
        text += part
    return cut(text)


def full_key(key: str, name: Any) -> str:
    """Return the full key of an entry; a name with unusual characters is quoted, and a long name is cut."""
    plain = isinstance(name, str) and re.fullmatch(r"[A-Za-z0-9_.+-]+", name)
    words = cut(name) if plain else cut(ascii(name[: LONGEST + 1])) if isinstance(name, str) else format_value(name)
    return f"{key}.{words}" if key else words


def _parts(value: Any) -> Iterator[str]:
    """Yield a value piece by piece, as `repr` writes it; each level of nesting yields before it goes deeper."""
    kind = type(value)
    if isinstance(value, str | bytes | bytearray):
        yield repr(value[: LONGEST + 1])
    elif kind in (list, tuple, set, frozenset) and value:
        brackets: dict[type, tuple[str, str]] = {list: ("[", "]"), tuple: ("(", ")"), set: ("{", "}")}
        first, last = brackets.get(kind, ("frozenset({", "})"))
        yield first
        for position, item in enumerate(value):
            yield ", " if position else ""
            yield from _parts(item)
        yield f",{last}" if kind is tuple and len(value) == 1 else last
    elif isinstance(value, Mapping):
        yield "{"
        for position, (key, item) in enumerate(value.items()):
            yield ", " if position else ""
            yield from _parts(key)
            yield ": "
            yield from _parts(item)
        yield "}"
    elif isinstance(value, int) and value.bit_length() > MOST_BITS:
        yield f"{'-' * (value < 0)}0x{abs(value) >> (abs(value).bit_length() - 4 * LONGEST):x}..."
    elif getattr(getattr(value, "dtype", None), "kind", "") == "O":
        yield f"{kind.__name__} of objects"
    elif hasattr(value, "__array__") and kind is not np.ndarray and np.ndim(value) > 0:
        yield f"{kind.__name__} of shape {np.shape(value)}"
    elif isinstance(value, Iterator):
        yield f"a {kind.__name__}"
    else:
        yield _written(value)


def _written(value: Any) -> str:
    try:
        # A number of numpy is shown as a plain number.
        return str(value) if isinstance(value, np.number | np.bool) and value.dtype.kind != "m" else repr(value)
    # The `repr` of any object may fail.
    except Exception:
        return f"a {type(value).__name__}"


def unknown_key_error(place: str, name: Any, allowed: Sequence[str]) -> ValueError:
    """Return the error for an unknown key, with its present name or the closest known key, otherwise all known keys."""
    renamed = f" (renamed to {RENAMED[name]})" if RENAMED.get(name) in allowed else ""
    hint = renamed or suggestion(name, allowed) or f", expected one of: {', '.join(allowed)}"
    return ValueError(f"{full_key(place, name)}: unknown key{hint}")
