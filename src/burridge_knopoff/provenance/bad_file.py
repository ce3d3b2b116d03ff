"""The error of a file of results that must not be used."""

from __future__ import annotations

from pathlib import Path

from burridge_knopoff.messages import escape_unprintable
from burridge_knopoff.provenance.files import read_regular
from burridge_knopoff.provenance.record import remake_command

#: Reason why a file is bad.
CHANGED = "was changed after it was written"
#: Separates the reason why a file must not be used from the command that makes it again.
REMEDY = "; remake it: "


class BadFile(ValueError):
    """A file of results that must not be used: one line with file, reason and the command to make it again.

    kind : missing, corrupt, or outdated if the file is intact
    """

    def __init__(self, path: str | Path, reason: str, kind: str = "outdated") -> None:
        self.path, self.reason, self.kind = Path(path), escape_unprintable(reason), kind
        super().__init__(f"{escape_unprintable(str(path))}: {self.reason}{REMEDY}{remake_command(path)}")


def read_bytes(path: Path, size: int = -1) -> bytes:
    """Return the first `size` bytes of a file, by default all.

    Raises BadFile if it is missing, empty, or cannot be read.
    """
    try:
        content = read_regular(path, size)
    except FileNotFoundError:
        raise BadFile(path, "is missing", "missing") from None
    except OSError as error:
        raise BadFile(path, f"cannot be read: {error.strerror}", "corrupt") from None
    if not content:
        raise BadFile(path, "is empty", "corrupt")
    return content
