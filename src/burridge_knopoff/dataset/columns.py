"""Columns of a file whose rows are things of one kind: how a column is described, and what it holds of each thing."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from burridge_knopoff.dataset.variables import Variable


@dataclass(frozen=True)
class Column(Variable):
    """A variable over rows; `value` returns what it holds of the thing of a row, None where it has nothing."""

    value: Callable[[Any], Any] = lambda row: None


def filled(columns: Mapping[str, Column], rows: Sequence[Any], sizes: Mapping[str, int]) -> dict[str, np.ndarray]:
    """Return {column: its values}; the first dimension is that of the rows, and `sizes` has all others.

    Where there is nothing stands NaN among numbers, −1 among whole numbers, and no words among texts.
    """
    values = {}
    for name, column in columns.items():
        shape = [sizes[size] for size in column.dimensions[1:]]
        nothing = np.full(shape, {"f": np.nan, "U": ""}.get(np.dtype(column.dtype).kind, -1))
        found = [column.value(row) for row in rows]
        every = [nothing if value is None else value for value in found]
        values[name] = np.array(every, dtype=column.dtype).reshape(len(rows), *shape)
    return values
