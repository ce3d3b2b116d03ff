"""Columns of a table of objects, such as attractors: the netCDF variable of a column and its value for each object."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from burridge_knopoff.dataset.variables import Variable


@dataclass(frozen=True)
class Column(Variable):
    """A variable over the places of a table. `value` returns the value for an object, None if it is missing."""

    value: Callable[[Any], Any] = lambda item: None


def empty_columns(
    variables: Mapping[str, Variable], sizes: Mapping[str, int], *beginnings: str
) -> dict[str, np.ndarray]:
    """Return an array of missing values for each variable whose dimensions all have a size.

    beginnings : beginnings of the names of the variables; none for all variables
    """
    return {
        name: np.full([sizes[key] for key in item.dimensions], item.missing, dtype=item.dtype)
        for name, item in variables.items()
        if all(key in sizes for key in item.dimensions) and (not beginnings or name.startswith(beginnings))
    }


def over_grid(
    variables: Mapping[str, Variable],
    grid: Mapping[str, int],
    rows: Iterable[tuple[tuple[int, ...], Mapping[str, Any]]],
    **sizes: int,
) -> dict[str, np.ndarray]:
    """Return the values of variables over a grid, and over their own dimensions.

    grid : sizes of the grid by dimension; sizes : of the dimensions of the variables
    rows : places in the grid with the values there; what a row leaves out is missing
    """
    whole = {name: replace(item, dimensions=(*grid, *item.dimensions)) for name, item in variables.items()}
    values = empty_columns(whole, {**grid, **sizes})
    for place, row in rows:
        for name, value in row.items():
            values[name][place] = value
    return values


def common_attributes(attributes: Iterable[Mapping[str, Any]]) -> dict[str, Any]:
    """Return the attributes that are the same for all of several objects."""
    first, *others = attributes
    return {
        name: value
        for name, value in first.items()
        if all(name in other and np.array_equal(value, other[name]) for other in others)
    }


def column_values(
    columns: Mapping[str, Column], items: Mapping[Any, Any], sizes: Mapping[str, int]
) -> dict[str, np.ndarray]:
    """Return {column: values}, with the value for each object at its place along the first dimensions of the column.

    items : {place: object}, where a place is a tuple of whole numbers

    If an object has fewer values than the last dimension, the others stay missing, such as exponents that were not
    computed.
    """
    values = empty_columns(columns, sizes)
    for name, column in columns.items():
        for place, item in items.items():
            value = column.value(item)
            if value is not None:
                values[name][(*place, *map(slice, np.shape(value)))] = value
    return values
