"""Where a trajectory returns to: its states at the stops of one block, a set that can be compared with another."""

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

# Closed orbits drift by less than the resolution over this once they have converged, since they attract exponentially;
# other sets fill up so slowly that the resolution itself must do.
PERIODIC_DRIFT = 100.0

# Fewer returns than this show no set.
MIN_RETURNS = 8

# Share in all stops by which a pair of mirror blocks differs at most between two parts of one motion.
STOP_SHARE_TOLERANCE = 0.03


@dataclass(frozen=True, eq=False)
class Returns:
    """The returns of a trajectory in a window after a transient.

    returns : states at the stops of one block, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : those of the mirrored motion; none, shape (0, 2 blocks), where the chain has no mirror image
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    drift : distance between the returns of the first and of the second half of the window
    stop_count : stops of each block in the window, shape (blocks,)
    window : how long the motion was seen
    block, mirror_block : the block of these returns, the outermost one that stops regularly, and that of the mirrored
        motion: the same if both of the pair stop
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
        """Tell whether the returns are as near to each other as those of a closed orbit."""
        return self.spacing <= tolerance

    def is_periodic(self, tolerance: float) -> bool:
        """Tell whether the returns also come round one after the other, which thin chaos does not."""
        longest = len(self.returns)
        return self.has_periodic_spacing(tolerance) and orbit_length(self.returns, tolerance, longest) < longest

    def is_settled(self, tolerance: float, resolution: float) -> bool:
        """Tell whether both halves of the window show the same set."""
        allowed = resolution / PERIODIC_DRIFT if self.has_periodic_spacing(tolerance) else resolution
        return self.drift <= max(allowed, SPACINGS * self.spacing)

    def state(self) -> ChainState:
        """Return the state at the last return."""
        return state_of(self.returns[-1])


def state_of(state: np.ndarray) -> ChainState:
    """Return the instant of one return, shape (2 blocks,): a block without velocity sticks there."""
    position, velocity = np.split(state, 2)
    # Another block that stops at the same instant may have been left a rounding of velocity, of either sign.
    stuck = np.abs(velocity) <= ZERO_VELOCITY
    return ChainState(position.copy(), np.where(stuck, 0.0, velocity), stuck)


def visit(model: Model, start: ChainState, transient: float, window: float) -> Returns | None:
    """Follow a trajectory and return where it returns to; None if it does not complete or hardly ever stops."""
    runner = Runner(model, events_from=transient, keep_events=True, stops_only=True)
    runner.begin(start, 0.0)
    if runner.run(transient + window) != Status.COMPLETED:
        return None
    stops = runner.log.events.values()
    return returns_of(model, window, stops[:, 0], lambda chosen: stops[chosen, 2:])


def returns_of(
    model: Model, window: float, block: np.ndarray, states: Callable[[np.ndarray], np.ndarray]
) -> Returns | None:
    """Return the returns among a window's stops; None if there are too few.

    block : that stops, 1 … N, shape (stops,); states : gives the states at those that a mask of this shape chooses
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
    """Tell whether each pair of mirror blocks has the same share of all stops in two motions.

    first, second : stops of each block, in any time, shape (blocks,)
    """
    shares = [(stops + stops[::-1]) / stops.sum() for stops in (first, second)]
    return bool(np.abs(np.subtract(*shares)).max() <= STOP_SHARE_TOLERANCE)
