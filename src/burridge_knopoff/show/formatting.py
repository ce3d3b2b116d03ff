"""Formatting of values and tables for pages of text."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from textwrap import shorten

import numpy as np
import xarray

from burridge_knopoff.dataset.variables import decode_flags

#: Maximum length of a list of names, in letters.
LONGEST = 70
#: Maximum length of a list of numbers.
LISTED = 8


def listed(values: Iterable[float]) -> str:
    """Return a list of numbers; if there are more than LISTED, those in the middle are left out."""
    words = [f"{value:g}" for value in np.atleast_1d(np.asarray(values))]
    return ", ".join(words if len(words) <= LISTED else [*words[: LISTED - 2], "...", words[-1]])


def paragraph(rows: Iterable[tuple[str, str]]) -> list[str]:
    """Return the lines of names with their descriptions in a column."""
    return table((), rows)


def table(head: Sequence[str], rows: Iterable[Sequence[str]]) -> list[str]:
    """Return the lines of a table with columns as wide as necessary; without a header line if `head` is empty."""
    cells = [head, *rows] if head else list(rows)
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    return ["  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip() for row in cells]


def values_in_words(variable: xarray.DataArray) -> str:
    """Summarize the values of a variable: the count of each flag meaning, or the range."""
    values = variable.values
    if not values.size:
        return "no values"
    if "flag_meanings" in variable.attrs:
        words = decode_flags(variable).values
        counts = [(name, int((words == name).sum())) for name in variable.attrs["flag_meanings"].split()]
        return ", ".join(f"{name} {number}" for name, number in counts if number)
    if values.dtype == object or values.dtype.kind in "US":
        return shorten(", ".join(dict.fromkeys(map(str, values.ravel()))), LONGEST, placeholder=" ...")
    known = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    without = f", NaN at {values.size - known.size} of {values.size}" if known.size < values.size else ""
    if not known.size:
        return "NaN"
    low, high = known.min(), known.max()
    return f"{low:.6g}{without}" if low == high else f"{low:.6g} to {high:.6g}{without}"
