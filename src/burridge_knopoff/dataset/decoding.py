"""Decoding of flag variables, for readers of files."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.messages import refusal

if TYPE_CHECKING:
    import xarray


def decode_flags(flags: xarray.DataArray) -> xarray.DataArray:
    """Return a flag variable with each value replaced by its meaning, a string; NaN becomes "".

    flags : a variable with the CF attributes `flag_values` and `flag_meanings`, as in every file of a study

    Raises ValueError if it has no such attributes.

    >>> import xarray
    >>> from burridge_knopoff import decode_flags
    >>> kind = xarray.DataArray([0, 1], attrs={"flag_values": [0, 1], "flag_meanings": "stop start"})
    >>> decode_flags(kind).values.tolist()
    ['stop', 'start']
    """
    if "flag_meanings" not in getattr(flags, "attrs", ()):
        raise refusal("flags", flags, "a flag variable: an xarray.DataArray with flag_values and flag_meanings")
    words = np.full(flags.shape, "", dtype=object)
    values, meanings = np.atleast_1d(flags.attrs["flag_values"]), flags.attrs["flag_meanings"].split()
    for value, meaning in zip(values, meanings, strict=True):
        words[flags.values == value] = meaning
    attributes = {name: text for name, text in flags.attrs.items() if not name.startswith("flag_")}
    return flags.copy(data=words).drop_attrs().assign_attrs(attributes)
