"""The entries of `bifurcations.nc`: where the closed orbits of each branch of attractors end or change."""

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

# Least error that is told: how far rounding changes a root differs between linear-algebra libraries.
LEAST_ERROR = 1e-10


@dataclass(frozen=True)
class Entry:
    """A bifurcation of a branch: found on an orbit, or known only to lie within a range of a.

    low, high : nearest values of a below and above at which the branch is known; NaN where a bifurcation that is passed
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
        """Friction parameter: that of the bifurcation, or the middle of the range."""
        return self.bifurcation.a if self.bifurcation else 0.5 * (self.low + self.high)


def entries(one: xarray.Dataset, changes: Sequence[BranchChange], followed: FollowedOrbits) -> list[Entry]:
    """Return an entry, or two, for each beginning, end and change, and one for each bifurcation that orbits pass.

    A change from one orbit to another has one for the end of the first and one for the beginning of the second, unless
    they are the same bifurcation.
    """
    a, branch, kind = (one[name].values for name in ("a", "branch", "kind"))
    slots = slots_of_branches(one)
    grid = np.flatnonzero(one["in_grid"].values[: len(slots)] == 1)
    found = []
    for change in changes:
        ends: list[Bifurcation] = []
        low, high = change.low, change.high
        below, above = int(grid[grid <= low][-1]), int(grid[grid >= high][0])
        reach = a[above] - a[below]
        numbers = [followed.of_place.get(at) for at in ((change.low, change.before), (change.high, change.after))]
        if numbers[0] is not None and numbers[0] == numbers[1]:
            # One orbit on both sides; only its section points were counted differently.
            continue
        for number, name in zip(numbers, ("upward", "downward"), strict=True):
            bifurcation = getattr(followed.segments[number], name).end if number is not None else None
            if bifurcation is None or any(abs(bifurcation.a - other.a) <= LEAST_ERROR for other in ends):
                continue
            # An orbit that goes on for more than a step of the grid beyond a change did not bring it about: another one
            # beside it has taken the number of its branch.
            if a[low] - reach <= bifurcation.a <= a[high] + reach:
                ends.append(bifurcation)
        motion = (
            _motion(kind, slots, range(low, below - 1, -1), change.from_branch),
            _motion(kind, slots, range(high, above + 1), change.to_branch),
        )
        lifetime = _lifetime(one, change)
        own = change.change, change.from_branch, change.to_branch, float(a[low]), float(a[high]), motion, lifetime
        found += [Entry(*own, bifurcation.kind, bifurcation) for bifurcation in ends] or [
            Entry(*own, _kind_without_orbit(change, kind), None)
        ]
    for place, segment in zip(followed.places, followed.segments, strict=True):
        n, own_kind = int(branch[place]), int(kind[place])
        values = np.array([a[k] for k, row in enumerate(slots) if n in row])
        for bifurcation in segment.downward.bifurcations + segment.upward.bifurcations:
            if bifurcation.keeps_stability and not bifurcation.turns:
                beside = (
                    max(values[values <= bifurcation.a], default=np.nan),
                    min(values[values >= bifurcation.a], default=np.nan),
                )
                own = Change.PASSED, n, n, *beside, (own_kind, own_kind), (np.nan, np.nan)
                found.append(Entry(*own, bifurcation.kind, bifurcation))
    return found


def _motion(kind: np.ndarray, slots: Sequence[Mapping[int, int]], places: Iterable[int], branch: int) -> int:
    """Return the kind of motion on a branch at the first of some values of a at which it is known."""
    return next((int(kind[k, slots[k][branch]]) for k in places if branch in slots[k]), int(MotionKind.UNDETERMINED))


def _lifetime(one: xarray.Dataset, change: BranchChange) -> tuple[float, float]:
    """Return the interval of the lifetime of chaos next to a bifurcation, the shorter one of both sides."""
    sides = [(change.low, change.before), (change.high, change.after)]
    known = [(one["lifetime_low"].values[side], one["lifetime_high"].values[side]) for side in sides if side[1] >= 0]
    return min((interval for interval in known if np.isfinite(interval[0])), default=(np.nan, np.nan))


def _kind_without_orbit(change: BranchChange, kind: np.ndarray) -> BifurcationKind:
    """Return the kind of a bifurcation without a closed orbit beside it: a crisis if chaos begins, ends or dies out."""
    sides = (change.low, change.before), (change.high, change.after)
    ends = [kind[k, slot] for k, slot in sides if slot >= 0]
    chaotic = np.isin(ends, (*CHAOS, MotionKind.TRANSIENT_CHAOS))
    return BifurcationKind.CRISIS if chaotic.all() else BifurcationKind.UNDETERMINED
