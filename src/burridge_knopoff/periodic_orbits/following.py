"""Continuation of stable and unstable periodic orbits in a parameter, through folds and grazings."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Annotated, Any, Literal, NamedTuple

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import Number, TrueOrFalse, Whole
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.border_collision import approach_grazing, smooth_step, switch_branch
from burridge_knopoff.periodic_orbits.critical_values import critical_values
from burridge_knopoff.periodic_orbits.floquet import check_derivative
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form, reduced_orbit
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import (
    BranchOrbit,
    begin_branch,
    line_of,
    relative_length,
    step_along,
)
from burridge_knopoff.values import elements, instance_of, real_number

# Distance, for v = 0.1 in the chain's own units, within which an orbit must return to its mirror image, or to itself
# after half its period, to be about to become more symmetric or to halve its period.
REDUCTION_DISTANCE = 3e-2

# Factor by which the length of a step grows after a successful step.
STEP_GROWTH = 2.0

LENGTH = Number(0.0, 1e6, above=True)


@settings
@dataclass(frozen=True)
class ContinuationSettings:
    """Settings of a continuation: lengths of steps along the branch, mostly in the parameter, and the number of orbits.

    Lengths of `follow` combine the change of the parameter, as a fraction of the width of the interval, and that of
    positions and velocities, for v = 0.1 in the chain's own units. Without an interval, the size of the parameter at
    the start takes the place of the width; ten times this size does where the interval is wider.

    Lengths of `follow_bifurcation` are in the chain's own unit of a, `Chain.own_units.slope`: 1 for the paper's chain,
    and 2 for a chain that moves half as fast, for which friction has to fall twice as steeply. Along another parameter
    their unit is the change that moves the return of the orbit by about as much as a change of 1 in a does for a short
    orbit; for long orbits, whose return changes faster, it is smaller.

    Raises ValueError, one line, for anything out of range, and for a smallest step above the first or the largest one.

    >>> from burridge_knopoff import ContinuationSettings
    >>> ContinuationSettings(max_orbits=20).largest_step
    0.005
    """

    first_step: Annotated[float, LENGTH, "length of the first step, and of the first step after a grazing"] = 1e-3
    largest_step: Annotated[float, LENGTH, "largest length of a step"] = 5e-3
    smallest_step: Annotated[float, LENGTH, "length of a step below which the branch is given up"] = 1e-8
    max_orbits: Annotated[int, Whole(1, 10**9), "largest number of orbits of a branch, on each side of its start"] = (
        1000
    )

    def __post_init__(self) -> None:
        check_fields(self)
        for limit in ("first_step", "largest_step"):
            if self.smallest_step > (most := getattr(self, limit)):
                raise refusal("smallest_step", self.smallest_step, f"at most {limit} ({most:g})")


#: Lengths in the units of `line_of`.
CONTINUATION = ContinuationSettings(first_step=1e-4, largest_step=5e-4, smallest_step=1e-9, max_orbits=200)


class BranchEnd(NamedTuple):
    """Why a branch ends, see `Branch`: a word, and the place or the failure in words."""

    reason: Literal["bound", "fold", "joined", "closed", "complete", "orbits", "lost", "start"]
    message: str


def follow(
    orbit: PeriodicOrbit,
    interval: tuple[float, float] = (-math.inf, math.inf),
    settings: ContinuationSettings = CONTINUATION,
    *,
    parameter: str = "a",
    upward: bool = True,
    is_complete: Callable[[list[BranchOrbit]], bool] = lambda points: False,
) -> list[BranchOrbit]:
    """Return the orbits of a branch, continued from one of them until a parameter leaves an interval.

    orbit : stable or unstable, of any chain; first reduced to its minimal form
    interval : (low, high) of the parameter; by default unbounded
    settings : lengths of steps; upward : whether the parameter increases at first
    parameter : a, v, a parameter of the law such as sigma, one of the chain such as coupling, or that of one block or
        spring such as `mass[3]` (`Model.at`)
    is_complete : called with all orbits so far after each orbit that does not graze; ends the branch if true

    The end of a branch, errors and the source are those of `burridge_knopoff.follow`, which takes a model as well.
    """
    return follow_side(orbit, interval, settings, parameter, upward, is_complete)[0]


def follow_side(
    orbit: PeriodicOrbit,
    interval: tuple[float, float],
    settings: ContinuationSettings,
    parameter: str,
    upward: bool,
    is_complete: Callable[[list[BranchOrbit]], bool],
    width: float | None = None,
) -> tuple[list[BranchOrbit], BranchEnd]:
    """Return the same as `follow`, and why the branch ended.

    width : to which steps in the parameter are relative; by default they are in the unit of `line_of`
    """
    low, high = interval_ends(interval)
    check_derivative(instance_of(orbit, PeriodicOrbit, "orbit"))
    instance_of(settings, ContinuationSettings, "settings")
    upward = TrueOrFalse().form(upward, "upward")
    if not callable(is_complete):
        raise refusal("is_complete", is_complete, "a function")
    line = line_of(orbit, parameter)
    if not low <= line.value(orbit.model) <= high:
        raise OrbitError(f"{line.place(orbit.model)}: not within the range {low!r} to {high!r}")
    points = [begin_branch(reduced_orbit(orbit) or orbit, upward, line)]
    length = settings.first_step

    def end() -> BranchEnd | None:
        place = line.place(points[-1].orbit.model)
        if not low <= points[-1].value <= high:
            if (points[-1].value > high) == upward:
                return BranchEnd("bound", f"leaves the interval at {place}")
            turn = max(points, key=lambda point: point.value if upward else -point.value)
            return BranchEnd("fold", f"turns back at {line.place(turn.orbit.model)}, leaves the interval at {place}")
        if len(points) >= settings.max_orbits:
            return BranchEnd("orbits", f"{len(points)} orbits end at {place}")
        return BranchEnd("complete", f"ends at {place}") if is_complete(points) else None

    while (reached := end()) is None:
        unit = 1.0 if width is None else 1.0 / relative_length(points[-1], width)
        candidate = smooth_step(points, length * unit)
        if candidate is not None:
            path = [candidate]
            length = min(STEP_GROWTH * length, settings.largest_step)
        else:
            path = approach_grazing(points, length * unit)
            length = max(0.1 * length, path[-1].length / unit if path else 0.0)
        for point in path:
            simpler = point.reduced_orbit or _passed_orbit(points[-1], point)
            points.append(replace(point, reduced_orbit=simpler))
            if simpler is not None:
                return points, BranchEnd("joined", f"joins simpler orbits at {line.place(simpler.model)}")
            if point is not path[-1] and (reached := end()) is not None:
                return points, reached
        if points[-1].is_grazing and (turned := switch_branch(points[-1])) is not None:
            points.append(turned)
            length = settings.first_step
        elif points[-1].is_grazing or length < settings.smallest_step:
            return points, _loss(points[-1], settings.smallest_step * unit, low, high)
    return points, reached


def _loss(point: BranchOrbit, length: float, low: float, high: float) -> BranchEnd:
    """Return why no step of a length continues a branch within an interval."""
    model, line = point.orbit.model, point.line
    place = line.place(model)
    try:
        ahead = line.value(line.model(model, line.coordinate(model) + length * float(point.tangent[-1])))
    except OrbitError as error:
        return BranchEnd("bound", f"no model beyond {place}: {error}")
    if not low <= ahead <= high:
        return BranchEnd("bound", f"reaches the end of the interval at {place}")
    if point.is_grazing:
        return BranchEnd("lost", f"{place}: no orbit is found beyond the grazing")
    try:
        step_along(point, length)
    except OrbitError as error:
        return BranchEnd("lost", str(error))
    return BranchEnd("lost", f"{place}: stops and starts change within a step of {length:g}")


def interval_ends(interval: Any) -> tuple[float, float]:
    """Return the ends of an interval; raises ValueError, one line, if it is not an interval."""
    ends = [real_number(end) for end in elements(interval) or ()]
    if len(ends) != 2 or not ends[0] <= ends[1]:
        raise refusal("interval", interval, "(low, high) with low ≤ high")
    return ends[0], ends[1]


def _passed_orbit(first: BranchOrbit, second: BranchOrbit) -> PeriodicOrbit | None:
    """Return the simpler orbit between two points of a branch, beyond which it repeats its mirror image; None if none.

    The parameter turns back at such an orbit, but the multiplier only touches 1, unlike at a fold.
    """
    if first.tangent[-1] * second.tangent[-1] > 0.0:
        return None
    signs = [
        critical_values(point.orbit, point.multipliers)[BifurcationKind.FOLD, "symmetry_preserving"]
        for point in (first, second)
    ]
    if signs[0] * signs[1] < 0.0:
        return None
    simpler = minimal_form(first.orbit, REDUCTION_DISTANCE)
    return None if simpler is first.orbit else simpler
