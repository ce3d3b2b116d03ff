"""Returns of a trajectory to a section, as a set to compare with other sets.

The section is the stops of one block. Motion without stops has the maxima of the velocity of one block instead, and
uniform sliding is a single state.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.uniform_sliding import sliding_state
from burridge_knopoff.motion.period import orbit_length, section_blocks
from burridge_knopoff.motion.set_distance import SPACINGS, distance, spacing_of
from burridge_knopoff.periodic_orbits.without_stops import velocity_maxima
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

# A velocity of this modulus is rounding.
ZERO_VELOCITY = 1e-14

# A converged periodic orbit drifts by less than the resolution divided by this, since it attracts exponentially. Other
# sets fill so slowly that the resolution itself is the limit.
PERIODIC_DRIFT = 100.0

# Smallest number of returns that represent a set.
MIN_RETURNS = 8

# Largest distance from uniform sliding, for v = 0.1, that is rounding.
SLIDING_DISTANCE = 1e-10

# Largest difference between two parts of one motion in the fraction of all stops made by a pair of mirror blocks.
STOP_SHARE_TOLERANCE = 0.03


class ReturnSection(IntEnum):
    """Where the returns of a motion are taken.

    STOPS : at the stops of a block
    MAXIMA : at the maxima of the velocity of a block, in motion without stops
    SLIDING : the one state of uniform sliding

    >>> from burridge_knopoff.motion.section_returns import ReturnSection
    >>> ReturnSection.MAXIMA.value
    1
    """

    STOPS = 0
    MAXIMA = 1
    SLIDING = 2


@dataclass(frozen=True, eq=False)
class Returns:
    """The returns of a trajectory in a window after a transient.

    returns : states on the section, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : returns of the mirrored motion; shape (0, 2 blocks) if the chain has no mirror image
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    drift : distance between the returns of the first and of the second half of the window
    stop_count : stops of each block in the window, shape (blocks,)
    window : duration of the window
    block, mirror_block : the block of these returns, the outermost block that stops regularly, and that of the mirrored
        motion; they are equal if both blocks of the pair stop. Without stops, the outermost block whose velocity varies
        regularly
    section, times : where the returns are taken, and when, shape (n,)
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    drift: float
    stop_count: np.ndarray
    window: float
    block: int = 1
    mirror_block: int = 1
    section: ReturnSection = ReturnSection.STOPS
    times: np.ndarray = field(default_factory=lambda: np.zeros(0))

    def has_periodic_spacing(self, tolerance: float) -> bool:
        """Return whether neighbouring returns are as close as those of a periodic orbit."""
        return self.spacing <= tolerance

    def is_periodic(self, tolerance: float) -> bool:
        """Return whether the returns also repeat in order, unlike those of a thin chaotic set."""
        longest = len(self.returns)
        return self.has_periodic_spacing(tolerance) and orbit_length(self.returns, tolerance, longest) < longest

    def is_settled(self, tolerance: float, resolution: float) -> bool:
        """Return whether both halves of the window contain the same set."""
        allowed = resolution / PERIODIC_DRIFT if self.has_periodic_spacing(tolerance) else resolution
        return self.drift <= max(allowed, SPACINGS * self.spacing)

    def state(self) -> ChainState:
        """Return the state at the last return."""
        return state_of(self.returns[-1])


def state_of(state: np.ndarray) -> ChainState:
    """Return the state of one return, shape (2 blocks,), in which a block without velocity sticks."""
    position, velocity = np.split(state, 2)
    # Rounding may leave a velocity of either sign to another block that stops at the same instant.
    stuck = np.abs(velocity) <= ZERO_VELOCITY
    return ChainState(position.copy(), np.where(stuck, 0.0, velocity), stuck)


