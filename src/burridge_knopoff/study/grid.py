"""Values of a: lists of numbers and ranges, and their names in file names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from itertools import pairwise
from typing import Any

from burridge_knopoff.values import refusal

#: Limit on the values of a list and on the points of a study: planning so many jobs takes Snakemake minutes.
MAXIMUM_POINTS = 100_000


def grid_of(items: Sequence[Any], digits: int) -> dict[str, float]:
    """Return {name: value} in ascending order; every value is the double nearest to its decimal.

    items : the config's `a`; digits : its `a_digits`
    Raises ValueError as `values_of` does, and for values with the same name.
    """
    grid: dict[str, float] = {}
    for value in values_of(items, "a"):
        name = f"{value:.{digits}f}"
        if name in grid:
            raise ValueError(
                f"a: got {grid[name]!r} and {value!r}, which share the file name a{name}.nc; expected values that "
                "differ within a_digits decimals"
            )
        grid[name] = value
    return grid


def values_of(items: Sequence[Any], place: str) -> list[float]:
    """Return the numbers and the values of the ranges in a list, in ascending order.

    Raises ValueError, one line that starts with the place, for too many values or a repeated one.
    """
    values: list[float] = []
    for position, item in enumerate(items):
        # Adding 0 turns -0.0 into 0.0.
        values += [float(item) + 0.0] if not isinstance(item, dict) else _range(item, f"{place}[{position}]")
        if len(values) > MAXIMUM_POINTS:
            raise ValueError(f"{place}: got more than {MAXIMUM_POINTS} values, expected at most that many")
    values.sort()
    for value, following in pairwise(values):
        if value == following:
            raise ValueError(f"{place}: got {value!r} twice, as a number or by two ranges; expected it once")
    return values


def _range(item: Mapping[str, float], place: str) -> list[float]:
    first, last, step = (Decimal(repr(item[key])) for key in ("from", "to", "step"))
    if last < first:
        raise refusal(f"{place}.to", item["to"], f"at least from ({item['from']!r})")
    count = (last - first) / step
    if count >= MAXIMUM_POINTS:
        raise refusal(f"{place}.step", item["step"], f"at most {MAXIMUM_POINTS} values in a range")
    if count != int(count):
        raise refusal(f"{place}.step", item["step"], f"one that divides the range {item['from']!r} to {item['to']!r}")
    return [float(first + step * k) for k in range(int(count) + 1)]
