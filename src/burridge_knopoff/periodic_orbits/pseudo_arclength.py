"""Pseudo-arclength continuation of periodic orbits in a parameter: through folds, up to grazings.

A step follows the tangent of the branch in (state, return time, parameter) and is corrected perpendicular to it. Steps
do not pass a grazing, where the branch has a corner (`is_grazing`); `follow` continues beyond it.

Reference: E. J. Doedel, H. B. Keller and J. P. Kernevez, Int. J. Bifurcation Chaos 1 (1991) 493 and 745.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.parameters import CHAIN_PARAMETERS, parameter_key
from burridge_knopoff.periodic_orbits.floquet import Multipliers, multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow, rate
from burridge_knopoff.periodic_orbits.grazing_distances import GrazingDistances, grazing_distances
from burridge_knopoff.periodic_orbits.parameter_line import ParameterLine, line_along_a
from burridge_knopoff.periodic_orbits.periodic import (
    TARGET_RESIDUAL,
    Constraint,
    PeriodicOrbit,
    orbit_of,
    safe_offset,
    solve_return,
)
from burridge_knopoff.periodic_orbits.return_map import ReturnMap, allowed_directions
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import has_passed_sliding, is_sliding, sliding_state

# Weights in the squared length along a branch, which is mostly the change of the parameter. Positions and velocities
# are relative to v/0.1 and, like times, in the chain's own units.
STATE_WEIGHT = 0.01
TIME_WEIGHT = 1e-4

# Step of the finite differences that carry a tangent from one reference state to another.
PART = 1e-6

# Change of the return of an orbit, for v = 0.1, in a step of length 1: about that of a change of 1 in a if all blocks
# stop once in a period. A step of length 1 is at most LONGEST times the parameter or its natural size, if larger.
CHANGE = 0.25
LONGEST = 10.0

# Share of its natural size below which a parameter counts as 0 for the step of a finite difference.
SMALL = 1e-3

# Cosine of the largest angle between the tangents at both ends of a step; sharper turns need shorter steps.
STRAIGHT = 0.8


@dataclass(frozen=True, eq=False)
class BranchOrbit:
    """An orbit on a branch and the unit tangent there, over (positions and velocities, return time, parameter).

    line : the parameter along which the branch is continued, and its unit
    length : distance from the previous orbit, along its tangent
    reduced_orbit : if the branch has reached a branch of simpler orbits, this orbit in its simpler form, more symmetric
        or of half the period, or uniform sliding; the branch ends before it
    distance_to_grazing : length from here to the corner of the branch where the orbit grazes; NaN unless it is next

    >>> from burridge_knopoff import Model, follow, limit_cycle, synchronized_orbit
    >>> model = Model("linearized", a=0.0865)
    >>> orbit = limit_cycle(model, synchronized_orbit(model).reference)
    >>> branch = follow(orbit, (0.086, 0.0875), parameter="a")
    >>> branch[1].tangent.shape, branch[1].is_grazing, branch[1].reduced_orbit
    ((8,), False, None)
    """

    orbit: PeriodicOrbit
    tangent: np.ndarray
    line: ParameterLine
    length: float = 0.0
    reduced_orbit: PeriodicOrbit | None = None
    distance_to_grazing: float = np.nan

    def __repr__(self) -> str:
        return f"<BranchOrbit: {self.orbit!r}>"

    @cached_property
    def value(self) -> float:
        """The value of the parameter along which the branch is continued."""
        return self.line.value(self.orbit.model)

    @property
    def is_grazing(self) -> bool:
        """Whether the orbit grazes, up to rounding errors."""
        return not np.isnan(self.distance_to_grazing)

    @cached_property
    def grazing_distances(self) -> GrazingDistances:
        """The grazing distances of the orbit."""
        return grazing_distances(self.orbit)

    @cached_property
    def multipliers(self) -> Multipliers:
        """Floquet multipliers of the orbit."""
        return multipliers(self.orbit)


def line_of(orbit: PeriodicOrbit, parameter: str) -> ParameterLine:
    """Return the line along one parameter of an orbit, with a unit that changes the return of the orbit by CHANGE.

    The return of a long orbit changes faster, so that its unit is smaller. Positions and velocities are compared in
    units of v, since they grow with v. For a, the unit is the chain's own.

    Raises ValueError, one line, if the model has no parameter of this name with a single value.
    """
    value = orbit.model.parameter(parameter)
    if parameter == "a":
        return line_along_a(orbit.model.chain)
    units = orbit.model.chain.own_units
    state_scale = units.state(orbit.model.blocks)
    scale, change = _natural_size(orbit.model, parameter), 0.0
    size = abs(value) if abs(value) > SMALL * scale else scale
    for step in (PART * size, -PART * size):
        try:
            model = orbit.model.at(**{parameter: value + step})
            larger = model.v / orbit.model.v
            start = ChainState(
                larger * orbit.reference.position, larger * orbit.reference.velocity, orbit.reference.stuck
            )
            end = ReturnMap(model, orbit.symmetry).end(start, orbit.return_time)
        except ValueError:
            continue
        difference = end.vector() / model.scale - orbit.returned.vector() / orbit.model.scale
        change = max(change, float(np.abs(difference * units.velocity / state_scale).max() / abs(step)))
    longest = max(LONGEST * abs(value), scale)
    return ParameterLine((parameter,), (value,), (min(longest, CHANGE / max(change, 1e-300)),), units=units)


def width_of(model: Model, parameter: str, low: float, high: float) -> float:
    """Return the width of an interval of a parameter, or the size of the parameter if it is unbounded or one value.

    The size is that of the value in a model, or the natural one. It also limits the width from both sides.

    Raises ValueError, one line, if the model has no parameter of this name with a single value.
    """
    value, natural = abs(model.parameter(parameter)), _natural_size(model, parameter)
    if 0.0 < high - low < math.inf:
        return min(max(high - low, PART * value), LONGEST * max(value, natural))
    return value or natural


def relative_length(point: BranchOrbit, width: float) -> float:
    """Return how much the state and the parameter, relative to a width, change in a length along a branch.

    Positions and velocities are relative to v/0.1 and in the chain's own units.
    """
    model, units = point.orbit.model, point.line.units
    state = point.tangent[:-2] * units.velocity / (model.scale * units.state(model.blocks))
    return float(np.hypot(np.linalg.norm(state), point.tangent[-1] * point.line.rates[0] / width))


def _natural_size(model: Model, parameter: str) -> float:
    """Return the natural size of a parameter, whatever its value, which may be 0.

    It is the chain's own unit for a and for a parameter of the chain, 1 for weakening and for one of the law, and 0 for
    v, whose size is its value.
    """
    units, key = model.chain.own_units, parameter_key(parameter)
    if parameter == "a":
        return units.slope
    if parameter in model.law.parameters or key == "weakening":
        return 1.0
    if key == "threshold":
        return units.force
    if key == "mass":
        return units.force / units.acceleration
    if key in CHAIN_PARAMETERS:
        return units.force / (units.velocity if key in ("damping", "pulling_damping") else units.length)
    return 0.0


def weights(model: Model, line: ParameterLine) -> np.ndarray:
    """Return the weight of each component of (positions and velocities, return time, parameter) in a squared length."""
    units = line.units
    state = STATE_WEIGHT / model.scale**2 * (units.velocity / units.state(model.blocks)) ** 2
    return np.concatenate([state, [TIME_WEIGHT / units.time**2, 1.0]])


def tangent_of(orbit: PeriodicOrbit, line: ParameterLine) -> np.ndarray:
    """Return the unit tangent of the branch at an orbit, of either sign."""
    model, start, time = orbit.model, orbit.reference, orbit.return_time
    basis, units = allowed_directions(start.stuck, orbit.symmetry), line.units
    scale = units.state(model.blocks)
    count = basis.shape[1]
    mapping, end = ReturnMap(model, orbit.symmetry), orbit.returned
    events = orbit.event_rows[orbit.event_rows[:, 0] <= time, 1:]
    matrix = np.zeros((count + 1, count + 2))
    matrix[:count, :count] = basis.T @ (orbit.monodromy * scale / scale[:, None]) @ basis - np.eye(count)
    matrix[:count, count] = basis.T @ (mapping.time_derivative(end) * units.time / scale)
    matrix[:count, count + 1] = basis.T @ (mapping.parameter_derivative(start, time, end, events, line) / scale)
    matrix[count, :count] = (rate(model, start) * units.time / scale) @ basis
    null = np.linalg.svd(matrix)[2][-1]
    vector = np.concatenate([scale * (basis @ null[:count]), [units.time * null[count], null[count + 1]]])
    return vector / np.sqrt(weights(model, line) @ vector**2)


def adapt_symmetry(line: ParameterLine, orbit: PeriodicOrbit) -> PeriodicOrbit:
    """Return an orbit with the symmetry of all models on a line: ASYMMETRIC if the line breaks the mirror symmetry."""
    model, coordinate = orbit.model, line.coordinate(orbit.model)
    if orbit.symmetry == Symmetry.ASYMMETRIC:
        return orbit
    for step in (PART, -PART):
        try:
            if not line.model(model, coordinate + step).chain.is_mirror_symmetric:
                return solve_return(model, orbit.reference, orbit.period, Symmetry.ASYMMETRIC)
        except OrbitError:
            continue
    return orbit


def begin_branch(orbit: PeriodicOrbit, upward: bool, line: ParameterLine) -> BranchOrbit:
    """Return an orbit with the tangent along which the parameter increases (upward) or decreases."""
    orbit = adapt_symmetry(line, orbit)
    tangent = tangent_of(orbit, line)
    return BranchOrbit(orbit, tangent if (tangent[-1] > 0.0) == upward else -tangent, line)


def solve_ahead(
    model: Model,
    reference: ChainState,
    time: float,
    symmetry: Symmetry,
    line: ParameterLine,
    tangent: np.ndarray,
    length: float,
    target_residual: float = TARGET_RESIDUAL,
) -> PeriodicOrbit:
    """Return the orbit at a length along a tangent from a state, a return time and a model.

    target_residual : residual at which Newton's method ends; 0 iterates to rounding

    Raises OrbitError if none is found.
    """
    blocks, base, coordinate = model.blocks, reference.vector(), line.coordinate(model)
    model_ahead = line.model(model, coordinate + length * float(tangent[-1]))
    guess = base + length * tangent[:-2]
    start = ChainState(guess[:blocks], guess[blocks:], reference.stuck)
    constraint = Constraint(weights(model_ahead, line) * tangent, length, (base, time, coordinate), line)
    after = time + length * float(tangent[-2])
    return solve_return(model_ahead, start, after, symmetry, constraint, target_residual)


def step_along(point: BranchOrbit, length: float, tangent: np.ndarray | None = None) -> BranchOrbit:
    """Return the orbit at a length along the tangent from a point of a branch.

    tangent : replaces that of the point

    Beyond a Hopf bifurcation `reduced_orbit` is uniform sliding.

    Raises OrbitError if none is found, or if the tangent turns too sharply within the step.
    """
    orbit, line = point.orbit, point.line
    tangent = point.tangent if tangent is None else tangent
    solution = solve_ahead(orbit.model, orbit.reference, orbit.return_time, orbit.symmetry, line, tangent, length)
    model = solution.model
    following = tangent_of(solution, line)
    cosine = float(following @ (weights(model, line) * tangent))
    if tangent is point.tangent and abs(cosine) < STRAIGHT:
        raise OrbitError(f"{line.place(model)}: the branch turns too sharply within a step of {length!r}")
    following = following if cosine > 0.0 else -following
    if not any(solution.stop_counts):
        if is_sliding(model, solution.reference):
            raise OrbitError(f"{line.place(model)}: a step of {length!r} ends at uniform sliding")
        if has_passed_sliding(model, orbit.reference, solution.reference):
            sliding = orbit_of(model, sliding_state(model), solution.return_time, orbit.symmetry)
            return BranchOrbit(solution, following, line, length, sliding)
    offset = safe_offset(solution)
    if offset == 0.0:
        return BranchOrbit(solution, following, line, length)
    state = flow(model, solution.reference, offset).state()
    carried = _carry_tangent(solution, following, state, offset, line)
    moved = orbit_of(model, state, solution.return_time, orbit.symmetry)
    following = tangent_of(moved, line)
    side = following @ (weights(model, line) * carried)
    return BranchOrbit(moved, following if side > 0.0 else -following, line, length)


def _carry_tangent(
    orbit: PeriodicOrbit, tangent: np.ndarray, end: ChainState, time: float, line: ParameterLine
) -> np.ndarray:
    """Return a tangent transported to the state `end` a time after the reference, perpendicular to the flow there."""
    blocks = orbit.model.blocks
    vector = orbit.reference.vector() + PART * tangent[:-2]
    near = ChainState(vector[:blocks], vector[blocks:], orbit.reference.stuck)
    model = line.model(orbit.model, line.coordinate(orbit.model) + PART * float(tangent[-1]))
    shifted_end = flow(model, near, time).state()
    scale = line.units.state(blocks)
    change = (shifted_end.vector() - end.vector()) / PART / scale
    along = rate(orbit.model, end) * line.units.time / scale
    return np.concatenate([scale * (change - along * (along @ change) / (along @ along)), tangent[-2:]])
