"""The steady motion of a trajectory: its section returns and its observables, measured in one window."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.uniform_sliding import eigenvalues, sliding_state
from burridge_knopoff.motion.kind import (
    CHAOS,
    Motion,
    MotionKind,
    motion_of_completed_run,
    regular_kind,
    synchronization_distance,
)
from burridge_knopoff.motion.period import REPETITIONS, orbit_length
from burridge_knopoff.motion.phase_locking import recurrence
from burridge_knopoff.motion.section_returns import Returns, ReturnSection, returns_of, returns_without_stops, state_of
from burridge_knopoff.motion.set_distance import SPACINGS, is_near, spacing_of
from burridge_knopoff.motion.settings import EXPONENTS, MotionSettings
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

BATCHES = 6

# Two periods of one motion, by the section of a run and by the maxima of a velocity, differ relatively by less.
SAME_PERIOD = 1e-6


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A settled motion with its observables.

    mean_distance, mean_distance_error : ⟨J⟩ and its standard error
    stop_rate : stops of each block per unit of time, shape (blocks,)
    kind, section_period, period : see `Motion`; if the motion is locked, `period` is that of the periodic orbit
    exponent : Lyapunov exponents in descending order

    returns, mirror_returns, spacing, block, mirror_block, section : see `Returns`
    recurrence : see `phase_locking.recurrence`
    left_for : a state of the later motion if this motion proved to be a transient, otherwise None
    return_rate : number of returns per unit of time

    >>> from burridge_knopoff import Model, SearchSettings, find_attractors
    >>> model = Model("linearized", a=0.08)
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> motion = attractors[1].motion
    >>> motion.kind.words, round(motion.mean_distance, 3), motion.returns.shape[1], motion.stop_rate.shape
    ('periodic', 0.141, 6, (3,))
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    mean_distance: float
    mean_distance_error: float
    stop_rate: np.ndarray
    kind: MotionKind
    section_period: int
    exponent: np.ndarray
    block: int = 1
    mirror_block: int = 1
    period: float = math.nan
    recurrence: float = 0.0
    left_for: ChainState | None = None
    section: ReturnSection = ReturnSection.STOPS
    return_rate: float = math.nan

    def __post_init__(self) -> None:
        """Sort the exponents, which may come from several measurements."""
        object.__setattr__(self, "exponent", -np.sort(-self.exponent))

    @property
    def words(self) -> str:
        """Kind of motion, period of a periodic orbit, ⟨J⟩ and Lyapunov exponents, in one line."""
        period = f", period {self.period:.6g}" if math.isfinite(self.period) else ""
        exponents = ", ".join(f"{value:.4f}" for value in self.exponent)
        return f"{self.kind.words}{period}, <J> = {self.mean_distance:.6g}, exponents {exponents}"

    def __repr__(self) -> str:
        return f"<SteadyMotion: {self.words}>"

    @property
    def can_be_periodic(self) -> bool:
        """Whether the motion may be periodic although no repetition was observed."""
        return Motion(self.kind, period=self.period).can_be_periodic

    def mirrored(self) -> SteadyMotion:
        """Return the motion seen from the other end of the chain."""
        return replace(
            self,
            returns=self.mirror_returns,
            mirror_returns=self.returns,
            stop_rate=self.stop_rate[::-1],
            block=self.mirror_block,
            mirror_block=self.block,
        )

    def symmetrized(self) -> SteadyMotion:
        """Return the motion together with the returns of its mirror image, for a set that is its own mirror image."""
        both = np.concatenate([self.returns, self.mirror_returns])
        return self.replace_returns(both, both if len(self.mirror_returns) else self.mirror_returns)

    def replace_returns(self, returns: np.ndarray, mirror_returns: np.ndarray) -> SteadyMotion:
        """Return the motion with other returns, and other returns of its mirror image."""
        return replace(self, returns=returns, mirror_returns=mirror_returns, spacing=spacing_of(returns))

    def amplitude(self, v: float) -> float:
        """Return the root mean square distance of the returns from uniform sliding at the driver velocity v."""
        position, velocity = np.split(self.returns, 2, axis=1)
        return float(np.sqrt(np.mean(position**2 + (velocity - v) ** 2)))

    def state(self) -> ChainState:
        """Return the state at the last return."""
        return state_of(self.returns[-1])


def run_options(transient: float, window: float, settings: MotionSettings, exponents: int = EXPONENTS) -> Settings:
    """Return the settings of a run in which a motion is observed."""
    return Settings(
        transient=transient,
        window=window,
        batches=BATCHES,
        sampling=transient + window,
        trajectory=0.0,
        event_window=window,
        section=settings.section,
        lyapunov_exponents=exponents,
        lyapunov_alignment=transient,
    )


def observe(
    model: Model,
    start: ChainState,
    transient: float,
    window: float,
    settings: MotionSettings,
    mean_distance: float | None = None,
    exponents: int = EXPONENTS,
) -> SteadyMotion | None:
    """Observe the motion from a state in one window; None if the run does not complete or has too few stops.

    transient : time in which perturbations align with the directions of the exponents
    settings : scaled to the driver velocity, see `MotionSettings.scaled_to_velocity`
    mean_distance : ⟨J⟩ if it is known; otherwise it is measured
    exponents : number of exponents to compute
    """
    has_mean = mean_distance is not None
    options = run_options(transient, window, settings, exponents)
    trajectory = run(model, start, options, section_only=has_mean, stops_only=True)
    mean_distance = trajectory.mean_distance if mean_distance is None else mean_distance
    if trajectory.status != "completed":
        return None
    block, times = trajectory.event_block, trajectory.event_time

    def states(chosen: np.ndarray) -> np.ndarray:
        position = trajectory.event_position[chosen] - model.sliding_offset
        return np.concatenate([position, trajectory.event_velocity[chosen]], axis=1)

    section = returns_of(model, window, times, block, states)
    if section is None and not len(block):
        section = returns_without_stops(model, start, transient, window)
    if section is None:
        return None
    mean = synchronization_distance(mean_distance, model.chain.is_mirror_symmetric)
    motion = motion_of_completed_run(vars(trajectory), mean, settings)
    if section.section == ReturnSection.MAXIMA:
        motion = _without_stops(motion, section, mean, settings)
    return SteadyMotion(
        returns=section.returns,
        mirror_returns=section.mirror_returns,
        spacing=section.spacing,
        mean_distance=mean_distance,
        mean_distance_error=trajectory.mean_distance_error,
        stop_rate=np.bincount(block, minlength=model.blocks + 1)[1:] / window,
        kind=motion.kind,
        section_period=motion.section_period,
        period=motion.period,
        exponent=trajectory.lyapunov_exponent,
        block=section.block,
        mirror_block=section.mirror_block,
        recurrence=recurrence(section.times, section.returns),
        section=section.section,
        return_rate=len(section.returns) / window,
    )


def _without_stops(motion: Motion, section: Returns, mean: float, settings: MotionSettings) -> Motion:
    """Return the kind of a motion without stops that repeats; the section of a run does not show it.

    W, the sum of all x_i, is rounding if blocks move in opposite phases.
    """
    longest = len(section.returns) // REPETITIONS
    length = orbit_length(section.returns, settings.period_tolerance, longest + 1)
    if motion.kind in CHAOS or length > longest:
        return motion
    period = float(section.times[-1] - section.times[-1 - length])
    points = motion.section_period if math.isclose(motion.period, period, rel_tol=SAME_PERIOD) else 0
    return Motion(regular_kind(mean, period, settings), points, period)


def sliding_motion(model: Model) -> SteadyMotion:
    """Return uniform sliding as a motion; its exponents are the real parts of the eigenvalues of its Jacobian."""
    state = sliding_state(model).vector()[None]
    return SteadyMotion(
        returns=state,
        mirror_returns=state if model.chain.is_mirror_symmetric else state[:0],
        spacing=0.0,
        mean_distance=0.0,
        mean_distance_error=0.0,
        stop_rate=np.zeros(model.blocks),
        kind=MotionKind.SLIDING,
        section_period=0,
        exponent=-np.sort(-eigenvalues(model).real)[:EXPONENTS],
        section=ReturnSection.SLIDING,
    )


def is_on_attractor(section: Returns, attractor: SteadyMotion, resolution: float, tolerance: float) -> bool:
    """Return whether a settled motion lies on an attractor, within the resolution.

    A periodic orbit may be embedded in a chaotic attractor, but is not part of the attractor, unless the attractor is
    so thin that it looks like a periodic orbit.

    resolution : distance below which attractors are not distinguished
    tolerance : distance within which the returns of periodic orbits repeat
    """
    if attractor.section == ReturnSection.SLIDING:
        # A motion that spirals inward is closer in the second half of its window.
        latest = section.returns[len(section.returns) // 2 :]
        return section.section != ReturnSection.STOPS and is_near(latest, attractor.returns, resolution)
    chaotic = attractor.kind in CHAOS and attractor.spacing > tolerance
    if section.section != attractor.section:
        return False
    if section.block != attractor.block or (section.is_periodic(tolerance) and chaotic):
        return False
    return is_near(section.returns, attractor.returns, max(resolution, SPACINGS * attractor.spacing))
