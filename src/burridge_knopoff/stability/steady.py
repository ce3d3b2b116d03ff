"""The steady motion that a trajectory settles on, as a set of returns that can be compared with another."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
from scipy.spatial import cKDTree

from burridge_knopoff.initial import InitialState
from burridge_knopoff.kernel.events import EventLog
from burridge_knopoff.settings import Settings
from burridge_knopoff.simulation import EVENTS_PER_BLOCK_AND_UNIT, run
from burridge_knopoff.stability.flow import COMPLETED, RUNNING, Instant, Model, new_solver
from burridge_knopoff.stability.motion import (
    CHAOTIC,
    PERIODIC,
    QUASIPERIODIC,
    UNDETERMINED,
    motion_kind,
    section_period,
)

# Share of the returns that must lie near another set for the two to be one: a few may lie where the other has a gap.
SHARE = 0.95

# Sets are one if the distance between them is at most this many times the distance between neighbours within them.
SPACINGS = 3.0

# Closed orbits drift by less than this part of the resolution from one half of the window to the other once they have
# settled; other sets fill up so slowly that the resolution itself must do.
DRIFT = 100.0

# A window that has to tell weak chaos from motion on a torus is this many times longer: an exponent of 0.001 is seen.
LONGER = 20.0

BATCHES = 6
EXPONENTS = 3

# A set of fewer returns than this says nothing.
FEWEST = 8

# Velocity that is rounding.
STANDING = 1e-14


@dataclass(frozen=True, eq=False)
class Returns:
    """The returns of a trajectory in a window after a transient.

    returns : states at the stops of the first block, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : those of the mirrored motion
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    drift : distance between the returns of the first and of the second half of the window
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    drift: float

    def closed(self, tolerance: float) -> bool:
        """Tell whether the returns repeat: the motion is a closed orbit."""
        return self.spacing <= tolerance

    def settled(self, tolerance: float, resolution: float) -> bool:
        """Tell whether both halves of the window show the same set."""
        allowed = resolution / DRIFT if self.closed(tolerance) else resolution
        return self.drift <= max(allowed, SPACINGS * self.spacing)

    def instant(self) -> Instant:
        """Return the state at the last return."""
        return instant_of(self.returns[-1])


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A settled motion with its observables.

    mean_distance, mean_distance_error : ⟨J⟩ and its standard error
    stop_rate : stops of each block in a unit of time, shape (blocks,)
    kind, exponent : kind of motion (stability.motion) and Lyapunov exponents, the largest first
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

    def mirrored(self) -> SteadyMotion:
        """Return the motion seen from the other end of the chain."""
        changed = {"returns": self.mirror_returns, "mirror_returns": self.returns, "stop_rate": self.stop_rate[::-1]}
        return SteadyMotion(**{**self.__dict__, **changed})

    def symmetrized(self) -> SteadyMotion:
        """Return the motion with the returns of its mirror image added: all of a set that is its own mirror image."""
        return self.with_returns(np.concatenate([self.returns, self.mirror_returns]))

    def with_returns(self, returns: np.ndarray) -> SteadyMotion:
        """Return the motion with these returns, a set that is its own mirror image."""
        changed = {"returns": returns, "mirror_returns": returns, "spacing": _spacing(returns)}
        return SteadyMotion(**{**self.__dict__, **changed})

    def instant(self) -> Instant:
        """Return the state at the last return."""
        return instant_of(self.returns[-1])


def instant_of(state: np.ndarray) -> Instant:
    """Return the instant of one return, shape (2 blocks,): a block without velocity sticks there."""
    position, velocity = np.split(state, 2)
    # Another block that stops at the same instant may have been left a rounding of velocity, of either sign.
    stuck = np.abs(velocity) <= STANDING
    return Instant(position.copy(), np.where(stuck, 0.0, velocity), stuck)


def visit(model: Model, start: Instant, transient: float, window: float) -> Returns | None:
    """Follow a trajectory and return where it returns to; None if it does not complete or hardly ever stops."""
    blocks = model.chain.blocks
    log = EventLog(blocks, transient, True, EVENTS_PER_BLOCK_AND_UNIT * blocks)
    solver = new_solver(model, log)
    solver.end = transient + window
    solver.begin(start.position, start.velocity, start.stuck)
    while (status := solver.run()) == RUNNING:
        pass
    if status != COMPLETED:
        return None
    events = log.events.values()
    stops = [events[(events[:, 0] == block) & (events[:, 1] == 0.0), 2:] for block in (1, blocks)]
    return _returns(stops[0], stops[1])


def _returns(stops: np.ndarray, last_stops: np.ndarray) -> Returns | None:
    """Return the set of the states at stops of the first block and of the last one, or None if there are too few."""
    if min(len(stops), len(last_stops)) < FEWEST:
        return None
    position, velocity = np.split(last_stops, 2, axis=1)
    first, second = np.array_split(stops, 2)
    return Returns(
        returns=stops,
        mirror_returns=np.concatenate([position[:, ::-1], velocity[:, ::-1]], axis=1),
        spacing=_spacing(second),
        drift=max(distance(first, second), distance(second, first)),
    )


