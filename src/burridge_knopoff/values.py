"""Input checks: which values are numbers, and the one-line error for a refused value."""

from __future__ import annotations

import math
import re
from collections.abc import Iterable, Iterator, Mapping
from difflib import SequenceMatcher
from functools import cached_property
from inspect import getattr_static
from typing import Any, TypeVar

import numpy as np

_T = TypeVar("_T")

#: Patterns of a whole number and of any other number in a text: decimal, in ASCII digits, without underscores. A whole
#: number has no leading zero, with which YAML would read it as octal.
WHOLE_NUMBER = r"[-+]?(?:0|[1-9][0-9]*)"
OTHER_NUMBER = r"[-+]?(?:[0-9]+\.[0-9]*|\.[0-9]+|[0-9]+(?=[eE]))(?:[eE][-+]?[0-9]+)?"

#: Most numbers of one kind that a run or a job keeps: 800 MB.
MOST_NUMBERS = 1e8
#: Most characters of a value in a message.
LONGEST = 60
#: Least share of common letters of two close names, and least number of letters that stand for a longer name.
_CLOSE, _START = 0.6, 3
#: Most bits of a whole number that is written in decimals; Python refuses 4300 digits and more.
MOST_BITS = 10_000


def scalar(value: Any) -> Any:
    """Return the element of an array without dimensions; any other value as it is."""
    return np.asanyarray(value)[()] if getattr(value, "ndim", None) == 0 else value


def real_number(value: Any) -> float:
    """Return a real number as a float; NaN for anything else, such as True, a complex number or a time of numpy."""
    value = scalar(value)
    if isinstance(value, bool | np.timedelta64) or not isinstance(value, int | float | np.integer | np.floating):
        return math.nan
    try:
        return float(value)
    except OverflowError:
        return math.nan


def number_in(text: str) -> int | float | None:
    """Return the number that a text is, by WHOLE_NUMBER and OTHER_NUMBER; None for any other text.

    Python's own conversion also accepts 010, 1_0 for ten, and digits of every script.
    """
    try:
        return (
            int(text) if re.fullmatch(WHOLE_NUMBER, text) else float(text) if re.fullmatch(OTHER_NUMBER, text) else None
        )
    # Python refuses whole numbers of more than 4300 digits.
    except ValueError:
        return None


def real_array(values: Any, key: str) -> np.ndarray:
    """Return real numbers of any shape, NaN where masked; raises ValueError, one line, for anything else."""
    try:
        array = np.ma.asarray(values)
    except ValueError:
        array = np.ma.asarray(None)
    if array.dtype.kind not in "iuf":
        raise refusal(key, values, "an array of numbers")
    # A matrix of numpy would stay one, whose products and indices are others than those of arrays.
    return np.asarray(np.ma.filled(array.astype(float), math.nan))


def read_only_copy(array: np.ndarray) -> np.ndarray:
    """Return a read-only copy of an array, for values that are computed once and shared."""
    array = np.array(array)
    array.setflags(write=False)
    return array


def own_attributes(value: Any) -> dict[str, Any]:
    """Return the attributes of an object except its cached properties, which follow from the others."""
    kind = type(value)
    return {
        name: item
        for name, item in vars(value).items()
        if not isinstance(getattr_static(kind, name, None), cached_property)
    }


class Unchanging:
    """An object whose copies and pickles recompute its cached properties, since copied arrays would be writable."""

    def __getstate__(self) -> dict[str, Any]:
        return own_attributes(self)


def instance_of(value: Any, kind: type[_T], key: str) -> _T:
    """Return a value if it is an instance of a class; raises ValueError, one line, otherwise."""
    if not isinstance(value, kind):
        raise refusal(key, value, f"{'an' if kind.__name__[0] in 'AEIOU' else 'a'} {kind.__name__}")
    return value


def each_instance_of(values: Any, kind: type[_T], key: str) -> list[_T]:
    """Return a list of values if all are instances of a class; raises ValueError, one line, otherwise."""
    if isinstance(values, str | Mapping) or not isinstance(values, Iterable):
        raise refusal(key, values, f"a list, each {kind.__name__}")
    return [instance_of(value, kind, f"{key}[{number}]") for number, value in enumerate(values)]


def refusal(key: str, value: Any, allowed: object) -> ValueError:
    """Return the error of a refused value: `key: got X, expected Y`."""
    return ValueError(f"{key}{': ' if key else ''}got {format_value(value)}, expected {allowed}")


def suggestion(name: Any, known: Iterable[str]) -> str:
    """Return ` (did you mean X?)` with the known name closest to an unknown one; empty if none is close.

    Case does not count, and equal first letters count more than others (W. E. Winkler, Proc. Section on Survey Research
    Methods, Am. Stat. Assoc. (1990) 354-359): nobody who writes `linear` means `nonlinear`.
    """
    if not isinstance(name, str) or len(name) > LONGEST:
        return ""
    folded, near = name.casefold(), []
    for word in known:
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
    else:
        yield _written(value)


def _written(value: Any) -> str:
    try:
        # A number of numpy is shown as a plain number.
        return str(value) if isinstance(value, np.number | np.bool) and value.dtype.kind != "m" else repr(value)
    # The `repr` of any object may fail.
    except Exception:
        return f"a {type(value).__name__}"
