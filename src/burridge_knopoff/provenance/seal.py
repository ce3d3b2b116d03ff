"""The seal of a file of results: a description of its content, the status of its run, and the SHA-256 of its bytes.

HDF5 itself detects neither a changed number nor overwritten bytes, and nothing in a picture or a text says which study
it belongs to. The seal is one line. In a netCDF file it is the last line, after the HDF5 data, since netCDF programs do
not read past the end recorded by HDF5. The seal of a text or a picture is in a file next to it, `.<name>.seal`.

The description is a mapping in the types of JSON. That of a point contains the `bk simulate` command and the
fingerprint of the sources. That of any other file of a study contains the name of the file, the part of the config on
which it depends, the fingerprint of the sources that make it, and a digest of the description of each input.
`jobs.Jobs.abouts` returns the expected descriptions.
"""

from __future__ import annotations

import hashlib
import json
import re
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.difference import difference
from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.record import remake_command
from burridge_knopoff.values import escape_unprintable

_MARK = b"\n#seal "
_SEAL = re.compile(rb"\n#seal (.+) ([a-z_]+) ([0-9a-f]{64})\n\Z")
#: Suffixes of the files that contain their seals: netCDF files and cached results.
_SEALED_INSIDE = (".nc", "")
#: Keys of a description that depend on the sources, as the digests of inputs do.
SOURCE_KEYS = ("make", "of_points", "sources")
#: Keys whose difference is reported last, since it may follow from others.
_LAST = ("inputs", "sources")
#: Separates the reason why a file must not be used from the command that recreates it.
REMEDY = "; remake it: "
#: Maximum length of a value in a message.
_LONGEST = 60


class BadFile(ValueError):
    """The error of a file of results that must not be used: one line with file, reason and the command to recreate it.

    kind : missing, corrupt, or stale if the file is intact
    """

    def __init__(self, path: str | Path, reason: str, kind: str = "stale") -> None:
        self.path, self.reason, self.kind = Path(path), reason, kind
        super().__init__(f"{escape_unprintable(str(path))}: {reason}{REMEDY}{remake_command(path)}")


def identity(*parts: str) -> str:
    """Return 16 hexadecimal digits for texts."""
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def canonical_json(about: Any) -> str:
    """Return a description as one line of JSON; the order matters, such as that of the laws in a summary."""
    return json.dumps(about, separators=(",", ":"))


def seal_path(path: str | Path) -> Path:
    """Return the file that contains the seal: the file itself or, for a text or a picture, one next to it."""
    path = Path(path)
    return path if path.suffix in _SEALED_INSIDE else path.with_name(f".{path.name}.seal")


def write_sealed(
    path: str | Path, write: Callable[[str], object], about: Mapping[str, Any], status: str = "made"
) -> None:
    """Let `write` fill a file and seal it, completely or not at all; see `write_whole`.

    about : description of the content, in the types of JSON
    status : how its run ended
    """
    head = f" {canonical_json(about)} {status} ".encode()
    line = b""

    def write_and_seal(name: str) -> None:
        nonlocal line
        write(name)
        line = _seal_line(Path(name).read_bytes(), head)
        if seal_path(path) == Path(path):
            with open(name, "ab") as file:
                file.write(line)

    write_whole(path, write_and_seal)
    if seal_path(path) != Path(path):
        write_whole(seal_path(path), lambda name: Path(name).write_bytes(line))


def _seal_line(content: bytes, head: bytes) -> bytes:
    head = _MARK.rstrip() + head
    return head + hashlib.sha256(content + head).hexdigest().encode() + b"\n"


def write_sealed_text(path: str | Path, text: str, about: Mapping[str, Any]) -> None:
    """Write a text file and its seal."""
    write_sealed(path, lambda name: Path(name).write_bytes(text.encode()), about)


def read_seal(path: str | Path) -> tuple[dict[str, Any], str]:
    """Check all bytes of a file against its seal; return its description and the status of its run.

    Raises BadFile if the file does not exist, has no seal, or has changed since it was sealed.
    """
    return read_sealed(path)[1:]


def read_sealed(path: str | Path) -> tuple[bytes, dict[str, Any], str]:
    """Return the content of a file without its seal, its description, and the status of its run; see `read_seal`."""
    path = Path(path)
    try:
        content = path.read_bytes()
        sealed_in = seal_path(path)
        seal = content if sealed_in == path else sealed_in.read_bytes() if sealed_in.is_file() else b""
    except FileNotFoundError:
        raise BadFile(path, "is missing", "missing") from None
    except OSError as error:
        raise BadFile(path, f"cannot be read: {error.strerror}", "corrupt") from None
    if sealed_in == path and not content:
        raise BadFile(path, "is empty", "corrupt")
    found = _SEAL.search(seal, max(seal.rfind(_MARK), 0))
    if found is None:
        is_inside = sealed_in == path
        reason = "is truncated, or was not written by this program" if is_inside else f"has no seal in {sealed_in.name}"
        raise BadFile(path, reason, "corrupt")
    if sealed_in == path:
        content = content[: found.start()]
    if hashlib.sha256(content + found[0][: -len(found[3]) - 1]).hexdigest().encode() != found[3]:
        raise BadFile(path, "was changed after it was written" if content else "is empty", "corrupt")
    try:
        about = json.loads(found[1])
    except ValueError:
        about = None
    if not isinstance(about, dict):
        raise BadFile(path, "was sealed by another version")
    return content, about, found[2].decode()


