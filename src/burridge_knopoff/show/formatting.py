"""Numbers in words and in tables."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import shorten

import numpy as np
import xarray

#: Letters of a list of names, at most.
LONGEST = 70
#: Numbers of a list, at most.
LISTED = 8


def listed(values: Iterable[float]) -> str:
    """Return numbers one after another, the middle ones left out if there are more than LISTED."""
    words = [f"{value:g}" for value in np.atleast_1d(np.asarray(values))]
    return ", ".join(words if len(words) <= LISTED else [*words[: LISTED - 2], "...", words[-1]])


def paragraph(rows: Iterable[tuple[str, str]]) -> list[str]:
    """Return lines of a name and what is said of it, the latter below each other."""
    return table((), rows)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Return the lines of a table whose columns are as wide as they need to be; an empty head is none."""
    cells = [head, *rows] if head else list(rows)
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def values_in_words(variable: xarray.DataArray) -> str:
    """Return what the values of a variable are: how often each meaning of a flag stands there, or their range."""
    values = variable.values
    if not values.size:
        return "no values"
    if "flag_meanings" in variable.attrs:
        names = zip(np.atleast_1d(variable.attrs["flag_values"]), variable.attrs["flag_meanings"].split(), strict=True)
        counts = [(name, int((values == number).sum())) for number, name in names]
        return ", ".join(f"{name} {number}" for name, number in counts if number)
    if values.dtype == object or values.dtype.kind in "US":
        return shorten(", ".join(dict.fromkeys(map(str, values.ravel()))), LONGEST, placeholder=" ...")
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    without = f", NaN at {values.size - known.size} of {values.size}" if known.size < values.size else ""
    if not known.size:
        return "NaN"
    low, high = known.min(), known.max()
    return f"{low:.6g}{without}" if low == high else f"{low:.6g} to {high:.6g}{without}"
