"""The entries of `bifurcations.nc`: where the periodic orbits of each branch of attractors end or change."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
import xarray

from burridge_knopoff.continuation.branch_changes import BranchChange, Change, slots_of_branches
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation

# Smallest error that is reported. Rounding changes a root by amounts that depend on the linear-algebra library.
LEAST_ERROR = 1e-10


@dataclass(frozen=True)
class Entry:
    """A bifurcation of a branch: located on an orbit, or known only to lie within a range of a.

    low, high : nearest values of a below and above at which the branch is known; NaN if a bifurcation that is passed
        lies beyond all of them
    """

    change: Change
    from_branch: int
    to_branch: int
    low: float
    high: float
    motion: tuple[int, int]
    lifetime: tuple[float, float]
    kind: BifurcationKind
    bifurcation: Bifurcation | None

    @property
    def a(self) -> float:
        """Friction parameter at the bifurcation, or the middle of the range."""
        return self.bifurcation.a if self.bifurcation else 0.5 * (self.low + self.high)


def entries(table: xarray.Dataset, changes: Sequence[BranchChange], followed: FollowedOrbits) -> list[Entry]:
    """Return the entries of one law: one or two for each change of a branch, one for each bifurcation passed.

    A change from one orbit to another has an entry for the end of the first and one for the beginning of the second,
    unless both are the same bifurcation.
    """
    a, branch, kind = (table[name].values for name in ("a", "branch", "kind"))
    slots = slots_of_branches(table)
    grid = np.flatnonzero(table["in_grid"].values[: len(slots)] == 1)
    entry_list = []
    for change in changes:
        ends: list[Bifurcation] = []
        low, high = change.low, change.high
        below, above = int(grid[grid <= low][-1]), int(grid[grid >= high][0])
        reach = a[above] - a[below]
        numbers = [followed.of_place.get(at) for at in ((change.low, change.before), (change.high, change.after))]
        if numbers[0] is not None and numbers[0] == numbers[1]:
            # The orbit is the same on both sides; only the counts of its section points differ.
            continue
        for number, name in zip(numbers, ("upward", "downward"), strict=True):
            bifurcation = getattr(followed.segments[number], name).end if number is not None else None
            if bifurcation is None or any(abs(bifurcation.a - other.a) <= LEAST_ERROR for other in ends):
                continue
            # An orbit that continues for more than a step of the grid beyond a change did not cause it: a nearby orbit
            # has taken the number of its branch.
            if a[low] - reach <= bifurcation.a <= a[high] + reach:
                ends.append(bifurcation)
        motion = (
            _motion(kind, slots, range(low, below - 1, -1), change.from_branch),
            _motion(kind, slots, range(high, above + 1), change.to_branch),
        )
        lifetime = _lifetime(table, change)
        fields = change.change, change.from_branch, change.to_branch, float(a[low]), float(a[high]), motion, lifetime
        entry_list += [Entry(*fields, bifurcation.kind, bifurcation) for bifurcation in ends] or [
            Entry(*fields, _kind_without_orbit(change, kind), None)
        ]
    for place, segment in zip(followed.places, followed.segments, strict=True):
        n, own_kind = int(branch[place]), int(kind[place])
        values = np.array([a[k] for k, row in enumerate(slots) if n in row])
        for bifurcation in segment.downward.bifurcations + segment.upward.bifurcations:
            if bifurcation.keeps_stability and not bifurcation.is_turning_point:
                nearest = (
                    max(values[values <= bifurcation.a], default=np.nan),
                    min(values[values >= bifurcation.a], default=np.nan),
                )
                fields = Change.PASSED, n, n, *nearest, (own_kind, own_kind), (np.nan, np.nan)
                entry_list.append(Entry(*fields, bifurcation.kind, bifurcation))
    return entry_list


def _motion(kind: np.ndarray, slots: Sequence[Mapping[int, int]], places: Iterable[int], branch: int) -> int:
    """Return the kind of motion on a branch at the first of some values of a at which it is known."""
    return next((int(kind[k, slots[k][branch]]) for k in places if branch in slots[k]), int(MotionKind.UNDETERMINED))


def _lifetime(table: xarray.Dataset, change: BranchChange) -> tuple[float, float]:
    """Return the interval of the lifetime of chaos at a bifurcation, the shorter one of both sides."""
    sides = [(change.low, change.before), (change.high, change.after)]
    intervals = [
        (table["lifetime_low"].values[side], table["lifetime_high"].values[side]) for side in sides if side[1] >= 0
    ]
    return min((interval for interval in intervals if np.isfinite(interval[0])), default=(np.nan, np.nan))


def _kind_without_orbit(change: BranchChange, kind: np.ndarray) -> BifurcationKind:
    """Return the kind of a bifurcation without a periodic orbit: a crisis if there is chaos on every known side.

    Uniform sliding loses its stability in a Hopf bifurcation only: no real eigenvalue crosses 0.
    """
    sides = (change.low, change.before), (change.high, change.after)
    ends = [kind[k, slot] for k, slot in sides if slot >= 0]
    if MotionKind.SLIDING in ends:
        return BifurcationKind.HOPF
    chaotic = np.isin(ends, (*CHAOS, MotionKind.TRANSIENT_CHAOS))
    return BifurcationKind.CRISIS if chaotic.all() else BifurcationKind.UNDETERMINED
