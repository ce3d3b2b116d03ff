"""Opening of netCDF files, with a check against their checksum."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import netCDF4

from burridge_knopoff.provenance.bad_file import CHANGED, BadFile, read_bytes
from burridge_knopoff.provenance.checksum import NAME, checksum_of


@contextmanager
def open_whole(path: str | Path) -> Iterator[netCDF4.Dataset]:
    """Open a netCDF file whose content agrees with its checksum, without masks and scale factors.

    Raises BadFile if the file is missing, corrupt, or was not written by this program.
    """
    path = Path(path)
    read_bytes(path, 1)
    try:
        dataset = netCDF4.Dataset(path)
    except (OSError, RuntimeError, ValueError, UnicodeDecodeError):
        raise BadFile(path, "is corrupt, or not a netCDF file", "corrupt") from None
    with dataset:
        try:
            recorded, checksum = vars(dataset).get(NAME), checksum_of(dataset)
        except Exception:
            # Whatever HDF5, netCDF4 or NumPy make of overwritten bytes.
            raise BadFile(path, "is corrupt", "corrupt") from None
        if recorded is None:
            raise BadFile(path, "has no checksum: it was not written by this version of the program", "corrupt")
        if recorded != checksum:
            raise BadFile(path, CHANGED, "corrupt")
        yield dataset
