"""Formatting of values, tables and lines for pages of text."""

from __future__ import annotations

import shutil
import sys
from collections.abc import Iterable, Sequence
from itertools import zip_longest
from textwrap import shorten, wrap

import numpy as np
import xarray

from burridge_knopoff.dataset.variables import decode_flags

#: Maximum length of a list of names, in letters.
LONGEST = 70
#: Maximum length of a list of numbers.
LISTED = 8
#: Width of a page that is not wrapped, and the least width of a column that is.
UNLIMITED, NARROWEST = sys.maxsize, 16


def terminal_width() -> int:
    """Return the columns of the terminal, or COLUMNS if it is set; UNLIMITED if the output goes elsewhere."""
    return shutil.get_terminal_size((UNLIMITED, 24)).columns


def wrap_lines(lines: Iterable[str], width: int) -> list[str]:
    """Return lines of at most a width; continuation lines are indented, and no word is broken."""
    return [part for line in lines for part in _wrap(line, width, indent="    ")]


def _wrap(line: str, width: int, *, indent: str = "") -> list[str]:
    if len(line) <= width:
        return [line]
    return wrap(line, width, subsequent_indent=indent, break_long_words=False, break_on_hyphens=False)


def list_numbers(values: Iterable[float]) -> str:
    """Return a list of numbers; if there are more than LISTED, those in the middle are left out."""
    words = [f"{value:g}" for value in np.atleast_1d(np.asarray(values))]
    return ", ".join(words if len(words) <= LISTED else [*words[: LISTED - 2], "...", words[-1]])


def table(head: Sequence[str], rows: Iterable[Sequence[str]], width: int = UNLIMITED) -> list[str]:
    """Return the lines of a table; if it is wider than `width`, its widest columns are wrapped.

    head : header line; none if it is empty
    """
    cells = [head, *rows] if head else list(rows)
    widths = [max(map(len, column)) for column in zip(*cells, strict=True)]
    while sum(widths) + 2 * (len(widths) - 1) > width and (widest := max(widths)) > NARROWEST:
        widths[widths.index(widest)] -= 1
    lines = []
    for row in cells:
        columns = [_wrap(cell, column) for cell, column in zip(row, widths, strict=True)]
        for parts in zip_longest(*columns, fillvalue=""):
            lines.append("  ".join(part.ljust(column) for part, column in zip(parts, widths, strict=True)).rstrip())
    return lines


def describe_values(variable: xarray.DataArray) -> str:
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
