"""The values of a in `refined.nc` between which branches begin, end or change, for any spacing of a."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.motion.kind import REGULAR, MotionKind

if TYPE_CHECKING:
    import xarray


class Change(IntEnum):
    """The change of a branch of attractors at a bifurcation, with the numbers used in netCDF files.

    PASSED : its orbits stay stable, but their stops change or other orbits branch off
    """

    BEGINNING = 0
    END = 1
    CHANGE = 2
    PASSED = 3


@dataclass(frozen=True)
class BranchChange:
    """A beginning, an end or a change of a branch between two values of a.

    low, high : indices of these values in `refined.nc`; the branch is not known at any value between them
    before, after : slot of the attractor at each, −1 if the branch has none there
    from_branch, to_branch : the branch itself; at a beginning or an end, the one on the other side is the branch that
        is reached from it at the nearest value of the grid, −1 if it does not extend to the grid
    """

    low: int
    high: int
    before: int
    after: int
    from_branch: int
    to_branch: int
    change: Change


def branch_changes(attractors: xarray.Dataset, refined: xarray.Dataset, parameter: str = "a") -> list[BranchChange]:
    """Return the beginnings, ends and changes of the branches of one law, sorted by a.

    attractors, refined : those of one law at the values of the grid, and at all values
    parameter : name of the variable in `refined` with these values

    A branch changes if the kind of motion, the mirror symmetry, or the number of section points of periodic motion
    changes. A torus and the orbits longer than `refine.longest_period` to which it is locked count as the same motion.
    One motion of each mirror pair is examined. The first and the last value of a are not ends. Between values of the
    grid only changing branches are searched for, so a branch has ended only where it is absent from the grid.
    """
    slots = slots_of_branches(refined, parameter)
    grid = np.flatnonzero(refined["in_grid"].values[: len(slots)] == 1)
    upward, downward = (
        dict(zip(grid.tolist(), attractors[name].values, strict=True)) for name in ("upward_branch", "downward_branch")
    )

    def of_branch(branch: int) -> Iterator[BranchChange]:
        def end(k: int) -> BranchChange:
            g = int(grid[grid <= k][-1])
            reached = int(upward[g][slots[g][branch]]) if branch in slots[g] else -1
            return BranchChange(k, k + 1, slots[k][branch], -1, branch, reached, Change.END)

        def beginning(k: int) -> BranchChange:
            g = int(grid[grid >= k][0])
            reached = int(downward[g][slots[g][branch]]) if branch in slots[g] else -1
            return BranchChange(k - 1, k, -1, slots[k][branch], reached, branch, Change.BEGINNING)

        there = [k for k, row in enumerate(slots) if branch in row]
        if there[0] > 0:
            yield beginning(there[0])
        for low, high in pairwise(there):
            if ((grid > low) & (grid < high)).any():
                yield end(low)
                yield beginning(high)
            elif _has_changed(refined, (low, slots[low][branch]), (high, slots[high][branch])):
                yield BranchChange(low, high, slots[low][branch], slots[high][branch], branch, branch, Change.CHANGE)
        if there[-1] < len(slots) - 1:
            yield end(there[-1])

    branches = sorted(set().union(*slots))
    return sorted((item for branch in branches for item in of_branch(branch)), key=lambda item: (item.low, item.high))


def slots_of_branches(refined: xarray.Dataset, parameter: str = "a") -> list[dict[int, int]]:
    """Return for each a of one law the slot of each branch, one side of a mirror pair."""
    count = int(np.isfinite(refined[parameter].values).sum())
    branch, side = refined["branch"].values[:count], refined["side"].values[:count]
    rows = []
    for numbers, sides in zip(branch, side, strict=True):
        order = [slot for slot in np.argsort(sides, kind="stable") if numbers[slot] >= 0]
        rows.append({int(numbers[slot]): int(slot) for slot in order})
    return rows


def _has_changed(refined: xarray.Dataset, *places: tuple[int, int]) -> bool:
    """Return whether the motions at two places, each a value of a and a slot, differ."""
    before, after = (_features(refined, *place) for place in places)
    return before != after


def _features(refined: xarray.Dataset, k: int, slot: int) -> tuple[int, ...]:
    kind, symmetry = (int(refined[name].values[k, slot]) for name in ("kind", "symmetry"))
    if kind in REGULAR and not is_followed(refined, k, slot):
        return int(MotionKind.QUASIPERIODIC), 0, 0
    period = int(refined["section_period"].values[k, slot]) if kind == MotionKind.PERIODIC else 0
    return kind, symmetry, period


def is_followed(refined: xarray.Dataset, k: int | np.ndarray, slot: int | np.ndarray) -> np.ndarray:
    """Return whether motions are periodic orbits that are short enough to be followed along a, elementwise."""
    closed = np.isin(refined["kind"].values[k, slot], (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC))
    return closed & (refined["period"].values[k, slot] <= refined.attrs["refine_longest_period"])
