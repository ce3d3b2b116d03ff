"""The steady motion that a trajectory settles on, as a set of returns that can be compared with another."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.status import Status
from burridge_knopoff.stability.motion import (
    OPEN,
    MotionKind,
    closed_kind,
    judged_distance,
    motion_kind,
    section_period,
)
from burridge_knopoff.stability.nearness import distance, is_near, spacing_of
from burridge_knopoff.stability.settings import MotionSettings
from burridge_knopoff.stability.tuning import TUNING, Tuning

BATCHES = 6
EXPONENTS = 3

# A velocity of this modulus is rounding.
STANDING = 1e-14


@dataclass(frozen=True, eq=False)
class Returns:
    """The returns of a trajectory in a window after a transient.

    returns : states at the stops of one block, shape (n, 2 blocks), positions x_i and velocities U_i'
    mirror_returns : those of the mirrored motion; none, shape (0, 2 blocks), where the chain has no mirror image
    spacing : distance (largest difference of a coordinate) between neighbouring returns
    drift : distance between the returns of the first and of the second half of the window
    stop_count : stops of each block in the window, shape (blocks,)
    block, mirror_block : the block of these returns, the outermost one that stops regularly, and that of the mirrored
        motion: the same if both of the pair stop
    """

    returns: np.ndarray
    mirror_returns: np.ndarray
    spacing: float
    drift: float
    stop_count: np.ndarray
    block: int = 1
    mirror_block: int = 1

    def closed(self, tolerance: float) -> bool:
        """Tell whether the returns repeat: the motion is a closed orbit."""
        return self.spacing <= tolerance

    def settled(self, tolerance: float, resolution: float, tuning: Tuning = TUNING) -> bool:
        """Tell whether both halves of the window show the same set."""
        allowed = resolution / tuning.closed_drift if self.closed(tolerance) else resolution
        return self.drift <= max(allowed, tuning.spacings * self.spacing)

    def instant(self) -> Instant:
        """Return the state at the last return."""
        return instant_of(self.returns[-1])


@dataclass(frozen=True, eq=False)
class SteadyMotion:
    """A settled motion with its observables.

    mean_distance, mean_distance_error : ⟨J⟩ and its standard error
    stop_rate : stops of each block in a unit of time, shape (blocks,)
    kind, exponent : kind of motion (stability.motion) and Lyapunov exponents, the largest first

    returns, mirror_returns, spacing, block, mirror_block : see `Returns`
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
    left_for: Instant | None = None

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

    def instant(self) -> Instant:
        """Return the state at the last return."""
        return instant_of(self.returns[-1])


def instant_of(state: np.ndarray) -> Instant:
    """Return the instant of one return, shape (2 blocks,): a block without velocity sticks there."""
    position, velocity = np.split(state, 2)
    # Another block that stops at the same instant may have been left a rounding of velocity, of either sign.
    stuck = np.abs(velocity) <= STANDING
    return Instant(position.copy(), np.where(stuck, 0.0, velocity), stuck)


def visit(model: Model, start: Instant, transient: float, window: float, tuning: Tuning = TUNING) -> Returns | None:
    """Follow a trajectory and return where it returns to; None if it does not complete or hardly ever stops."""
    runner = Runner(model, events_from=transient, keep_events=True)
    runner.begin(start)
    if runner.run(transient + window) != Status.COMPLETED:
        return None
    events = runner.log.events.values()
    return _returns(model, events[:, 0], events[:, 1], events[:, 2:], tuning)


def _returns(model: Model, block: np.ndarray, kind: np.ndarray, states: np.ndarray, tuning: Tuning) -> Returns | None:
    """Return the returns among the states at events of blocks 1 … N and kinds, or None if there are too few."""
    stop_count = np.bincount(block[kind == 0].astype(int), minlength=model.blocks + 1)[1:]
    section, mirror_section = _sections(stop_count, tuning)
    stops = states[(block == section) & (kind == 0)]
    mirror_returns = stops[:0]
    fewest = len(stops)
    if model.chain.is_mirror_symmetric:
        position, velocity = np.split(states[(block == model.blocks + 1 - mirror_section) & (kind == 0)], 2, axis=1)
        mirror_returns = np.concatenate([position[:, ::-1], velocity[:, ::-1]], axis=1)
        fewest = min(fewest, len(mirror_returns))
    if fewest < tuning.fewest_returns:
        return None
    first, second = np.array_split(stops, 2)
    return Returns(
        returns=stops,
        mirror_returns=mirror_returns,
        spacing=spacing_of(second, tuning.near_share),
        drift=max(distance(*pair, tuning.near_share) for pair in ((first, second), (second, first))),
        stop_count=stop_count,
        block=section,
        mirror_block=mirror_section,
    )


def _sections(stops: np.ndarray, tuning: Tuning) -> tuple[int, int]:
    """Return the block, from 1 on, at whose stops a motion is seen, and that of its mirror image.

    stops : of each block, shape (blocks,)

    By shares, which do not depend on how long the motion is seen: of the pairs of mirror blocks that do not hardly ever
    stop the outermost one, and of that the first block, or the one that stops if only one of them does.
    """
    pairs = stops + stops[::-1]
    outer = int(np.argmax(pairs >= tuning.seldom * pairs.max()))
    inner = len(stops) - 1 - outer
    fewer, more = sorted((outer, inner), key=lambda one: (stops[one], -one))
    if stops[fewer] >= tuning.seldom * stops[more]:
        return outer + 1, outer + 1
    return more + 1, fewer + 1