def check_seal(path: str | Path, about: Mapping[str, Any] | None = None, *, any_sources: bool = False) -> str:
    """Check that a file is intact and the expected one; return the status of its run.

    about : the expected description; None accepts any
    any_sources : accept a file made by other sources
    Raises BadFile, one line with the difference.
    """
    found, status = read_seal(path)
    if about is not None:
        one, other = (config_part(found), config_part(about)) if any_sources else (found, about)
        if key := first_difference(one, other):
            raise BadFile(path, describe_difference(key, one, other))
    return status


def digest_of(about: Mapping[str, Any]) -> str:
    """Return the digest of a description for those of files made from it: one part for the config, one for sources."""
    own = config_part(about)
    sources = [about.get(key) for key in SOURCE_KEYS]
    sources += [digest.partition(".")[2] for digest in about.get("inputs", {}).values()]
    return f"{identity(canonical_json(own))}.{identity(canonical_json(sources))}"


def config_part(about: Mapping[str, Any]) -> dict[str, Any]:
    """Return the part of a description that does not depend on the sources."""
    inputs = {name: digest.partition(".")[0] for name, digest in about.get("inputs", {}).items()}
    return {**{key: value for key, value in about.items() if key not in SOURCE_KEYS}, "inputs": inputs}


def is_consistent(path: str | Path, other: str | Path) -> bool:
    """Return whether two intact files can belong to one study.

    They cannot if one was made from another version of the other, or both from different versions of a common input.
    Files whose seals do not name their inputs count as consistent.
    """
    abouts = [read_seal(each)[0] for each in (path, other)]
    made_of = [{about["file"]: digest_of(about), **about["inputs"]} for about in abouts if "inputs" in about]
    if len(made_of) < 2:
        return True
    first, second = made_of
    return all(first[name] == second[name] for name in first.keys() & second.keys())


def first_difference(found: Mapping[str, Any], expected: Mapping[str, Any]) -> str:
    """Return the first key in which two descriptions differ, the most telling first; empty if they are equal."""
    keys = {**expected, **found}
    differing = [key for key in keys if canonical_json(found.get(key)) != canonical_json(expected.get(key))]
    return min(differing, key=lambda key: (key != "file", key in _LAST), default="")


def describe_difference(key: str, found: Mapping[str, Any], expected: Mapping[str, Any]) -> str:
    """Describe the difference between two descriptions in a key."""
    one, other = found.get(key), json.loads(canonical_json(expected)).get(key)
    if key == "command" and one and other:
        return f"is another run: {difference(one, other)}"
    if key == "sources" and one and other:
        return f"was made by other sources (fingerprint {one}, now {other})"
    if key == "inputs" and one and other and (name := first_difference(one, other)):
        return f"was made from another {name}"
    place, one, other = _innermost(key, one, other)
    values = "got {}, expected {}".format(*_contrasted(one, other))
    return f"is another file: {values}" if place == "file" else f"was made with {place}: {values}"


def _innermost(place: str, one: Any, other: Any) -> tuple[str, Any, Any]:
    """Return the place of the first difference within two values, and what they have there; short lists stay whole."""
    if isinstance(one, dict) and isinstance(other, dict):
        if name := first_difference(one, other):
            return _innermost(f"{place}.{name}", one.get(name), other.get(name))
        return _innermost(place, list(one), list(other))
    if isinstance(one, list) and isinstance(other, list) and max(len(_text(one)), len(_text(other))) > _LONGEST:
        index = _common_length(one, other)
        if index == min(len(one), len(other)):
            return place, f"{len(one)} entries", f"{len(other)} entries"
        return _innermost(f"{place}[{index}]", one[index], other[index])
    return place, one, other


def _common_length(one: Sequence[Any], other: Sequence[Any]) -> int:
    """Return the number of equal entries, or letters, at the beginning of two sequences."""
    pairs = enumerate(zip(one, other, strict=False))
    return next((index for index, pair in pairs if len({*map(canonical_json, pair)}) > 1), min(len(one), len(other)))


def _contrasted(one: Any, other: Any) -> list[str]:
    """Return two different values as different texts, each cut around the first letter in which they differ."""
    texts = _text(one), _text(other)
    if texts[0] == texts[1]:
        texts = json.dumps(one), json.dumps(other)
    begin = max(_common_length(*texts) - _LONGEST // 2, 0) if max(map(len, texts)) > _LONGEST else 0
    end = begin + _LONGEST
    return [f"{'…' * (begin > 0)}{text[begin:end]}{'…' * (len(text) > end)}" for text in texts]


def _text(value: Any) -> str:
    return "nothing" if value is None else value if isinstance(value, str) else json.dumps(value)
