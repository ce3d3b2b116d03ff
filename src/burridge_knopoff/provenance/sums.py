"""The checksums of the files of a study, in the form that `sha256sum -c` reads: results/<study>/SHA256SUMS.

A netCDF file contains its own checksum; texts and pictures are checked against this list. Each job adds a line for each
of its texts and pictures; the last line of a file counts. At the end of a run the list is sorted, with all files.
"""

from __future__ import annotations

import fcntl
import hashlib
from collections.abc import Iterable, Mapping
from pathlib import Path

from burridge_knopoff.provenance.bad_file import CHANGED, BadFile, read_bytes
from burridge_knopoff.provenance.files import write_text

NAME = "SHA256SUMS"


def add_sums(results: Path, names: Iterable[str]) -> None:
    """Add the checksums of files that were just written; names : relative to the results."""
    lines = "".join(f"{_sum(results / name)}  {name}\n" for name in names)
    # Jobs run at the same time.
    with (results / NAME).open("a", encoding="utf-8") as file:
        fcntl.flock(file, fcntl.LOCK_EX)
        file.write(lines)


def read_sums(results: Path) -> dict[str, str]:
    """Return {name: checksum}; none if there is no list."""
    try:
        lines = (results / NAME).read_text(encoding="utf-8", errors="replace").splitlines()
    except OSError:
        return {}
    return {name: digest for digest, _, name in (line.partition("  ") for line in lines)}


def write_sums(results: Path, names: Iterable[str]) -> None:
    """Write the list of those files that exist, sorted; texts and pictures keep the sums with which they were made."""
    recorded = read_sums(results)
    existing = sorted(name for name in names if (results / name).is_file())
    sums = {name: _sum(results / name) if name.endswith(".nc") else recorded.get(name) for name in existing}
    write_text(results / NAME, "".join(f"{digest}  {name}\n" for name, digest in sums.items() if digest))


def check_sum(results: Path, name: str, sums: Mapping[str, str] | None = None) -> str:
    """Return the checksum of a text or a picture.

    sums : the list, if it has been read
    Raises BadFile if the file is missing, or differs from the one that was written.
    """
    path = results / name
    digest = _sum(path)
    recorded = (read_sums(results) if sums is None else sums).get(name)
    if recorded is None:
        raise BadFile(path, f"has no line in {NAME}", "corrupt")
    if recorded != digest:
        raise BadFile(path, CHANGED, "corrupt")
    return digest


def _sum(path: Path) -> str:
    return hashlib.sha256(read_bytes(path)).hexdigest()
