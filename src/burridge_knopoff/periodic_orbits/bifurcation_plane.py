"""The location of a bifurcation on a line in the plane of two parameters.

Along the line the orbits form a branch, with the coordinate on the line as an additional unknown, and the bifurcation
is a root along this branch. A grazing is approached from the side on which the orbits have the stops of the first one.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import BRACKETS, ROUNDING, Bifurcation, kind_at
from burridge_knopoff.periodic_orbits.border_collision import CORNER_DISTANCE, LARGEST_SHARE, STEP_REDUCTION
from burridge_knopoff.periodic_orbits.critical_values import critical_values
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow
from burridge_knopoff.periodic_orbits.following import STEP_GROWTH
from burridge_knopoff.periodic_orbits.grazing_distances import grazing_distances
from burridge_knopoff.periodic_orbits.parameter_line import ParameterLine
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, missing_isolation_of, orbit_of, safe_offset
from burridge_knopoff.periodic_orbits.pseudo_arclength import (
    BranchOrbit,
    adapt_symmetry,
    line_of,
    solve_ahead,
    tangent_of,
    weights,
)

# First step of the search for a root along a branch, the change at which it ends, and the maximum number of iterations.
PROBE = 1e-6
CONVERGED = 1e-12
ITERATIONS = 40

# A root is searched for within this many step lengths, and the return time may change by this fraction.
FARTHEST = 10.0
CHANGE = 0.1


@dataclass(frozen=True, eq=False)
class CurvePoint:
    """A point of the curve; `offset` is the time by which the reference was shifted along the orbit."""

    orbit: PeriodicOrbit
    errors: np.ndarray
    offset: float


class BifurcationPlane:
    """The plane of two parameters, and the function that vanishes at one kind of bifurcation of an orbit.

    Raises ValueError, one line, if the bifurcation requires a symmetry that one of the parameters breaks, and for a
    Hopf bifurcation, which has a closed form.

    Points of the plane are in the units of `line_of` at the bifurcation.
    """

    def __init__(self, bifurcation: Bifurcation, names: tuple[str, str]) -> None:
        if bifurcation.kind == BifurcationKind.HOPF:
            raise refusal("bifurcation", bifurcation, "another kind: `hopf_bifurcations` has this one in closed form")
        orbit = bifurcation.at.orbit
        for name in names:
            orbit = adapt_symmetry(line_of(orbit, name), orbit)
        self.orbit, self.kind, self.names = orbit, bifurcation.kind, names
        self.units = np.array([line_of(orbit, name).rates[0] for name in names])
        self.own_units = orbit.model.chain.own_units
        self.symmetry, self.stops = orbit.symmetry, orbit.stop_counts
        if self.kind == BifurcationKind.GRAZING:
            self.component = int(bifurcation.at.grazing_distances.in_own_units(self.own_units).argmin())
        else:
            values = {key: abs(value) for key, value in critical_values(orbit).items() if key[0] == self.kind}
            if not values:
                allowed = f"two that keep the mirror symmetry: no {self.kind.words} without it"
                raise refusal("parameters", names, allowed)
            self.key = min(values, key=values.__getitem__)

    def place(self, model: Model) -> np.ndarray:
        """Return the point of a model in the plane."""
        return np.array([model.parameter(name) for name in self.names]) / self.units

    def line(self, model: Model, direction: np.ndarray) -> ParameterLine:
        """Return the line through a model perpendicular to a direction of the plane."""
        rates = np.array([direction[1], -direction[0]]) * self.units
        order = (0, 1) if abs(direction[1]) >= abs(direction[0]) else (1, 0)
        names = tuple(self.names[k] for k in order)
        origins = tuple(model.parameter(name) for name in names)
        return ParameterLine(names, origins, tuple(float(rates[k]) for k in order), units=self.own_units)

    def point(
        self, near: PeriodicOrbit, direction: np.ndarray, model: Model, guess: ChainState, time: float, length: float
    ) -> CurvePoint:
        """Return the point of the curve on the line through a model perpendicular to a direction.

        near : a neighbouring orbit; guess, time : of the orbit; length : of the step

        Raises OrbitError if no such point is found within FARTHEST steps.
        """
        line = self.line(model, direction)
        tangent = tangent_of(near, self.line(near.model, direction))

        def orbit_at(distance: float) -> PeriodicOrbit:
            orbit = solve_ahead(model, guess, time, self.symmetry, line, tangent, distance, target_residual=0.0)
            if abs(orbit.return_time - time) > CHANGE * time or missing_isolation_of(orbit):
                raise OrbitError(f"{line.place(model)}: no orbit found near the guess")
            return orbit

        longest = FARTHEST * max(length, PROBE)
        if self.kind == BifurcationKind.GRAZING:
            orbit, errors = self._grazing(_first_with(self.stops, orbit_at, longest), line)
        else:
            orbit, errors = self._root(orbit_at(0.0), line, longest)
            if kind_at(BranchOrbit(orbit, tangent, line), self.key) != self.kind:
                raise OrbitError(f"{line.place(orbit.model)}: the bifurcation becomes another one")
        offset = safe_offset(orbit)
        if offset:
            state = flow(orbit.model, orbit.reference, offset).state()
            orbit = orbit_of(orbit.model, state, orbit.return_time, self.symmetry)
        return CurvePoint(orbit, np.maximum(errors * self.units, ROUNDING), offset)

    def _root(self, orbit: PeriodicOrbit, line: ParameterLine, longest: float) -> tuple[PeriodicOrbit, np.ndarray]:
        """Return the orbit at which the test function vanishes, and half the widths of the bracket in the plane."""
        tangent = tangent_of(orbit, line)

        def orbit_at(distance: float) -> PeriodicOrbit:
            if abs(distance) > longest:
                raise OrbitError(f"{line.place(orbit.model)}: no bifurcation found near the guess")
            start = orbit.model, orbit.reference, orbit.return_time
            return solve_ahead(*start, self.symmetry, line, tangent, distance, target_residual=0.0)

        def value(distance: float) -> float:
            return critical_values(orbit_at(distance))[self.key]

        before, length = 0.0, PROBE
        values = value(before), value(length)
        for _ in range(ITERATIONS):
            if values[0] == values[1] or abs(length - before) < CONVERGED:
                break
            before, length = length, length - values[1] * (length - before) / (values[1] - values[0])
            values = values[1], value(length)
        for side in BRACKETS:
            low, high = orbit_at(length - side), orbit_at(length + side)
            if critical_values(low)[self.key] * critical_values(high)[self.key] < 0.0:
                return orbit_at(length), 0.5 * np.abs(self.place(high.model) - self.place(low.model))
        raise OrbitError(f"{self.kind.name.lower()}: no root found near the guess")

    def _grazing(self, orbit: PeriodicOrbit, line: ParameterLine) -> tuple[PeriodicOrbit, np.ndarray]:
        """Return an orbit next to the grazing one, on the side with its own stops, and the remaining distances."""
        tangent, length = tangent_of(orbit, line), PROBE
        distance = self._distance(orbit)
        for _ in range(ITERATIONS):
            try:
                candidate = solve_ahead(
                    orbit.model, orbit.reference, orbit.return_time, self.symmetry, line, tangent, length
                )
                if candidate.stop_counts != self.stops:
                    raise OrbitError(f"stops: got {candidate.stop_counts}, expected {self.stops}")
            except OrbitError:
                length *= STEP_REDUCTION
                continue
            left = self._distance(candidate)
            if left == distance:
                break
            ahead = length * left / (distance - left)
            if abs(ahead) < CORNER_DISTANCE:
                return candidate, np.abs(self.place(candidate.model) - self.place(orbit.model)) * abs(ahead / length)
            following = tangent_of(candidate, line)
            tangent = following if following @ (weights(candidate.model, line) * tangent) > 0.0 else -following
            orbit, distance, length = candidate, left, LARGEST_SHARE * ahead
        raise OrbitError(f"{line.place(orbit.model)}: no grazing found near the guess")

    def _distance(self, orbit: PeriodicOrbit) -> float:
        return float(grazing_distances(orbit).values()[self.component])


def _first_with(stops: tuple[int, ...], orbit_at: Callable[[float], PeriodicOrbit], longest: float) -> PeriodicOrbit:
    """Return the orbit with these stops at the smallest distance tried, on either side."""
    distance = 0.0
    while distance < longest:
        for side in (1.0, -1.0):
            try:
                orbit = orbit_at(side * distance)
            except OrbitError:
                continue
            if orbit.stop_counts == stops:
                return orbit
        distance = max(STEP_GROWTH * distance, PROBE)
    raise OrbitError(f"stops: got others, expected {stops}")
