"""Motion without stops: its section, an instant far from sticking, and whether its periodic orbits are isolated.

The section is the maxima of the velocity of a block that moves. Under a law that is linear in speed the equations of
motion without stops are linear: its periodic orbits form a continuum, with any amplitude, and each is neutral.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.uniform_sliding import sliding_state
from burridge_knopoff.running.ensemble import new_ensemble

# Share of the largest amplitude of a velocity below which a block counts as at rest against the driver: a node of a
# mode moves by rounding errors.
MOVING = 1e-3

# Largest distance from uniform sliding, for v = 0.1 in the chain's own units, that counts as none.
SLIDING_DISTANCE = 1e-6

# Largest relative difference of slopes of a friction law that is a rounding error.
ROUNDING = 1e-12

# Number of instants of a period at which velocities are compared.
INSTANTS = 64


def velocity_maxima(model: Model, start: ChainState, begin: float, end: float) -> tuple[np.ndarray, np.ndarray]:
    """Return the maxima of the velocities of the blocks that move, in a motion without stops between two times.

    begin, end : times after that of `start`

    They have the form of events of the kernel: times, shape (n,), and rows of the block from 1, 0, positions x_i and
    velocities U_i', shape (n, 2 + 2 blocks).
    """
    rows = new_ensemble(model).maxima(start.position[None], start.velocity[None], start.stuck[None], begin, end)
    block, states = rows[:, 1].astype(int), rows[:, 2:]
    amplitude = np.zeros(model.blocks)
    np.maximum.at(amplitude, block - 1, states[np.arange(len(rows)), model.blocks + block - 1] - model.v)
    moving = amplitude[block - 1] >= MOVING * amplitude.max()
    return rows[moving, 0], np.concatenate([rows[:, 1:2], np.zeros((len(rows), 1)), states], axis=1)[moving]


def time_to_fast_state(model: Model, state: ChainState, period: float) -> float:
    """Return the time to the instant of a period at which the slowest block is fastest; 0 if it is fast already.

    state : on an orbit without stops, or near it
    """
    slowest = _velocities(model, state, period).min(axis=1)
    fastest = int(slowest.argmax())
    return 0.0 if slowest[0] >= 0.5 * (slowest.min() + slowest[fastest]) else fastest * (period / INSTANTS)


def distance_from_sliding(model: Model, state: ChainState) -> np.ndarray:
    """Return x_i and U_i' − v, for v = 0.1 in the chain's own units, shape (2 blocks,)."""
    return (state.vector() - sliding_state(model).vector()) / model.state_scale


def is_sliding(model: Model, state: ChainState) -> bool:
    """Return whether a state is uniform sliding up to the errors of Newton's method."""
    return bool(np.abs(distance_from_sliding(model, state)).max() <= SLIDING_DISTANCE)


def has_passed_sliding(model: Model, first: ChainState, following: ChainState) -> bool:
    """Return whether uniform sliding lies between the reference states of two neighbouring orbits of a branch.

    At a Hopf bifurcation the branch passes through uniform sliding. Beyond it the orbits are those before it, half a
    period later: their displacements are reversed.
    """
    before, after = distance_from_sliding(model, first), distance_from_sliding(model, following)
    return float(before @ after) < 0.0


def missing_isolation(model: Model, reference: ChainState, period: float) -> str:
    """Return why a periodic motion without stops is not an isolated orbit, in words; empty if it is one.

    reference, period : of the motion
    """
    if is_sliding(model, reference):
        return "the chain slides uniformly there"
    slopes = model.friction_slope(np.abs(_velocities(model, reference, period)))
    if np.ptp(slopes, axis=0).max() > ROUNDING * max(1.0, float(np.abs(slopes).max())):
        return ""
    return "friction is linear in speed there, so that motion without stops has any amplitude and is neutral"


def _velocities(model: Model, state: ChainState, period: float) -> np.ndarray:
    """Return the velocities at equidistant instants of a period, shape (INSTANTS, blocks)."""
    times = np.arange(INSTANTS) * (period / INSTANTS)
    start = state.position[None], state.velocity[None], state.stuck[None]
    return new_ensemble(model).run(*start, times.tolist(), 1)["velocity"][0]