def measure(
    model: Model, start: Instant, transient: float, window: float, threshold: float, motion: Mapping[str, Any]
) -> SteadyMotion | None:
    """Measure the motion from a state that has settled; None if it does not complete or hardly ever stops.

    transient : in which the perturbations turn into the directions of the exponents
    threshold, motion : the config's synchronization_threshold and section `motion`, for the kind of motion

    An exponent that only its error keeps from telling chaos from motion on a torus is measured in a longer window.
    """
    found = _measure(model, start, transient, window, threshold, motion)
    if found is None or found.kind not in (QUASIPERIODIC, UNDETERMINED):
        return found
    if not found.exponent[0] > motion["zero_exponent"]:
        return found
    longer = _measure(model, start, transient, LONGER * window, threshold, motion)
    if longer is None:
        return found
    # The returns stay those of the usual window: their number decides how attractors are told apart.
    judged = {name: getattr(longer, name) for name in ("kind", "section_period", "exponent")}
    return SteadyMotion(**{**found.__dict__, **judged})


def _measure(
    model: Model, start: Instant, transient: float, window: float, threshold: float, motion: Mapping[str, Any]
) -> SteadyMotion | None:
    """Measure the motion in one window; see `measure`."""
    position = start.position + model.sliding_offset
    initial = InitialState("continued", tuple(position), tuple(start.velocity))
    settings = Settings(
        v=model.v,
        contact=model.contact,
        transient=transient,
        window=window,
        batches=BATCHES,
        sampling=transient + window,
        trajectory=0.0,
        event_window=window,
        lyapunov_exponents=min(EXPONENTS, 2 * model.chain.blocks),
        lyapunov_alignment=transient,
    )
    trajectory = run(model.chain, model.friction, initial, settings, np.asarray(start.stuck))
    if trajectory.status != "completed":
        return None
    states = np.concatenate([trajectory.event_position - model.sliding_offset, trajectory.event_velocity], axis=1)
    stopped = trajectory.event_kind == 0
    stops = [states[stopped & (trajectory.event_block == block)] for block in (1, model.chain.blocks)]
    found = _returns(stops[0], stops[1])
    if found is None:
        return None
    upward = trajectory.crossing_velocity[trajectory.crossing_direction > 0]
    period = section_period(upward, motion["period_tolerance"], motion["longest_period"])
    exponent, error = trajectory.lyapunov_exponent, trajectory.lyapunov_error
    kind = motion_kind(trajectory.mean_distance, threshold, period, exponent, error, motion)
    if kind in (QUASIPERIODIC, UNDETERMINED) and found.closed(motion["period_tolerance"]):
        # A weakly attracting orbit of a long period: its exponent cannot be told from 0, but its returns repeat.
        kind = PERIODIC
    return SteadyMotion(
        returns=found.returns,
        mirror_returns=found.mirror_returns,
        spacing=found.spacing,
        mean_distance=trajectory.mean_distance,
        mean_distance_error=trajectory.mean_distance_error,
        stop_rate=np.bincount(trajectory.event_block[stopped], minlength=model.chain.blocks + 1)[1:] / window,
        kind=kind,
        section_period=period,
        exponent=exponent,
    )


def distance(first: np.ndarray, second: np.ndarray) -> float:
    """Return how far the returns of the first set lie from the second: the distance that SHARE of them keep."""
    nearest, _ = cKDTree(second).query(first, p=np.inf)
    return float(np.quantile(nearest, SHARE))


def _spacing(returns: np.ndarray) -> float:
    """Return the distance within which SHARE of the returns have a neighbour."""
    nearest, _ = cKDTree(returns).query(returns, k=2, p=np.inf)
    return float(np.quantile(nearest[:, 1], SHARE))


def orbit_length(returns: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many returns a closed orbit repeats within the tolerance; `longest` if it takes more."""
    settled = returns[len(returns) // 3 :]
    for length in range(1, min(longest, len(settled) // 2)):
        if np.abs(settled[length:] - settled[:-length]).max() <= tolerance:
            return length
    return longest


def least_distance(first: np.ndarray, second: np.ndarray) -> float:
    """Return the distance between the two nearest returns of two sets."""
    nearest, _ = cKDTree(second).query(first, p=np.inf)
    return float(nearest.min())


def lies_on(found: Returns, attractor: SteadyMotion, resolution: float, tolerance: float) -> bool:
    """Tell whether a settled motion lies on an attractor, as far as that is resolved.

    A closed orbit may lie in the midst of a chaotic attractor, but not on it.

    resolution : distance below which attractors are not told apart
    tolerance : distance within which the returns of closed orbits repeat
    """
    if found.closed(tolerance) and attractor.kind == CHAOTIC:
        return False
    return distance(found.returns, attractor.returns) <= max(resolution, SPACINGS * attractor.spacing)
