"""Branches between the values of the grid: `refined.nc` has the numbers and names of `attractors.nc`, and some more."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import xarray

from burridge_knopoff.summaries.attractors import with_others


def with_branches_between(
    numbers: Sequence[Mapping[int, int]], parts: Sequence[xarray.Dataset]
) -> list[dict[int, int]]:
    """Return the numbers of branches with those added that exist only between values of the grid.

    numbers : for each law {number of a branch: the one that it gets}, of the branches at values of the grid
    parts : of the laws, the attractors at all values, see `refined.one_law`
    """
    result: list[dict[int, int]] = []
    for known, part in zip(numbers, parts, strict=True):
        result.append(with_others(known, part, [*numbers, *result]))
    return result


def named_alike(refined: xarray.Dataset, attractors: xarray.Dataset) -> xarray.Dataset:
    """Return attractors at all values of a with the names that branches have at the values of the grid."""
    names = dict(zip(attractors["branch_number"].values.tolist(), attractors["branch_name"].values, strict=True))
    own = zip(refined["branch_number"].values.tolist(), refined["branch_name"].values, strict=True)
    return refined.assign(branch_name=refined["branch_name"].copy(data=[names.get(n, name) for n, name in own]))
