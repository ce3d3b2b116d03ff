"""The checksum of a netCDF file, kept in its global attribute `checksum`.

HDF5 itself detects neither a changed number nor most overwritten bytes. The checksum covers what is read: names, sizes,
types, attributes and values of dimensions and variables, whatever their order and compression. It is therefore still
valid after nccopy and h5repack.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import Any

import netCDF4
import numpy as np

NAME = "checksum"


def checksum_of(dataset: netCDF4.Dataset) -> str:
    """Return the SHA-256 of the content of an open netCDF file without groups, in hexadecimal digits."""
    dataset.set_auto_maskandscale(False)
    dataset.set_auto_chartostring(False)
    digest = hashlib.sha256()
    digest.update(repr(sorted((name, len(item)) for name, item in dataset.dimensions.items())).encode())
    _add_attributes(digest, {name: value for name, value in vars(dataset).items() if name != NAME})
    for name, variable in sorted(dataset.variables.items()):
        values = np.ascontiguousarray(variable[...])
        # Without the order of bytes, which a copy may change.
        values = values.astype(values.dtype.newbyteorder("<"), copy=False)
        digest.update(repr((name, values.dtype.str, variable.dimensions)).encode())
        _add_attributes(digest, vars(variable))
        digest.update(values.tobytes())
    return digest.hexdigest()


def add_checksum(dataset: netCDF4.Dataset) -> None:
    """Write the checksum of a file that is open for writing into the file."""
    dataset.setncattr(NAME, checksum_of(dataset))


def _add_attributes(digest: Any, attributes: Mapping[str, Any]) -> None:
    for name, value in sorted(attributes.items()):
        numbers = np.atleast_1d(value)
        kind = numbers.dtype.newbyteorder("<").str if numbers.dtype.kind in "iuf" else "text"
        digest.update(repr((name, kind, numbers.tolist())).encode())
