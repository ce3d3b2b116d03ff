"""Formatting of values and lines for pages of text."""

from __future__ import annotations

import shlex
import shutil
from collections.abc import Iterable
from textwrap import shorten

import numpy as np
import xarray

from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.messages import command, escape_unprintable
from burridge_knopoff.summaries.text_table import UNLIMITED, wrap_line

#: Maximum length of a list of names, in letters.
LONGEST = 70
#: Maximum length of a list of numbers.
LISTED = 8


def terminal_width() -> int:
    """Return the columns of the terminal, or COLUMNS if it is set; UNLIMITED if the output goes elsewhere."""
    return shutil.get_terminal_size((UNLIMITED, 24)).columns


def wrap_lines(lines: Iterable[str], width: int) -> list[str]:
    """Return lines of at most a width; continuation lines are indented, and no word is broken."""
    return [part for line in lines for part in wrap_line(line, width, indent="    ")]


def quoted_history(history: str) -> str:
    """Return the command in the history of a file, quoted word by word, or a text that is none as it is."""
    try:
        return command(*shlex.split(history)) if history.startswith("bk ") else escape_unprintable(history)
    except ValueError:
        return escape_unprintable(history)


def list_numbers(values: Iterable[float]) -> str:
    """Return a list of numbers; if there are more than LISTED, those in the middle are left out."""
    words = [f"{value:g}" for value in np.atleast_1d(np.asarray(values))]
    return ", ".join(words if len(words) <= LISTED else [*words[: LISTED - 2], "...", words[-1]])


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
    finite = values[~np.isnan(values)] if values.dtype.kind == "f" else values
    without = f", NaN at {values.size - finite.size} of {values.size}" if finite.size < values.size else ""
    if not finite.size:
        return "NaN"
    low, high = finite.min(), finite.max()
    return f"{low:.6g}{without}" if low == high else f"{low:.6g} to {high:.6g}{without}"
