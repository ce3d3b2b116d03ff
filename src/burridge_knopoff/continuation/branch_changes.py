"""Between which values of a the branches of `refined.nc` begin, end, or change, whatever the spacing of a is."""

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
    """What a branch of attractors does at a bifurcation, numbered as in netCDF files.

    passed : its orbits stay stable, but their stops change or other orbits branch off
    """

    BEGINNING = 0
    END = 1
    CHANGE = 2
    PASSED = 3


@dataclass(frozen=True)
class BranchChange:
    """A beginning, an end or a change of a branch between two values of a.

    low, high : numbers of these values in `refined.nc`; the branch is not known at any between them
    before, after : slot of the attractor at them, −1 where the branch has none
    from_branch, to_branch : the branch itself; where it begins or ends the one that is reached from it at the nearest
        value of the grid on the other side, −1 where it has not come to the grid yet
    """

    low: int
    high: int
    before: int
    after: int
    from_branch: int
    to_branch: int
    change: Change


def branch_changes(attractors: xarray.Dataset, refined: xarray.Dataset) -> list[BranchChange]:
    """Return what the branches of one law do, sorted by a.

    attractors, refined : those of one law at the values of the grid, and at all

    A change is one of the kind of motion, of mirror symmetry, or of the number of section points of periodic motion;
    but a torus and the orbits longer than `Refine.longest_period` to which it is locked are one motion. Of a mirror
    pair one is looked at. The first and the last value of a are no ends. Between values of the grid a branch that does
    not change is not looked for; so it has ended only where it is absent from the grid.
    """
    slots = slots_of_branches(refined)
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


def slots_of_branches(refined: xarray.Dataset) -> list[dict[int, int]]:
    """Return for each a of one law the slot of each branch, of a mirror pair that of one side."""
    count = int(np.isfinite(refined["a"].values).sum())
    branch, side = refined["branch"].values[:count], refined["side"].values[:count]
    rows = []
    for own, sides in zip(branch, side, strict=True):
        order = [slot for slot in np.argsort(sides, kind="stable") if own[slot] >= 0]
        rows.append({int(own[slot]): int(slot) for slot in order})
    return rows


def _has_changed(refined: xarray.Dataset, *places: tuple[int, int]) -> bool:
    """Tell whether the motions at two values of a and slots are no longer the same."""
    before, after = (_features(refined, *place) for place in places)
    return before != after


def _features(refined: xarray.Dataset, k: int, slot: int) -> tuple[int, ...]:
    kind, symmetry = (int(refined[name].values[k, slot]) for name in ("kind", "symmetry"))
    if kind in REGULAR and not is_followed(refined, k, slot):
        return int(MotionKind.QUASIPERIODIC), 0, 0
    period = int(refined["section_period"].values[k, slot]) if kind == MotionKind.PERIODIC else 0
    return kind, symmetry, period


def is_followed(refined: xarray.Dataset, k: int, slot: int) -> bool:
    """Tell whether a motion is a closed orbit that is short enough to be followed along a."""
    closed = refined["kind"].values[k, slot] in (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)
    return bool(closed and refined["period"].values[k, slot] <= refined.attrs["refine_longest_period"])
