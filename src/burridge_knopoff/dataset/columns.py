"""Columns of a table, as of all attractors: how a column is described, and what it holds of each thing in the table."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np

from burridge_knopoff.dataset.variables import Variable


@dataclass(frozen=True)
class Column(Variable):
    """A variable over the places of a table; `value` returns what it holds of a thing, None where it has nothing."""

    value: Callable[[Any], Any] = lambda thing: None


def empty_columns(
    variables: Mapping[str, Variable], sizes: Mapping[str, int], *beginnings: str
) -> dict[str, np.ndarray]:
    """Return an array of missing values for each variable whose dimensions have a size.

    beginnings : of the names that are wanted; none for all
    """
    return {
        name: np.full([sizes[key] for key in item.dimensions], item.missing, dtype=item.dtype)
        for name, item in variables.items()
        if all(key in sizes for key in item.dimensions) and (not beginnings or name.startswith(beginnings))
    }


def column_values(
    columns: Mapping[str, Column], things: Mapping[Any, Any], sizes: Mapping[str, int]
) -> dict[str, np.ndarray]:
    """Return {column: its values}, of each thing at its place in the table, along the first dimensions of the column.

    things : by their places, each a tuple of whole numbers

    Of fewer numbers than the last dimension has the others stay missing, as exponents that were not computed.
    """
    values = empty_columns(columns, sizes)
    for name, column in columns.items():
        for place, thing in things.items():
            found = column.value(thing)
            if found is not None:
                values[name][(*place, *map(slice, np.shape(found)))] = found
    return values
