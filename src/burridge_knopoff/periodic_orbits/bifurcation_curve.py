"""Curves of bifurcations in the plane of two parameters.

Each step predicts the next point of the curve from the secant through the last two points, and searches along the line
perpendicular to it in the plane. The curve may therefore turn back in either parameter, and orbits may exist on only
one side of it, as at a fold.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 10.3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcation_plane import BifurcationPlane, CurvePoint
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.border_collision import STEP_REDUCTION
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow
from burridge_knopoff.periodic_orbits.following import STEP_GROWTH, ContinuationSettings, interval_ends
from burridge_knopoff.periodic_orbits.parameter_line import model_at
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import tangent_of
from burridge_knopoff.values import instance_of

#: Steps along a curve, in the units of `follow`.
STEPS = ContinuationSettings(first_step=1e-3, largest_step=2e-2, smallest_step=1e-7, max_orbits=200)

# Cosine of the largest angle between successive steps of a curve, and the length down to which larger angles shorten
# the step.
STRAIGHT = 0.98
CORNER = 1e-5


@dataclass(frozen=True, eq=False)
class BifurcationCurve:
    """A curve of bifurcations in the plane of two parameters.

    kind : of all bifurcations on the curve; parameters : names of both parameters
    values, errors : of both parameters, in order along the curve, shape (n, 2)
    orbits : the orbit at each point

    >>> from burridge_knopoff import Model, follow, follow_bifurcation, locate_bifurcations
    >>> from burridge_knopoff import synchronized_orbit
    >>> branch = follow(synchronized_orbit(Model("linearized", a=0.0865)), (0.086, 0.0875), parameter="a")
    >>> (pitchfork,) = locate_bifurcations(branch)
    >>> curve = follow_bifurcation(pitchfork, ("a", "v"), (0.099, 0.101))
    >>> curve.kind.name, curve.values.shape == curve.errors.shape == (len(curve.orbits), 2)
    ('PITCHFORK', True)
    """

    kind: BifurcationKind
    parameters: tuple[str, str]
    values: np.ndarray
    errors: np.ndarray
    orbits: Sequence[PeriodicOrbit]

    def __repr__(self) -> str:
        return f"<BifurcationCurve: {self.kind.name.lower()}, {len(self.values)} points over {self.parameters}>"


def follow_bifurcation(
    bifurcation: Bifurcation,
    parameters: tuple[str, str] = ("a", "v"),
    interval: tuple[float, float] = (-math.inf, math.inf),
    settings: ContinuationSettings = STEPS,
) -> BifurcationCurve:
    """Return the curve of a bifurcation in the plane of two parameters, continued both ways from a known bifurcation.

    bifurcation : as `locate_bifurcations` yields it, located along any parameter
    parameters : names of two parameters, as in `Model.at`
    interval : (low, high) of the second parameter, at which the curve ends; by default it ends where no step succeeds
    settings : lengths of steps in the plane, in the units of `ContinuationSettings`, and the maximum number of points
        each way

    The curve also ends where the bifurcation becomes another one, for example a grazing where the orbit grazes twice.
    Its ends may lie one step beyond the interval. `errors` are half the widths of brackets perpendicular to the curve;
    at a grazing they are the remaining distance to it. A grazing is approached from the side on which the orbits have
    the same stops as the first orbit.

    Raises OrbitError if the given bifurcation cannot be reproduced, and ValueError, one line, for a wrong argument.

    Source: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 10.3.

    >>> from burridge_knopoff import Model, follow, follow_bifurcation, locate_bifurcations
    >>> from burridge_knopoff import synchronized_orbit
    >>> branch = follow(synchronized_orbit(Model("linearized", a=0.0865)), (0.086, 0.0875), parameter="a")
    >>> (pitchfork,) = locate_bifurcations(branch)
    >>> curve = follow_bifurcation(pitchfork, ("a", "threshold"), (0.8, 1.2))
    >>> a, threshold = curve.values.T
    >>> bool(abs(a * threshold - 0.086972904666).max() < 1e-12)
    True
    """
    instance_of(bifurcation, Bifurcation, "bifurcation")
    instance_of(settings, ContinuationSettings, "settings")
    names = tuple(parameters) if isinstance(parameters, list | tuple) else ()
    if len(names) != 2 or not all(isinstance(name, str) for name in names) or names[0] == names[1]:
        raise refusal("parameters", parameters, "the names of two parameters")
    ends = interval_ends(interval)
    plane = BifurcationPlane(bifurcation, names)
    orbit = plane.orbit
    start = orbit.model, orbit.reference, orbit.return_time, settings.first_step
    try:
        first = plane.point(orbit, np.array([0.0, 1.0]), *start)
    except OrbitError:
        # At an end of the range of the first parameter no root is bracketed along it.
        first = plane.point(orbit, np.array([1.0, 0.0]), *start)
    ways = [list(_follow_one_way(plane, first, side, settings, ends)) for side in (-1.0, 1.0)]
    points = [*ways[0][::-1], first, *ways[1]]
    values = np.array([[point.orbit.model.parameter(name) for name in names] for point in points])
    errors = np.array([point.errors for point in points])
    return BifurcationCurve(bifurcation.kind, names, values, errors, [point.orbit for point in points])


def _follow_one_way(
    plane: BifurcationPlane,
    first: CurvePoint,
    side: float,
    settings: ContinuationSettings,
    interval: tuple[float, float],
) -> Iterator[CurvePoint]:
    """Yield the points after the first one; at first the second parameter increases (side 1) or decreases (−1)."""
    direction, length = np.array([0.0, side]), settings.first_step
    before, point, count = None, first, 1
    while count < settings.max_orbits and length >= settings.smallest_step:
        if not interval[0] <= point.orbit.model.parameter(plane.names[1]) <= interval[1]:
            return
        try:
            following = _step(plane, before, point, direction, length)
        except OrbitError:
            length *= STEP_REDUCTION
            continue
        change = plane.place(following.orbit.model) - plane.place(point.orbit.model)
        turned = change / np.linalg.norm(change)
        # The first direction is a guess. The curve has a corner where the orbit also grazes elsewhere.
        if before is not None and length > CORNER and turned @ direction < STRAIGHT:
            length *= STEP_REDUCTION
            continue
        yield following
        before, point, direction = point.orbit, following, turned
        length, count = min(STEP_GROWTH * length, settings.largest_step), count + 1


def _step(
    plane: BifurcationPlane, before: PeriodicOrbit | None, point: CurvePoint, direction: np.ndarray, length: float
) -> CurvePoint:
    """Return the next point of the curve after two others; raises OrbitError if there is none at this length."""
    orbit, place = point.orbit, plane.place(point.orbit.model)
    model = model_at(orbit.model, plane.names, (place + length * direction) * plane.units)
    vector, time, blocks = orbit.reference.vector(), orbit.return_time, model.blocks
    if before is not None:
        share = length / float(np.linalg.norm(place - plane.place(before.model)))
        last = flow(before.model, before.reference, point.offset).state()
        vector = vector + share * (vector - last.vector())
        time += share * (time - before.return_time)
    elif plane.kind != BifurcationKind.FOLD:
        # The orbit changes in proportion to the parameters, except at a fold.
        tangent = tangent_of(orbit, plane.line(orbit.model, np.array([-direction[1], direction[0]])))
        vector = vector + length / tangent[-1] * tangent[:-2]
        time += length / float(tangent[-1]) * float(tangent[-2])
    stuck = orbit.reference.stuck
    guess = ChainState(vector[:blocks], np.where(stuck, 0.0, vector[blocks:]), stuck)
    return plane.point(orbit, direction, model, guess, time, length)