def visit(model: Model, start: ChainState, transient: float, window: float) -> Returns | None:
    """Follow a trajectory and return its returns in a window; None if it does not complete or has too few stops.

    If it has stopped for the last time by the middle of the window, the returns are those without stops, in the window
    after it.
    """
    runner = Runner(model, events_from=transient, keep_events=True, stops_only=True)
    runner.begin(start, 0.0)
    if runner.run(transient + window) != Status.COMPLETED:
        return None
    times, stops = runner.log.events.times(), runner.log.events.values()
    section = returns_of(model, window, times, stops[:, 0], lambda chosen: stops[chosen, 2:])
    if section is not None or (len(times) and times[-1] > transient + 0.5 * window):
        return section
    return returns_without_stops(model, runner.state(), 0.0, window)


def returns_of(
    model: Model,
    window: float,
    times: np.ndarray,
    block: np.ndarray,
    states: Callable[[np.ndarray], np.ndarray],
    section: ReturnSection = ReturnSection.STOPS,
    weight: np.ndarray | None = None,
) -> Returns | None:
    """Return the returns among the visits to a section in a window; None if there are too few.

    times, block : of each visit, the blocks from 1 to N, shape (visits,)
    states : function that takes a mask of this shape and returns the states at the selected visits
    weight : of each block, shape (blocks,), by which the block of the section is chosen; by default its stops
    """
    count = np.bincount(block.astype(int), minlength=model.blocks + 1)[1:]
    chosen, mirror_chosen = section_blocks(count if weight is None else weight)
    returns = states(block == chosen)
    mirror_returns = returns[:0]
    fewest = len(returns)
    if model.chain.is_mirror_symmetric:
        position, velocity = np.split(states(block == model.blocks + 1 - mirror_chosen), 2, axis=1)
        mirror_returns = np.concatenate([position[:, ::-1], velocity[:, ::-1]], axis=1)
        fewest = min(fewest, len(mirror_returns))
    if fewest < MIN_RETURNS:
        return None
    first, second = np.array_split(returns, 2)
    return Returns(
        returns=returns,
        mirror_returns=mirror_returns,
        spacing=spacing_of(second),
        drift=max(distance(*pair) for pair in ((first, second), (second, first))),
        stop_count=count if section == ReturnSection.STOPS else np.zeros_like(count),
        window=window,
        block=chosen,
        mirror_block=mirror_chosen,
        section=section,
        times=times[block == chosen],
    )


def returns_without_stops(model: Model, start: ChainState, transient: float, window: float) -> Returns | None:
    """Return the maxima of the velocity of a block, or uniform sliding; None if a block sticks or has few maxima."""
    end, sliding = transient + window, sliding_state(model).vector()
    last = new_ensemble(model).run(start.position[None], start.velocity[None], start.stuck[None], [end], 1)
    if last["event_count"][0] or not np.isfinite(last["position"]).all():
        return None
    times, rows = velocity_maxima(model, start, transient, end)
    block, states = rows[:, 0].astype(int), rows[:, 2:]
    final = np.concatenate([last["position"][0, 0], last["velocity"][0, 0]])
    latest = np.concatenate([states[times > transient + 0.5 * window], final[None]])
    drift = float(np.abs(latest - sliding).max())
    if drift <= SLIDING_DISTANCE * model.scale:
        mirrored = sliding[None] if model.chain.is_mirror_symmetric else np.zeros((0, len(sliding)))
        none = np.zeros(model.blocks, dtype=int)
        return Returns(final[None], mirrored, 0.0, drift, none, window, section=ReturnSection.SLIDING)
    highest = np.full(model.blocks, model.v)
    np.maximum.at(highest, block - 1, states[np.arange(len(rows)), model.blocks + block - 1])
    return returns_of(
        model, window, times, block, lambda chosen: states[chosen], ReturnSection.MAXIMA, highest - model.v
    )


def has_same_stop_shares(first: np.ndarray, second: np.ndarray) -> bool:
    """Return whether each pair of mirror blocks makes the same fraction of all stops in two motions.

    first, second : number of stops of each block, in any time, shape (blocks,)
    """
    if not first.sum() or not second.sum():
        return not first.sum() and not second.sum()
    shares = [(stops + stops[::-1]) / stops.sum() for stops in (first, second)]
    return bool(np.abs(np.subtract(*shares)).max() <= STOP_SHARE_TOLERANCE)
