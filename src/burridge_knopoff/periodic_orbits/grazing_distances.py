"""Grazing distances: how far a periodic orbit is from gaining or losing a stick or a slip; 0 at a grazing.

A slip splits where its smallest speed falls to 0. The stick that appears there has a duration that grows as a square
root, so that its square is smooth. Likewise a stick splits where the spring force within it rises to the threshold, and
a slip appears. In the opposite direction the duration of the shortest stick or slip vanishes. If friction drops at the
start of a slip, no stick can become arbitrarily short: a stick disappears in a jump, where the slip before it comes to
rest without deceleration.

Reference: M. di Bernardo, C. J. Budd, A. R. Champneys and P. Kowalczyk, "Piecewise-smooth Dynamical Systems" (Springer
2008), Chapter 8 (sliding bifurcations).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from functools import singledispatch

import numpy as np

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.own_units import OwnUnits
from burridge_knopoff.periodic_orbits.flow import OrbitError, state_after
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner, new_observer
from burridge_knopoff.running.status import Status

# Longest time, in the chain's own unit, between the states searched for smallest speeds and largest forces, and longest
# phase of the fastest mode in that time. The Hermite cubic through two states locates the instant to 1e-5; a
# correction with the acceleration there gives full accuracy.
SPACING = 0.1
LARGEST_PHASE = 0.245

# Number of speed minima of each block that are refined: the smallest ones.
REFINED_MINIMA = 2

# Number of samples whose derivatives are computed at a time; small enough for a fast cache.
CHUNK = 4096

# Rounding errors of accelerations and rates of forces, in the chain's own units.
ROUNDING = 1e-12

# Directions in which a block can slip, by contact.
SLIP_DIRECTIONS = {"one_sided": (1.0,), "symmetric": (1.0, -1.0)}


@dataclass(frozen=True, eq=False)
class GrazingDistances:
    """The grazing distances of each block, shape (blocks,); infinite if the orbit has no such stick or slip.

    stick, slip : duration of the shortest stick and slip
    speed : smallest speed within a slip; force : smallest distance of the spring force from the threshold in a stick
    deceleration : the smallest at the end of a slip, if friction drops at the start of a slip
    """

    stick: np.ndarray
    slip: np.ndarray
    speed: np.ndarray
    force: np.ndarray
    deceleration: np.ndarray

    def values(self) -> np.ndarray:
        """Return quantities that fall to 0 in proportion to the distance from a grazing, shape (5 blocks,)."""
        return np.concatenate([self.stick**2, self.slip**2, self.speed, self.force, self.deceleration**2])

    def in_own_units(self, units: OwnUnits) -> np.ndarray:
        """Return these quantities in the own units of a chain, in which they can be compared."""
        of = [units.time**2, units.time**2, units.velocity, units.force, units.acceleration**2]
        return self.values() / np.repeat(of, len(self.stick))


def has_friction_drop(model: Model) -> bool:
    """Return whether friction drops at the start of a slip."""
    return float(model.law(0.0)) < 1.0 - ROUNDING


def longest_spacing(chain: Chain) -> float:
    """Return the longest time between two samples that resolves the motion of a chain."""
    return min(SPACING * chain.own_units.time, LARGEST_PHASE / chain.highest_rate)


def grazing_distances(orbit: PeriodicOrbit) -> GrazingDistances:
    """Return the grazing distances of an orbit; raises OrbitError if the orbit cannot be integrated."""
    return distances_of(orbit.model, orbit)


@singledispatch
def distances_of(model: Model, orbit: PeriodicOrbit) -> GrazingDistances:
    """Return the grazing distances of an orbit of a model."""
    units = model.chain.own_units
    slow, slack = ROUNDING * units.acceleration, ROUNDING * units.force / units.time
    lengths = [_shortest(orbit, block, kind) for kind in (0, 1) for block in range(model.blocks)]
    longest = longest_spacing(model.chain)
    # On a symmetric orbit a block repeats in the second half the motion of its mirror block in the first half.
    until = orbit.return_time
    time, spacing = np.linspace(0.0, until, math.ceil(until / longest) + 1, retstep=True)
    observer = new_observer(model, 2 * [until + longest], trajectory_time=time, section_only=True)
    runner = Runner(model, observer=observer)
    runner.begin(orbit.reference, 0.0)
    if runner.run(until + longest) != Status.COMPLETED:
        raise OrbitError(f"{model.place}: the run along the orbit ends at τ = {runner.clock:g}")
    results = observer.results()
    position, velocity = results["position"], results["velocity"]
    stuck, event = (np.stack(rows, axis=1) for rows in zip(*_states(orbit, time), strict=True))
    whole = event[:-1] == event[1:]
    again = Runner(model, keep_events=True)
    speed, gap = np.full(model.blocks, np.inf), np.full(model.blocks, np.inf)
    chunks = [slice(first, first + CHUNK) for first in range(0, len(time), CHUNK)]
    parts = [_derivatives(model, position[chunk], velocity[chunk], stuck[chunk]) for chunk in chunks]
    derivatives = [np.concatenate(values) for values in zip(*parts, strict=True)]
    # Backward slips and backward forces are treated with the sign reversed.
    for side in SLIP_DIRECTIONS[model.contact]:
        force, force_rate, acceleration, jerk = (side * values for values in derivatives)
        moving = side * velocity
        for block in range(model.blocks):
            slips = whole[:, block] & ~stuck[:-1, block] & (moving[:-1, block] > 0.0) & (moving[1:, block] > 0.0)
            minima = slips & (acceleration[:-1, block] < -slow) & (acceleration[1:, block] > slow)
            for k in sorted(np.flatnonzero(minima), key=lambda k: moving[k, block])[:REFINED_MINIMA]:
                share = _root(acceleration[k : k + 2, block], jerk[k : k + 2, block] * spacing)
                at = state_after(again, ChainState(position[k], velocity[k], stuck[k]), share * spacing)
                expansion = _derivatives(model, at.position[None], at.velocity[None], at.stuck[None])
                change, second = float(expansion[2][0, block]), float(expansion[3][0, block])
                speed[block] = min(speed[block], side * (at.velocity[block] - 0.5 * change**2 / second))
            sticks = whole[:, block] & stuck[:-1, block]
            peaks = sticks & (force_rate[:-1, block] > slack) & (force_rate[1:, block] < -slack)
            for k in np.flatnonzero(peaks):
                share = force_rate[k, block] / (force_rate[k, block] - force_rate[k + 1, block])
                highest = force[k, block] + 0.5 * share * spacing * force_rate[k, block]
                gap[block] = min(gap[block], model.chain.thresholds[block] - highest)
    if orbit.symmetry == Symmetry.SYMMETRIC:
        speed, gap = (np.minimum(least, least[::-1]) for least in (speed, gap))
    blocks = model.blocks
    return GrazingDistances(
        np.array(lengths[:blocks]), np.array(lengths[blocks:]), speed, gap, _decelerations(orbit, again)
    )


def _decelerations(orbit: PeriodicOrbit, runner: Runner) -> np.ndarray:
    """Return the smallest deceleration at the stops of each block; infinite if friction does not drop.

    runner : of the model of the orbit, with its events kept
    """
    model = orbit.model
    least = np.full(model.blocks, np.inf)
    if has_friction_drop(model):
        state_after(runner, orbit.reference, orbit.period)
        events = runner.log.events.values()
        for number, threshold in enumerate(model.chain.thresholds):
            block_events = events[events[:, 0] == number + 1]
            position, velocity = np.split(block_events[:, 2:], 2, axis=1)
            force = _derivatives(model, position, velocity, velocity == 0.0)[0][:, number]
            # A slip has the direction of the force at its start, the event before its stop.
            along = np.sign(np.roll(force, 1)) * force
            decelerations = (threshold * float(model.law(0.0)) - along) / model.chain.masses[number]
            least[number] = decelerations[block_events[:, 1] == 0].min(initial=np.inf)
    return least


def _shortest(orbit: PeriodicOrbit, block: int, kind: int) -> float:
    """Return the shortest time from an event of a kind to the next event of the block; infinite if there is none."""
    time, event = orbit.events_of(block)
    length = np.diff(time, append=time[:1] + orbit.period)[event == kind]
    # A block that reverses stops and starts at the same time: this is not a short stick.
    reversals = (length == 0.0) & (orbit.model.contact == "symmetric")
    return float(length[~reversals].min(initial=np.inf))


def _states(orbit: PeriodicOrbit, time: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray]]:
    """Yield for each block whether it sticks at each time, and the number of its events before that time."""
    for block in range(orbit.model.blocks):
        at, kind = orbit.events_of(block)
        over = np.searchsorted(at, time)
        first = 1 - kind[0] if len(kind) else 1 - int(orbit.reference.stuck[block])
        yield np.concatenate([[first], kind])[over] == 0, over


def _derivatives(model: Model, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray) -> tuple[np.ndarray, ...]:
    """Return the force, its rate, and acceleration and its rate of slipping blocks, each of shape (n, blocks)."""
    chain = model.chain
    force = chain.thresholds * model.sliding_friction - position @ chain.stiffness.T
    force_rate = -(velocity - model.v) @ chain.stiffness.T
    speed = np.abs(velocity)
    if chain.is_damped:
        force += chain.damping_force(velocity, model.v)
    friction = np.where(velocity < 0.0, -1.0, 1.0) * chain.thresholds * model.friction(speed)
    acceleration = (force - friction) / chain.masses
    if chain.is_damped:
        force_rate -= np.where(stuck, 0.0, acceleration) @ chain.damping_matrix.T
    jerk = (force_rate - chain.thresholds * model.friction_slope(speed) * acceleration) / chain.masses
    return force, force_rate, acceleration, jerk


def _root(value: np.ndarray, slope: np.ndarray) -> float:
    """Return the root in [0, 1] of the Hermite cubic through values of opposite sign, with these slopes."""
    cubic = [
        2.0 * (value[0] - value[1]) + slope[0] + slope[1],
        3.0 * (value[1] - value[0]) - 2.0 * slope[0] - slope[1],
        slope[0],
        value[0],
    ]
    roots = np.roots(cubic)
    inside = roots[(np.abs(roots.imag) < 1e-9) & (roots.real >= 0.0) & (roots.real <= 1.0)].real
    return float(inside[0]) if len(inside) else float(value[0] / (value[0] - value[1]))
