"""The seal: the last line of every netCDF file of a study, after the HDF5 data, by which a damaged file is known.

HDF5 itself sees neither a changed number nor noise over a part of a file. netCDF programs do not read past the end of
the data that HDF5 has noted, so they do not see the seal. It holds the SHA-256 of all bytes before it, a digest of what
the file is about, and how a run ended: all files of a study can be checked without opening one by netCDF.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Callable
from pathlib import Path

from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.record import remake_command

_SEAL = re.compile(rb"\n#seal ([0-9a-f]{16}) ([a-z_]+) ([0-9a-f]{64})\n\Z")
_LONGEST = 200


class BadFile(ValueError):
    """A file of results that must not be used; the message is one line: file, reason, command that makes it again.

    kind : missing, corrupt, or stale if it is whole
    """

    def __init__(self, path: str | Path, reason: str, kind: str = "stale") -> None:
        self.path, self.reason, self.kind = Path(path), reason, kind
        super().__init__(f"{path}: {reason}; remake it: {remake_command(path)}")


def identity(*parts: str) -> str:
    """Return 16 hexadecimal digits for what a file is about."""
    return hashlib.sha256("\n".join(parts).encode()).hexdigest()[:16]


def write_sealed(path: str | Path, write: Callable[[str], object], about: str, status: str = "made") -> None:
    """Let `write` fill a file and seal it, whole or not at all; see `write_whole`."""

    def write_and_seal(name: str) -> None:
        write(name)
        seal(name, about, status)

    write_whole(path, write_and_seal)


def seal(path: str | Path, about: str, status: str) -> None:
    """Put the seal at the end of a file that has just been written; about : see `identity`."""
    head = f"\n#seal {about} {status} ".encode()
    with open(path, "r+b") as file:
        digest = hashlib.sha256(file.read() + head).hexdigest()
        file.write(head + f"{digest}\n".encode())


def read_seal(path: str | Path) -> tuple[str, str]:
    """Check all bytes of a file against its seal; return what it is about, see `identity`, and how its run ended.

    Raises BadFile if the file is not there, has no seal, or is not what was sealed.
    """
    try:
        content = Path(path).read_bytes()
    except FileNotFoundError:
        raise BadFile(path, "is missing", "missing") from None
    except OSError as error:
        raise BadFile(path, f"cannot be read: {error.strerror}", "corrupt") from None
    found = _SEAL.search(content[-_LONGEST:])
    if found is None:
        reason = "has no seal at its end: it is cut off, or another program wrote it" if content else "is empty"
        raise BadFile(path, reason, "corrupt")
    if hashlib.sha256(content[: -len(found[3]) - 1]).hexdigest().encode() != found[3]:
        raise BadFile(path, "has other bytes than were written", "corrupt")
    return found[1].decode(), found[2].decode()