def measure(
    model: Model,
    start: Instant,
    transient: float,
    window: float,
    settings: MotionSettings,
    tuning: Tuning = TUNING,
) -> SteadyMotion | None:
    """Measure the motion from a state that has settled; None if it does not complete or hardly ever stops.

    transient : in which the perturbations turn into the directions of the exponents

    Where only the errors of the exponents leave open which kind it is, or may hide weak chaos, it is measured in a
    longer window, which shows smaller exponents: they are judged by thresholds smaller by the root of the ratio of the
    windows. What may be a torus is followed on for `lasting` transients at least: closed orbits that attract so weakly
    that no exponent shows it have closed by then. If the closed orbit has another ⟨J⟩, the motion was on its way there:
    its kind is left open, and `left_for` is set.
    """
    settings = settings.at_speed(model.v)
    found = measure_once(model, start, transient, window, settings, tuning)
    if found is None or found.kind not in OPEN:
        return found
    usual, last, left = found, found.instant(), tuning.lasting * transient
    if found.kind == MotionKind.UNDETERMINED or found.exponent[0] > 0.0:
        finer = settings.scaled(tuning.longer_window**-0.5)
        longer = measure_once(model, start, transient, tuning.longer_window * window, finer, tuning)
        if longer is not None:
            # The returns stay those of the usual window: their number decides how attractors are told apart.
            found = replace(found, kind=longer.kind, section_period=longer.section_period, exponent=longer.exponent)
            last, left = longer.instant(), max(0.0, left - tuning.longer_window * window)
    if found.kind in OPEN:
        late = visit(model, last, left, window, tuning)
        if late is None or not late.closed(settings.period_tolerance):
            return found
        mean = judged_distance(found.mean_distance, model.chain.is_mirror_symmetric)
        found, last = replace(found, kind=closed_kind(mean, settings)), late.instant()
    if found.kind == MotionKind.CHAOTIC:
        return found
    later = measure_once(model, last, transient, window, settings, tuning)
    if later is None or not _differ(found, later, model, settings, tuning):
        return found
    return replace(usual, left_for=last)


def _differ(one: SteadyMotion, other: SteadyMotion, model: Model, settings: MotionSettings, tuning: Tuning) -> bool:
    """Tell whether ⟨J⟩ of two motions differs beyond its errors."""
    error = float(np.hypot(one.mean_distance_error, other.mean_distance_error))
    allowed = settings.standard_errors * error + tuning.same_mean * model.scale
    return abs(one.mean_distance - other.mean_distance) > allowed


def measure_once(
    model: Model, start: Instant, transient: float, window: float, settings: MotionSettings, tuning: Tuning
) -> SteadyMotion | None:
    """Do the work of `measure` in one window, by settings that are for the speed of the driver already."""
    position = start.position + model.sliding_offset
    initial = InitialState("continued", tuple(position), tuple(start.velocity))
    options = Settings(
        transient=transient,
        window=window,
        batches=BATCHES,
        sampling=transient + window,
        trajectory=0.0,
        event_window=window,
        lyapunov_exponents=EXPONENTS,
        lyapunov_alignment=transient,
    )
    trajectory = run(model, initial, options, start)
    if trajectory.status != "completed":
        return None
    states = np.concatenate([trajectory.event_position - model.sliding_offset, trajectory.event_velocity], axis=1)
    found = _returns(model, trajectory.event_block, trajectory.event_kind, states, tuning)
    if found is None:
        return None
    period = section_period(vars(trajectory), settings)
    exponent, error = trajectory.lyapunov_exponent, trajectory.lyapunov_error
    mean = judged_distance(trajectory.mean_distance, model.chain.is_mirror_symmetric)
    kind = motion_kind(mean, period, exponent, error, settings)
    if kind in OPEN and found.closed(settings.period_tolerance):
        # A weakly attracting orbit of a long period: its exponent may be 0 within its error, but its returns repeat.
        kind = closed_kind(mean, settings)
    stopped = trajectory.event_block[trajectory.event_kind == 0]
    return SteadyMotion(
        returns=found.returns,
        mirror_returns=found.mirror_returns,
        spacing=found.spacing,
        mean_distance=trajectory.mean_distance,
        mean_distance_error=trajectory.mean_distance_error,
        stop_rate=np.bincount(stopped, minlength=model.blocks + 1)[1:] / window,
        kind=kind,
        section_period=period,
        exponent=exponent,
        block=found.block,
        mirror_block=found.mirror_block,
    )


def stops_alike(first: np.ndarray, second: np.ndarray, tuning: Tuning = TUNING) -> bool:
    """Tell whether each pair of mirror blocks has the same share of all stops in two motions.

    first, second : stops of each block, in any time, shape (blocks,)
    """
    shares = [(stops + stops[::-1]) / stops.sum() for stops in (first, second)]
    return bool(np.abs(np.subtract(*shares)).max() <= tuning.same_stops)


def orbit_length(returns: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many returns a closed orbit repeats within the tolerance; `longest` if it takes more."""
    settled = returns[len(returns) // 3 :]
    for length in range(1, min(longest, len(settled) // 2)):
        if np.abs(settled[length:] - settled[:-length]).max() <= tolerance:
            return length
    return longest


def lies_on(
    found: Returns, attractor: SteadyMotion, resolution: float, tolerance: float, tuning: Tuning = TUNING
) -> bool:
    """Tell whether a settled motion lies on an attractor, as far as that is resolved.

    A closed orbit may lie in the midst of a chaotic attractor, but not on it, unless that is so thin that it looks like
    one itself.

    resolution : distance below which attractors are not told apart
    tolerance : distance within which the returns of closed orbits repeat
    """
    chaotic = attractor.kind == MotionKind.CHAOTIC and attractor.spacing > tolerance
    if found.block != attractor.block or (found.closed(tolerance) and chaotic):
        return False
    return is_near(
        found.returns, attractor.returns, max(resolution, tuning.spacings * attractor.spacing), tuning.near_share
    )
