"""Orbits that branch off a synchronized orbit where a transverse multiplier is 1, with a as an additional unknown.

Such an orbit is parametrized by its asymmetry d, the difference of the positions of the end blocks while both stick.
By mirror symmetry its a is even in d, a_c + c d² + …. The pitchfork is supercritical if these orbits exist beyond a_c.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 7.4.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow, model_at
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.periodic import Constraint, PeriodicOrbit, orbit_of, refine_orbit, solve_return
from burridge_knopoff.periodic_orbits.return_map import symmetry_breaking_directions
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# Branching orbits are searched for up to this relative distance from a_c.
LARGEST_OFFSET = 0.5


def branching_orbit(critical: PeriodicOrbit, asymmetry: float, near: PeriodicOrbit | None = None) -> PeriodicOrbit:
    """Return the branching orbit of a given asymmetry; its model has the a at which it exists.

    critical : the synchronized orbit at a_c
    near : an orbit of smaller asymmetry returned by this function, which gives a better guess

    The reference is a state in which the end blocks stick. Raises OrbitError if the orbit is not found.
    """
    center = _center_on_end_stick(critical)
    base, blocks, units = center.reference.vector(), center.model.blocks, center.model.chain.own_units
    if near is None:
        vector = base + asymmetry * _branching_direction(center)
        start = ChainState(vector[:blocks], vector[blocks:], center.reference.stuck)
        a, time = center.a + (asymmetry / units.time / center.model.v) ** 2 * center.a, center.return_time
    else:
        # The antisymmetric part grows with the asymmetry, everything else with its square.
        factor = asymmetry / end_block_asymmetry(near)
        change = near.reference.vector() - base
        mirrored = near.reference.mirrored().vector() - base
        vector = base + 0.5 * factor * (change - mirrored) + 0.5 * factor**2 * (change + mirrored)
        start = ChainState(vector[:blocks], vector[blocks:], near.reference.stuck)
        a = center.a + factor**2 * (near.a - center.a)
        time = center.return_time + factor**2 * (near.return_time - center.return_time)
    difference = np.zeros(2 * blocks + 2)
    difference[0], difference[blocks - 1] = 1.0 / units.length, -1.0 / units.length
    line = line_along_a(center.model.chain)
    origin = base, center.return_time, line.coordinate(center.model)
    constraint = Constraint(difference, asymmetry / units.length, origin, line)
    model = model_at(center.model, a)
    orbit = solve_return(model, start, time, Symmetry.ASYMMETRIC, constraint, target_residual=0.0)
    if not abs(orbit.a - center.a) < LARGEST_OFFSET * center.a:
        raise OrbitError(f"asymmetry = {asymmetry!r}: no orbit found near a = {center.a!r}")
    return orbit


def displace_end_blocks(state: ChainState, asymmetry: float) -> ChainState:
    """Return a state with the first block moved forward and the last one back, by half the asymmetry each."""
    shift = np.zeros(len(state.position))
    shift[0], shift[-1] = 0.5 * asymmetry, -0.5 * asymmetry
    return ChainState(state.position + shift, state.velocity, state.stuck)


def end_block_asymmetry(orbit: PeriodicOrbit) -> float:
    """Return x_1 − x_N at the reference of an orbit."""
    return float(orbit.reference.position[0] - orbit.reference.position[-1])


def _branching_direction(orbit: PeriodicOrbit) -> np.ndarray:
    """Return the perturbation with multiplier 1, for a unit difference of the end blocks, shape (2 blocks,)."""
    basis = symmetry_breaking_directions(orbit.reference.stuck)
    values, vectors = np.linalg.eig(basis.T @ orbit.monodromy @ basis)
    direction = basis @ vectors[:, np.abs(values - 1.0).argmin()].real
    return direction / (direction[0] - direction[orbit.model.blocks - 1])


def _center_on_end_stick(orbit: PeriodicOrbit) -> PeriodicOrbit:
    """Return a synchronized orbit with its reference in the longest event-free interval with stuck end blocks."""
    time = orbit.event_rows[:, 0]
    at, kind = orbit.events_of(0)
    if not len(at):
        raise OrbitError(f"a = {orbit.a!r}: the end blocks never stick")
    length = np.diff(time, append=time[:1] + orbit.period)
    middle = time + 0.5 * length
    # The last event of an end block before the middle; before the first event comes the last one of a period.
    sticks = kind[np.searchsorted(at, middle) - 1] == 0
    chosen = float(middle[np.where(sticks, length, -np.inf).argmax()])
    state = flow(orbit.model, orbit.reference, chosen).state()
    return refine_orbit(orbit_of(orbit.model, state, orbit.return_time, orbit.symmetry))
