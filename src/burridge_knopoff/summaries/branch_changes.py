"""Between which values of a the branches of `attractors.nc` begin, end, or change, whatever the spacing of a is."""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum
from itertools import pairwise

import numpy as np
import xarray

from burridge_knopoff.stability.motion import MotionKind


class Change(IntEnum):
    """What a branch of attractors does at an edge, numbered as in netCDF files.

    passed : its orbits stay stable, but their stops change or other orbits branch off
    """

    BEGINNING = 0
    END = 1
    CHANGE = 2
    PASSED = 3


@dataclass(frozen=True)
class BranchChange:
    """A beginning, an end or a change of a branch between two neighbouring values of a.

    index : number of the smaller value
    before, after : slot of the attractor at the smaller and at the larger value, −1 where the branch has none
    from_branch, to_branch : branches that are there, or are reached from it, at the smaller and at the larger value
    """

    index: int
    before: int
    after: int
    from_branch: int
    to_branch: int
    change: Change


def branch_changes(attractors: xarray.Dataset) -> list[BranchChange]:
    """Return what the branches of one law do between neighbouring values of a.

    A change is one of the kind of motion, of mirror symmetry, or of the number of section points of periodic motion. Of
    a mirror pair one is looked at. The first and the last value of a are no ends.
    """
    slots = _slots(attractors)
    upward, downward = attractors["upward_branch"].values, attractors["downward_branch"].values
    found = []
    for k, (here, there) in enumerate(pairwise(slots)):
        for branch in sorted(here.keys() | there.keys()):
            before, after = here.get(branch, -1), there.get(branch, -1)
            if after < 0:
                found.append(BranchChange(k, before, -1, branch, int(upward[k, before]), Change.END))
            elif before < 0:
                found.append(BranchChange(k, -1, after, int(downward[k + 1, after]), branch, Change.BEGINNING))
            elif _features(attractors, k, before) != _features(attractors, k + 1, after):
                found.append(BranchChange(k, before, after, branch, branch, Change.CHANGE))
    return found


def _slots(attractors: xarray.Dataset) -> list[dict[int, int]]:
    """Return for each a the slot of each branch, of a mirror pair that of one side."""
    branch, side = attractors["branch"].values, attractors["side"].values
    rows = []
    for own, sides in zip(branch, side, strict=True):
        order = [slot for slot in np.argsort(sides, kind="stable") if own[slot] >= 0]
        rows.append({int(own[slot]): int(slot) for slot in order})
    return rows


def _features(attractors: xarray.Dataset, k: int, slot: int) -> tuple[int, ...]:
    kind, symmetry = (int(attractors[name].values[k, slot]) for name in ("kind", "symmetry"))
    period = int(attractors["section_period"].values[k, slot]) if kind == MotionKind.PERIODIC else 0
    return kind, symmetry, period
