"""A branch of periodic orbits, followed from one of them to both of its ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import overload

import numpy as np
from scipy.optimize import brentq

from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import BranchEnd, ContinuationSettings, follow_side, interval_ends
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit, step_along, width_of
from burridge_knopoff.values import instance_of

# Largest difference from the period of the first orbit, as a fraction of the range on the branch, where it is closed.
CLOSED = 1e-3


@dataclass(frozen=True, eq=False, repr=False)
class Branch(Sequence[BranchOrbit]):
    """The orbits of a branch in their order along it: a sequence, each a `BranchOrbit`.

    The side on which the parameter decreases at first comes first, from its end to the start, then the start and the
    other side. A closed branch goes round once, and it or a single side begins at the start.

    orbits : shape (n,); that at the start alone has the length 0
    ends : why the branch ends at its first and at its last orbit, each a `reason` and a `message` with the place:
        bound : the parameter has left the interval at the end towards which the side began, or there is no model beyond
        fold : the branch has turned back and left the interval at its other end
        joined : it joins a branch of simpler orbits, or uniform sliding
        closed : it has returned to its first orbit
        complete : `is_complete` was true
        orbits : the number of orbits is used up
        lost : no next orbit is found, however short the step; the message says what failed
        start : that side was not followed

    >>> from burridge_knopoff import Model, follow, synchronized_orbit
    >>> branch = follow(synchronized_orbit(Model("linearized", a=0.0865)), (0.086, 0.0875), parameter="a")
    >>> branch.ends[1].reason, len(branch.bifurcations), branch[0].value < branch[-1].value
    ('bound', 1, True)
    """

    orbits: Sequence[BranchOrbit]
    ends: tuple[BranchEnd, BranchEnd]

    @overload
    def __getitem__(self, place: int) -> BranchOrbit: ...
    @overload
    def __getitem__(self, place: slice) -> Sequence[BranchOrbit]: ...
    def __getitem__(self, place: int | slice) -> BranchOrbit | Sequence[BranchOrbit]:
        return self.orbits[place]

    def __len__(self) -> int:
        return len(self.orbits)

    def __repr__(self) -> str:
        values = [point.value for point in self.orbits]
        range_ = f"{self.parameter} = {min(values):.6g} to {max(values):.6g}"
        return f"<Branch: {range_}, {len(self)} orbits, ends: {', '.join(end.reason for end in self.ends)}>"

    @property
    def parameter(self) -> str:
        """The parameter along which the branch was followed."""
        return self.orbits[0].line.parameter

    @cached_property
    def bifurcations(self) -> list[Bifurcation]:
        """The bifurcations in order along the branch, see `locate_bifurcations`."""
        return list(locate_bifurcations(self.orbits))


def follow_branch(
    orbit: PeriodicOrbit,
    interval: tuple[float, float],
    settings: ContinuationSettings,
    parameter: str,
    upward: bool | None,
    is_complete: Callable[[list[BranchOrbit]], bool],
) -> Branch:
    """Return the branch of an orbit within an interval, with steps relative to it; see `burridge_knopoff.follow`."""
    ends = interval_ends(interval)
    width = width_of(instance_of(orbit, PeriodicOrbit, "orbit").model, parameter, *ends)

    def side(direction: bool) -> tuple[list[BranchOrbit], BranchEnd]:
        points, end = follow_side(
            orbit,
            ends,
            settings,
            parameter,
            direction,
            lambda so_far: _has_closed(so_far) or is_complete(so_far),
            width,
        )
        if end.reason == "complete" and _has_closed(points):
            end = BranchEnd("closed", f"returns to {points[0].line.place(points[0].orbit.model)}")
        return points, end

    not_followed = BranchEnd("start", "this side was not followed")
    if upward is not None:
        points, end = side(upward)
        return Branch(points, (end if end.reason == "closed" else not_followed, end))
    points, high = side(True)
    if high.reason == "closed":
        return Branch(points, (high, high))
    others, low = side(False)
    if low.reason == "closed":
        return Branch(others, (low, low))
    return Branch([*others[:0:-1], *points], (low, high))


def _has_closed(branch: Sequence[BranchOrbit]) -> bool:
    """Return whether the last step of a branch has passed its first orbit, in the direction in which it began."""
    if len(branch) < 3:
        return False
    first, before, last = branch[0], branch[-2], branch[-1]
    upward = {point.tangent[-1] > 0.0 for point in (first, before, last)}
    if len(upward) > 1 or last.orbit.stop_counts != first.orbit.stop_counts:
        return False
    points = {0.0: before, last.length: last}

    def difference(length: float) -> float:
        points[length] = points.get(length) or step_along(before, length)
        return points[length].value - first.value

    if before.is_grazing or difference(0.0) * difference(last.length) >= 0.0:
        return False
    try:
        brentq(difference, 0.0, last.length, xtol=CLOSED * last.length)
    except OrbitError:
        return False
    nearest = min(points.values(), key=lambda point: abs(point.value - first.value))
    return abs(nearest.orbit.period - first.orbit.period) <= CLOSED * np.ptp([point.orbit.period for point in branch])
