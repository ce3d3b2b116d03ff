"""The error of a file of results that must not be used."""

from __future__ import annotations

from pathlib import Path

from burridge_knopoff.messages import escape_unprintable
from burridge_knopoff.provenance.record import remake_command

#: Separates the reason why a file must not be used from the command that makes it again.
REMEDY = "; remake it: "


class BadFile(ValueError):
    """A file of results that must not be used: one line with file, reason and the command to make it again.

    kind : missing, corrupt, or stale if the file is intact
    """

    def __init__(self, path: str | Path, reason: str, kind: str = "stale") -> None:
        self.path, self.reason, self.kind = Path(path), reason, kind
        super().__init__(f"{escape_unprintable(str(path))}: {reason}{REMEDY}{remake_command(path)}")
