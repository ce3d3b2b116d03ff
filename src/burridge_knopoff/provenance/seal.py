"""The seal of a file of results: a description of its content, the status of its run, and the SHA-256 of its bytes.

HDF5 itself notices neither a changed number nor overwritten bytes, and nothing in a picture or a text says which study
it belongs to. The seal is one line. In a netCDF file it is the last line, after the HDF5 data, since netCDF programs do
not read past the end recorded by HDF5. The seal of a text or a picture lies beside it, in `.<name>.seal`.

The description is a mapping in the types of JSON. For a point it has the `bk simulate` command and the fingerprint of
the sources. For any other file of a study it has the name of the file, the params of its rule (the keys of the config
and the sources that decide it), and a digest of the description of each input. The workflow records the expected
descriptions of all files in study.json, and `check_seal` compares.
"""

from __future__ import annotations

import hashlib
import json
import os
import re
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.provenance.difference import difference
from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.record import recorded_file, remake_command, study_folder
from burridge_knopoff.values import printable

_MARK = b"\n#seal "
_SEAL = re.compile(rb"\n#seal (.+) ([a-z_]+) ([0-9a-f]{64})\n\Z")
#: Suffixes of the files that contain their seals: netCDF files and cached results.
_INSIDE = (".nc", "")
#: Differences reported last, since they may follow from others.
_LAST = ("inputs", "sources")
#: Separates the reason why a file must not be used from the command that remakes it.
REMEDY = "; remake it: "
#: Maximum length of a value in a message.
_LONGEST = 60


class BadFile(ValueError):
    """A file of results that must not be used; the message is one line: file, reason, command that remakes it.

    kind : missing, corrupt, or stale if the file is intact
    """

    def __init__(self, path: str | Path, reason: str, kind: str = "stale") -> None:
        self.path, self.reason, self.kind = Path(path), reason, kind
        super().__init__(f"{printable(str(path))}: {reason}{REMEDY}{remake_command(path)}")


def identity(*parts: str) -> str:
    """Return 16 hexadecimal digits for texts."""
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def canonical(about: Any) -> str:
    """Return a description as one line of JSON; order counts, such as that of the laws in a summary."""
    return json.dumps(about, separators=(",", ":"))


def seal_path(path: str | Path) -> Path:
    """Return the file that contains the seal: the file itself or, for a text or a picture, one beside it."""
    path = Path(path)
    return path if path.suffix in _INSIDE else path.with_name(f".{path.name}.seal")


def write_sealed(
    path: str | Path, write: Callable[[str], object], about: Mapping[str, Any], status: str = "made"
) -> None:
    """Let `write` fill a file and seal it, whole or not at all; see `write_whole`.

    about : description of the content, in the types of JSON
    status : how its run ended
    """
    head = f" {canonical(about)} {status} ".encode()
    line = b""

    def write_and_seal(name: str) -> None:
        nonlocal line
        write(name)
        line = _line(Path(name).read_bytes(), head)
        if seal_path(path) == Path(path):
            with open(name, "ab") as file:
                file.write(line)

    write_whole(path, write_and_seal)
    if seal_path(path) != Path(path):
        write_whole(seal_path(path), lambda name: Path(name).write_bytes(line))


def _line(content: bytes, head: bytes) -> bytes:
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
        beside = seal_path(path)
        seal = content if beside == path else beside.read_bytes() if beside.is_file() else b""
    except FileNotFoundError:
        raise BadFile(path, "is missing", "missing") from None
    except OSError as error:
        raise BadFile(path, f"cannot be read: {error.strerror}", "corrupt") from None
    if beside == path and not content:
        raise BadFile(path, "is empty", "corrupt")
    found = _SEAL.search(seal, max(seal.rfind(_MARK), 0))
    if found is None:
        where = "at its end: it is cut off, or another program wrote it" if beside == path else "beside it"
        raise BadFile(path, f"has no seal {where}", "corrupt")
    if beside == path:
        content = content[: found.start()]
    if hashlib.sha256(content + found[0][: -len(found[3]) - 1]).hexdigest().encode() != found[3]:
        raise BadFile(path, "has other bytes than were written" if content else "is empty", "corrupt")
    try:
        about = json.loads(found[1])
    except ValueError:
        about = None
    if not isinstance(about, dict):
        raise BadFile(path, "was sealed by another version")
    return content, about, found[2].decode()


def check_seal(path: str | Path, about: Mapping[str, Any] | None = None, *, any_sources: bool = False) -> str:
    """Check that a file is intact and the expected one; return the status of its run.

    about : expected description; by default from the record of its study, and nothing outside a study
    any_sources : accept a file made by other sources

    Raises BadFile, one line with the difference. If the file was made from another file that is wrong too, the error is
    about that one.
    """
    found, status = read_seal(path)
    expected = recorded_file(path) if about is None else json.loads(canonical(about))
    if expected is None or canonical(found) == canonical(expected):
        return status
    key = min(_differing(found, expected), key=lambda key: (key != "file", key in _LAST), default="order")
    if not (any_sources and key == "sources"):
        if key == "inputs" and (folder := study_folder(path)):
            for name in sorted(expected["inputs"].keys() & found.get("inputs", {}).keys()):
                if (folder / name).is_file():
                    check_seal(_beside(path, folder / name), any_sources=any_sources)
        raise BadFile(path, _difference(key, found.get(key), expected.get(key)))
    return status


def fit_together(path: str | Path, other: str | Path) -> bool:
    """Return whether two intact files can be of one study: neither was made from another version of the other.

    Nor from other versions of a common input. Files whose seals do not name their inputs are taken to fit.
    """
    abouts = [read_seal(each)[0] for each in (path, other)]
    made_of = [{about["file"]: identity(canonical(about)), **about["inputs"]} for about in abouts if "inputs" in about]
    if len(made_of) < 2:
        return True
    first, second = made_of
    return all(first[name] == second[name] for name in first.keys() & second.keys())


def _differing(found: Mapping[str, Any], expected: Mapping[str, Any]) -> list[str]:
    """Return the keys whose values differ."""
    keys = {**expected, **found}
    return [key for key in keys if canonical(found.get(key)) != canonical(expected.get(key))]


def _beside(path: str | Path, other: Path) -> Path:
    """Return the path of another file of a study, written in the same way as that of the first."""
    return other if Path(path).is_absolute() else Path(os.path.relpath(other))


def _difference(key: str, found: Any, expected: Any) -> str:
    """Return the difference between two files in a key, in words."""
    if key == "command" and found and expected:
        return f"is another run: {difference(found, expected)}"
    if key == "sources" and found and expected:
        return f"was made by other sources ({found}, now {expected})"
    place = [key]
    while isinstance(found, dict) and isinstance(expected, dict):
        if keys := _differing(found, expected):
            found, expected = found.get(keys[0]), expected.get(keys[0])
            place.append(keys[0])
        else:
            found, expected = list(found), list(expected)
    if place[0] == "inputs" and len(place) > 1:
        return f"was made from another {place[1]}"
    values = f"got {_words(found)}, expected {_words(expected)}"
    return f"is another file: {values}" if place == ["file"] else f"was made with {'.'.join(place)}: {values}"


def _words(value: Any) -> str:
    text = "nothing" if value is None else value if isinstance(value, str) else json.dumps(value)
    return text if len(text) <= _LONGEST else f"{text[:_LONGEST]}…"
