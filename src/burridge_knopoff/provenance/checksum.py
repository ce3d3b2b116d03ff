"""The checksum of a netCDF file, kept in its global attribute `checksum`.

HDF5 itself detects neither a changed number nor most overwritten bytes. The checksum covers what is read: names, sizes,
types, attributes and values of dimensions and variables, whatever their order and compression. It is therefore still
valid after nccopy and h5repack.
"""

from __future__ import annotations

import hashlib
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    import netCDF4

NAME = "checksum"


def checksum_of(dataset: netCDF4.Dataset) -> str:
    """Return the SHA-256 of the content of an open netCDF file without groups, in hexadecimal digits."""
    dataset.set_auto_maskandscale(False)
    dataset.set_auto_chartostring(False)
    sizes = {name: len(item) for name, item in dataset.dimensions.items()}
    variables = {name: (item.dimensions, item[...], vars(item)) for name, item in dataset.variables.items()}
    return content_checksum(sizes, vars(dataset), variables)


def content_checksum(
    sizes: Mapping[str, int],
    attributes: Mapping[str, Any],
    variables: Mapping[str, tuple[tuple[str, ...], Any, Mapping[str, Any]]],
) -> str:
    """Return the SHA-256 of what a netCDF file contains, as `checksum_of` reads it from the file.

    sizes : of the dimensions; attributes : of the file; variables : {name: dimensions, values, attributes}
    """
    digest = hashlib.sha256()
    digest.update(repr(sorted(sizes.items())).encode())
    digest.update(_attribute_bytes({name: value for name, value in attributes.items() if name != NAME}))
    for name, (dimensions, array, described) in sorted(variables.items()):
        values = np.ascontiguousarray(array)
        # Without the order of bytes, which a copy may change.
        values = values.astype(values.dtype.newbyteorder("<"), copy=False)
        digest.update(repr((name, values.dtype.str, dimensions)).encode())
        digest.update(_attribute_bytes(described))
        digest.update(values.tobytes())
    return digest.hexdigest()


def add_checksum(dataset: netCDF4.Dataset) -> None:
    """Write the checksum of a file that is open for writing into the file."""
    dataset.setncattr(NAME, checksum_of(dataset))


def _attribute_bytes(attributes: Mapping[str, Any]) -> bytes:
    parts = []
    for name, value in sorted(attributes.items()):
        numbers = np.atleast_1d(value)
        kind = numbers.dtype.newbyteorder("<").str if numbers.dtype.kind in "iuf" else "text"
        parts.append(repr((name, kind, numbers.tolist())))
    return "".join(parts).encode()
