"""Returns of a trajectory to a section: its states at the stops of one block, as a set to compare with other sets."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.period import orbit_length, section_blocks
from burridge_knopoff.motion.set_distance import SPACINGS, distance, spacing_of
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status

# A velocity of this modulus is rounding.
ZERO_VELOCITY = 1e-14

# A converged periodic orbit drifts by less than the resolution divided by this, since it attracts exponentially. Other
# sets fill so slowly that the resolution itself is the limit.
PERIODIC_DRIFT = 100.0

# Smallest number of returns that represent a set.
MIN_RETURNS = 8

# Largest difference between two parts of one motion in the fraction of all stops made by a pair of mirror blocks.
STOP_SHARE_TOLERANCE = 0.03


@dataclass(frozen=True, eq=False)
class Returns:
    """The returns of a trajectory in a window after a transient.

    returns : states at the stops of one block, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : returns of the mirrored motion; shape (0, 2 blocks) if the chain has no mirror image
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    drift : distance between the returns of the first and of the second half of the window
    stop_count : stops of each block in the window, shape (blocks,)
    window : duration of the window
    block, mirror_block : the block of these returns, the outermost block that stops regularly, and that of the mirrored
        motion; they are equal if both blocks of the pair stop
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    drift: float
    stop_count: np.ndarray
    window: float
    block: int = 1
    mirror_block: int = 1

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
    """Follow a trajectory and return its returns in a window; None if it does not complete or has too few stops."""
    runner = Runner(model, events_from=transient, keep_events=True, stops_only=True)
    runner.begin(start, 0.0)
    if runner.run(transient + window) != Status.COMPLETED:
        return None
    stops = runner.log.events.values()
    return returns_of(model, window, stops[:, 0], lambda chosen: stops[chosen, 2:])


def returns_of(
    model: Model, window: float, block: np.ndarray, states: Callable[[np.ndarray], np.ndarray]
) -> Returns | None:
    """Return the returns among the stops in a window; None if there are too few.

    block : the block of each stop, 1 … N, shape (stops,)
    states : function that takes a mask of this shape and returns the states at the selected stops
    """
    stop_count = np.bincount(block.astype(int), minlength=model.blocks + 1)[1:]
    section, mirror_section = section_blocks(stop_count)
    returns = states(block == section)
    mirror_returns = returns[:0]
    fewest = len(returns)
    if model.chain.is_mirror_symmetric:
        position, velocity = np.split(states(block == model.blocks + 1 - mirror_section), 2, axis=1)
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
        stop_count=stop_count,
        window=window,
        block=section,
        mirror_block=mirror_section,
    )


def has_same_stop_shares(first: np.ndarray, second: np.ndarray) -> bool:
    """Return whether each pair of mirror blocks makes the same fraction of all stops in two motions.

    first, second : number of stops of each block, in any time, shape (blocks,)
    """
    shares = [(stops + stops[::-1]) / stops.sum() for stops in (first, second)]
    return bool(np.abs(np.subtract(*shares)).max() <= STOP_SHARE_TOLERANCE)
