"""The steady motion that a trajectory settles on, as a set of returns that can be compared with another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from burridge_knopoff.initial import InitialState
from burridge_knopoff.settings import Settings
from burridge_knopoff.simulation import Trajectory, run
from burridge_knopoff.stability.flow import Instant, Model
from burridge_knopoff.summaries.motion import PERIODIC, QUASIPERIODIC, SYNCHRONIZED, motion_kind, section_period

# Share of the returns that must lie near another set for the two to be one: a few may lie where the other has a gap.
SHARE = 0.95

# Sets are one if the distance between them is at most this many times the distance between neighbours within them.
SPACINGS = 3.0

# Closed orbits drift by less than this part of the resolution from one half of the window to the other once they have
# settled; other sets fill up so slowly that the resolution itself must do.
DRIFT = 100.0
CLOSED = (SYNCHRONIZED, PERIODIC)

BATCHES = 6

# Velocity that is rounding.
STANDING = 1e-14


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A settled motion.

    returns : states at the stops of the first block, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : those of the mirrored motion
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    mean_distance, mean_distance_error : ⟨J⟩ and its standard error
    stop_rate : stops of each block in a unit of time, shape (blocks,)
    kind, exponent : kind of motion (summaries.motion) and Lyapunov exponents, the largest first
    settled : whether both halves of the window show the same set
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    mean_distance: float
    mean_distance_error: float
    stop_rate: np.ndarray
    kind: int
    section_period: int
    exponent: np.ndarray
    exponent_error: np.ndarray
    settled: bool

    def mirrored(self) -> SteadyMotion:
        """Return the motion seen from the other end of the chain."""
        changed = {"returns": self.mirror_returns, "mirror_returns": self.returns, "stop_rate": self.stop_rate[::-1]}
        return SteadyMotion(**{**self.__dict__, **changed})

    def symmetrized(self) -> SteadyMotion:
        """Return the motion with the returns of its mirror image added: all of a set that is its own mirror image."""
        both = np.concatenate([self.returns, self.mirror_returns])
        return SteadyMotion(**{**self.__dict__, "returns": both, "mirror_returns": both})

    def instant(self) -> Instant:
        """Return the state at the last return."""
        return instant_of(self.returns[-1])


def instant_of(state: np.ndarray) -> Instant:
    """Return the instant of one return, shape (2 blocks,): a block without velocity sticks there."""
    position, velocity = np.split(state, 2)
    # Another block that stops at the same instant may have been left a rounding of velocity, of either sign.
    stuck = np.abs(velocity) <= STANDING
    return Instant(position.copy(), np.where(stuck, 0.0, velocity), stuck)


def settings_of(model: Model, transient: float, window: float, exponents: int) -> Settings:
    """Return the settings of a run of which only its returns, ⟨J⟩ and exponents are wanted."""
    return Settings(
        v=model.v,
        contact=model.contact,
        transient=transient,
        window=window,
        batches=BATCHES,
        sampling=transient + window,
        trajectory=0.0,
        event_window=window,
        lyapunov_exponents=exponents,
        lyapunov_alignment=transient,
    )


def follow(
    model: Model,
    start: Instant,
    transient: float,
    window: float,
    resolution: float,
    threshold: float,
    motion: Mapping[str, Any],
) -> SteadyMotion | None:
    """Follow a trajectory through a transient and a window; None if it does not complete or hardly ever stops.

    resolution : distance below which attractors are not told apart
    threshold, motion : the config's synchronization_threshold and section `motion`, for the kind of motion
    """
    position = start.position + model.sliding_offset
    initial = InitialState("continued", tuple(position), tuple(start.velocity))
    settings = settings_of(model, transient, window, min(3, 2 * model.chain.blocks))
    trajectory = run(model.chain, model.friction, initial, settings, np.asarray(start.stuck))
    returns = returns_of(model, trajectory, 0)
    mirror_returns = _mirror(returns_of(model, trajectory, model.chain.blocks - 1))
    if trajectory.status != "completed" or min(len(returns), len(mirror_returns)) < 4:
        return None
    first, second = np.array_split(returns, 2)
    spacing = _spacing(second)
    drift = max(distance(first, second), distance(second, first))
    upward = trajectory.crossing_velocity[trajectory.crossing_direction > 0]
    period = section_period(upward, motion["period_tolerance"], motion["longest_period"])
    exponent, error = trajectory.lyapunov_exponent, trajectory.lyapunov_error
    kind = motion_kind(trajectory.mean_distance, threshold, period, exponent, error, motion)
    if kind == QUASIPERIODIC and spacing <= motion["period_tolerance"]:
        # A weakly attracting orbit of a long period: its exponent cannot be told from 0, but its returns repeat.
        kind = PERIODIC
    stops = trajectory.event_block[trajectory.event_kind == 0]
    return SteadyMotion(
        returns=returns,
        mirror_returns=mirror_returns,
        spacing=spacing,
        mean_distance=trajectory.mean_distance,
        mean_distance_error=trajectory.mean_distance_error,
        stop_rate=np.bincount(stops, minlength=model.chain.blocks + 1)[1:] / window,
        kind=kind,
        section_period=period,
        exponent=exponent,
        exponent_error=error,
        settled=drift <= max(resolution / DRIFT if kind in CLOSED else resolution, SPACINGS * spacing),
    )


def returns_of(model: Model, trajectory: Trajectory, block: int) -> np.ndarray:
    """Return the states at the stops of one block in the window, shape (n, 2 blocks), positions co-moving."""
    chosen = (trajectory.event_block == block + 1) & (trajectory.event_kind == 0)
    position = trajectory.event_position[chosen] - model.sliding_offset
    return np.concatenate([position, trajectory.event_velocity[chosen]], axis=1)


def _mirror(returns: np.ndarray) -> np.ndarray:
    position, velocity = np.split(returns, 2, axis=1)
    return np.concatenate([position[:, ::-1], velocity[:, ::-1]], axis=1)


def distance(first: np.ndarray, second: np.ndarray) -> float:
    """Return how far the returns of the first set lie from the second: the distance that SHARE of them keep."""
    nearest, _ = cKDTree(second).query(first, p=np.inf)
    return float(np.quantile(nearest, SHARE))


def _spacing(returns: np.ndarray) -> float:
    """Return the distance within which SHARE of the returns have a neighbour."""
    nearest, _ = cKDTree(returns).query(returns, k=2, p=np.inf)
    return float(np.quantile(nearest[:, 1], SHARE))


def least_distance(first: np.ndarray, second: np.ndarray) -> float:
    """Return the distance between the two nearest returns of two sets."""
    nearest, _ = cKDTree(second).query(first, p=np.inf)
    return float(nearest.min())


def lies_on(motion: SteadyMotion, attractor: SteadyMotion, resolution: float) -> bool:
    """Tell whether the returns of a settled motion lie on an attractor, as far as that is resolved.

    resolution : distance below which attractors are not told apart
    """
    return distance(motion.returns, attractor.returns) <= max(resolution, SPACINGS * attractor.spacing)
