"""The steady motion that a trajectory settles on: its returns and its observables, measured in a window."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.kind import (
    CHAOS,
    Motion,
    MotionKind,
    chaotic_kind,
    closed_kind,
    judged_distance,
    motion_of,
)
from burridge_knopoff.motion.phase_locking import locked_orbit, recurrence
from burridge_knopoff.motion.section_returns import Returns, returns_of, state_of
from burridge_knopoff.motion.set_distance import is_near, spacing_of
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.motion.tuning import TUNING, Tuning
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

BATCHES = 6
EXPONENTS = 3


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A settled motion with its observables.

    mean_distance, mean_distance_error : ⟨J⟩ and its standard error
    stop_rate : stops of each block in a unit of time, shape (blocks,)
    kind, section_period, period : see `Motion`; the period also of a closed orbit to which the motion is locked
    exponent : Lyapunov exponents, the largest first

    returns, mirror_returns, spacing, block, mirror_block : see `Returns`
    recurrence : see `locking.recurrence`
    left_for : a state on the other motion that this one came to in a longer time; None if it stayed

    >>> from burridge_knopoff import Chain, Model, SearchSettings, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
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

    @property
    def words(self) -> str:
        """Kind of motion, period of a closed orbit, ⟨J⟩ and Lyapunov exponents, in a line."""
        period = f", period {self.period:.6g}" if math.isfinite(self.period) else ""
        exponents = ", ".join(f"{value:.4f}" for value in self.exponent)
        return f"{self.kind.words}{period}, <J> = {self.mean_distance:.6g}, exponents {exponents}"

    def __repr__(self) -> str:
        return f"<SteadyMotion: {self.words}>"

    @property
    def is_open(self) -> bool:
        """Whether the motion may be a closed orbit of which one has seen too little."""
        return Motion(self.kind, period=self.period).is_open

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

    def symmetrized(self, tuning: Tuning = TUNING) -> SteadyMotion:
        """Return the motion with the returns of its mirror image added: all of a set that is its own mirror image."""
        both = np.concatenate([self.returns, self.mirror_returns])
        return self.with_returns(both, both if len(self.mirror_returns) else self.mirror_returns, tuning)

    def with_returns(self, returns: np.ndarray, mirror_returns: np.ndarray, tuning: Tuning = TUNING) -> SteadyMotion:
        """Return the motion with these returns, and these of its mirror image."""
        return replace(
            self, returns=returns, mirror_returns=mirror_returns, spacing=spacing_of(returns, tuning.near_share)
        )

    def state(self) -> ChainState:
        """Return the state at the last return."""
        return state_of(self.returns[-1])


def measure(
    model: Model,
    start: ChainState,
    transient: float,
    window: float,
    settings: MotionSettings,
    tuning: Tuning = TUNING,
) -> SteadyMotion | None:
    """Measure the motion from a state that has settled; None if it does not complete or hardly ever stops.

    transient : in which the perturbations turn into the directions of the exponents

    Where only the errors of the exponents leave open which kind it is, it may be locked to a closed orbit that attracts
    too slowly for them to show it, which is looked for. If there is none, the growth of perturbations in a longer
    window tells regular motion from chaos. Where that leaves it open, the motion is measured in one that is longer
    still: it shows smaller exponents, which are judged by thresholds smaller by the root of the ratio of the windows.
    Longer orbits are looked for in that one; where there is none either, and perturbations have grown faster than on a
    torus, the exponents are measured in the longest window: it is chaos if the largest is beyond its error there.

    If the closed orbit has another ⟨J⟩, or the returns have moved on by the end of the longer window, the motion was on
    its way: its kind is left open, and `left_for` is set.
    """
    settings = settings.at_speed(model.v)
    found = measure_once(model, start, transient, window, settings, tuning)
    if found is None or not found.is_open:
        return found
    usual, last = found, found.state()
    orbit = locked_orbit(model, found.returns, found.recurrence, tuning)
    seen, longer = tuning.longer_window * window, None
    if orbit is None and math.isinf(found.period):
        return found
    if orbit is None:
        # The usual window is part of the longer one, in which ⟨J⟩ is that share of it at least: far from synchrony.
        far = found.mean_distance / tuning.longer_window > settings.synchronization_threshold
        scaled, known = settings.scaled(tuning.longer_window**-0.5), found.mean_distance if far else None
        if far and tuning.growth_window:
            grown = _told_by_growth(model, found, start, transient, tuning.growth_window * window, settings, tuning)
            if grown is not None:
                return grown
        longer = measure_once(model, start, transient, seen, scaled, tuning, known)
    if longer is not None:
        # The returns stay those of the usual window: their number decides how attractors are told apart.
        if longer.kind not in CHAOS and _has_drifted(found, longer, model, tuning):
            return replace(usual, left_for=longer.state())
        told = {name: getattr(longer, name) for name in ("kind", "section_period", "period", "exponent")}
        found, last = replace(found, **told), longer.state()
        if found.is_open:
            orbit = locked_orbit(model, longer.returns, longer.recurrence, tuning)
    if orbit is not None:
        found, last = _locked(found, orbit, settings), orbit.reference
    elif found.is_open and not math.isinf(found.period):
        if found.exponent[0] * seen <= tuning.regular_growth * np.log1p(seen / transient):
            return found
        return _with_weak_chaos(model, found, last, transient, tuning.longest_window * window, settings)
    if found.kind in CHAOS:
        return found
    later = measure_once(model, last, transient, window, settings, tuning)
    if later is None or not _differ(found, later, model, settings, tuning):
        return found
    return replace(usual, left_for=last)


def _told_by_growth(
    model: Model,
    found: SteadyMotion,
    start: ChainState,
    transient: float,
    window: float,
    settings: MotionSettings,
    tuning: Tuning,
) -> SteadyMotion | None:
    """Return a motion far from synchrony as what the growth of perturbations in a window shows it to be; None if open.

    Two exponents are enough; the others stay those of the usual window.
    """
    seen = measure_once(model, start, transient, window, settings, tuning, found.mean_distance, exponents=2)
    if seen is None or not seen.is_open:
        return None
    growth = seen.exponent[0] * window
    exponent = np.concatenate([seen.exponent, found.exponent[2:]])
    if growth >= tuning.chaotic_growth:
        mean = judged_distance(found.mean_distance, model.chain.is_mirror_symmetric)
        return replace(found, kind=chaotic_kind(mean, settings), exponent=exponent)
    if growth > tuning.regular_growth * np.log1p(window / transient):
        return None
    if _has_drifted(found, seen, model, tuning):
        return replace(found, left_for=seen.state())
    return replace(found, kind=MotionKind.QUASIPERIODIC, period=seen.period, exponent=exponent)


def _has_drifted(found: SteadyMotion, longer: SteadyMotion, model: Model, tuning: Tuning) -> bool:
    """Tell whether the last returns of a longer window lie elsewhere than those of a shorter one."""
    if found.block != longer.block:
        return False
    reach = max(tuning.same_mean * model.scale, tuning.spacings * found.spacing)
    return not is_near(longer.returns[-len(found.returns) :], found.returns, reach, tuning.near_share)


def _locked(motion: SteadyMotion, orbit: PeriodicOrbit, settings: MotionSettings) -> SteadyMotion:
    """Return a motion as that of the closed orbit to which it is locked, whose multiplier has the second exponent."""
    mean = judged_distance(motion.mean_distance, orbit.model.chain.is_mirror_symmetric)
    rate = np.log(np.abs(multipliers(orbit).whole[0])) / orbit.period
    kind, exponent = closed_kind(mean, orbit.period, settings), np.array([0.0, rate, *motion.exponent[2:]])
    return replace(motion, kind=kind, period=orbit.period, exponent=exponent)


def _with_weak_chaos(
    model: Model, motion: SteadyMotion, start: ChainState, transient: float, window: float, settings: MotionSettings
) -> SteadyMotion:
    """Return the motion with its exponents from this state on, as chaos if the largest is certain to be positive."""
    options = replace(_options(transient, window, settings), events="none")
    trajectory = run(model, start, options, section_only=True)
    if trajectory.status != "completed":
        return motion
    exponent, error = trajectory.lyapunov_exponent, trajectory.lyapunov_error
    # Errors alone decide: they hold what growth in proportion to time looks like.
    chaotic = exponent[0] > settings.standard_errors * error[0]
    mean = judged_distance(motion.mean_distance, model.chain.is_mirror_symmetric)
    return replace(motion, kind=chaotic_kind(mean, settings) if chaotic else motion.kind, exponent=exponent)


def _options(transient: float, window: float, settings: MotionSettings, exponents: int = EXPONENTS) -> Settings:
    """Return the settings of a run in which a motion is measured."""
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


def _differ(one: SteadyMotion, other: SteadyMotion, model: Model, settings: MotionSettings, tuning: Tuning) -> bool:
    """Tell whether ⟨J⟩ of two motions differs beyond its errors."""
    error = float(np.hypot(one.mean_distance_error, other.mean_distance_error))
    allowed = settings.standard_errors * error + tuning.same_mean * model.scale
    return abs(one.mean_distance - other.mean_distance) > allowed


def measure_once(
    model: Model,
    start: ChainState,
    transient: float,
    window: float,
    settings: MotionSettings,
    tuning: Tuning,
    mean_distance: float | None = None,
    exponents: int = EXPONENTS,
) -> SteadyMotion | None:
    """Do the work of `measure` in one window, by settings that are for the speed of the driver already.

    mean_distance : what ⟨J⟩ is taken for instead of being measured; exponents : how many are computed
    """
    known = mean_distance is not None
    options = _options(transient, window, settings, exponents)
    trajectory = run(model, start, options, section_only=known, stops_only=True)
    mean_distance = trajectory.mean_distance if mean_distance is None else mean_distance
    if trajectory.status != "completed":
        return None
    block = trajectory.event_block

    def states(chosen: np.ndarray) -> np.ndarray:
        position = trajectory.event_position[chosen] - model.sliding_offset
        return np.concatenate([position, trajectory.event_velocity[chosen]], axis=1)

    found = returns_of(model, window, block, states, tuning)
    if found is None:
        return None
    mean = judged_distance(mean_distance, model.chain.is_mirror_symmetric)
    told = motion_of(vars(trajectory), mean, settings)
    return SteadyMotion(
        returns=found.returns,
        mirror_returns=found.mirror_returns,
        spacing=found.spacing,
        mean_distance=mean_distance,
        mean_distance_error=trajectory.mean_distance_error,
        stop_rate=np.bincount(block, minlength=model.blocks + 1)[1:] / window,
        kind=told.kind,
        section_period=told.section_period,
        period=told.period,
        exponent=trajectory.lyapunov_exponent,
        block=found.block,
        mirror_block=found.mirror_block,
        recurrence=recurrence(trajectory.event_time[block == found.block], found.returns, tuning),
    )


def lies_on(
    found: Returns, attractor: SteadyMotion, resolution: float, tolerance: float, tuning: Tuning = TUNING
) -> bool:
    """Tell whether a settled motion lies on an attractor, as far as that is resolved.

    A closed orbit may lie in the midst of a chaotic attractor, but not on it, unless that is so thin that it looks like
    one itself.

    resolution : distance below which attractors are not told apart
    tolerance : distance within which the returns of closed orbits repeat
    """
    chaotic = attractor.kind in CHAOS and attractor.spacing > tolerance
    if found.block != attractor.block or (found.repeats(tolerance) and chaotic):
        return False
    return is_near(
        found.returns, attractor.returns, max(resolution, tuning.spacings * attractor.spacing), tuning.near_share
    )
