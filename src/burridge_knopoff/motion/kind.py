"""The kind of motion of a run, from its Lyapunov exponents and the repetition of its state.

Kinds are decided in this module only, for runs and for attractors.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.motion.period import Repetition, repetition_of
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.status import Status


class MotionKind(IntEnum):
    """Kinds of motion, numbered as in netCDF files.

    PERIODIC motion repeats within `MotionSettings.longest_period`. Other regular motion is QUASIPERIODIC, even if it is
    locked with a longer period. In SYNCHRONIZED motion, which is periodic, and in SYNCHRONIZED_CHAOS the end blocks
    move together. TRANSIENT_CHAOS describes sets, not runs: chaos that an ensemble shows to end, or does not show to
    last. SLIDING is uniform sliding.

    >>> from burridge_knopoff import MotionKind
    >>> MotionKind(4).words, MotionKind.CHAOTIC.value
    ('transient chaos', 3)
    """

    UNDETERMINED = -1
    SYNCHRONIZED = 0
    PERIODIC = 1
    QUASIPERIODIC = 2
    CHAOTIC = 3
    TRANSIENT_CHAOS = 4
    SYNCHRONIZED_CHAOS = 5
    SLIDING = 6

    @property
    def words(self) -> str:
        """The kind in words, for a sentence."""
        if self == MotionKind.SLIDING:
            return "uniform sliding"
        return self.name.lower().replace("_", " ")


#: Regular motion without synchrony. A torus is locked to periodic orbits on a dense set of values of a, so that
#: neighbouring values of a may show different kinds of the two.
REGULAR = (MotionKind.PERIODIC, MotionKind.QUASIPERIODIC)

#: Chaos that no ensemble has shown to end, with and without synchronized end blocks.
CHAOS = (MotionKind.CHAOTIC, MotionKind.SYNCHRONIZED_CHAOS)

#: Motion in which the end blocks are synchronized.
SYNCHRONOUS = (MotionKind.SYNCHRONIZED, MotionKind.SYNCHRONIZED_CHAOS)

#: Kinds assigned to motion that may be a periodic orbit whose repetition was not observed.
UNDECIDED_KINDS = (MotionKind.QUASIPERIODIC, MotionKind.UNDETERMINED)


def is_same_result(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return where two kinds of motion are one result: synchrony, other regular motion, or the same chaos."""
    return (one == other) | (np.isin(one, REGULAR) & np.isin(other, REGULAR))


def merge_chaos(kind: np.ndarray) -> np.ndarray:
    """Return kinds with CHAOTIC in place of transient and synchronized chaos."""
    return np.where(np.isin(kind, (*CHAOS, MotionKind.TRANSIENT_CHAOS)), MotionKind.CHAOTIC, kind)


# Largest error of an exponent, in units of `chaotic_exponent`, for which exponents can decide the kind.
LARGEST_ERROR = 3.0

# Factor by which the distance between successive cycles grows if a run leaves an unstable orbit.
DIVERGENCE = 2.0

# Relative difference of the largest W' at section points between the halves of a run without stops above which the run
# still spirals towards uniform sliding, a cycle or a torus, or away from it. Settled tori differed by at most 2e-3 in a
# window of 1000; in one of 7000 an amplitude that changes at a rate of 3e-6 differs by more.
AMPLITUDE_CHANGE = 0.01


def is_zero_exponent(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> np.ndarray:
    """Return a mask of the exponents that cannot be distinguished from 0; exponents, errors and mask of shape (n,)."""
    return np.abs(exponent) <= np.maximum(
        settings.zero_exponent, settings.standard_errors * _fill_unknown_errors(exponent, error)
    )


def _fill_unknown_errors(exponent: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Return the errors, with infinity in place of NaN if the exponent is finite."""
    return np.where(np.isfinite(exponent) & np.isnan(error), np.inf, error)


def synchronization_distance(mean_distance: float, symmetric: bool) -> float:
    """Return the ⟨J⟩ by which synchrony is judged; infinite if the end blocks are not each other's mirror images."""
    return mean_distance if symmetric else math.inf


def periodic_orbit_kind(mean_distance: float, period: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of a periodic orbit with this ⟨J⟩ and period, which is infinite if it is longer than the run."""
    if mean_distance < settings.synchronization_threshold:
        return MotionKind.SYNCHRONIZED
    return MotionKind.PERIODIC if period <= settings.longest_period else MotionKind.QUASIPERIODIC


def chaotic_kind(mean_distance: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of chaos with this ⟨J⟩."""
    synchronized = mean_distance < settings.synchronization_threshold
    return MotionKind.SYNCHRONIZED_CHAOS if synchronized else MotionKind.CHAOTIC


@dataclass(frozen=True)
class Motion:
    """The kind of motion of a run.

    section_period : number of upward section points after which the state repeats, 0 if it does not
    period : time after which the state repeats, even if it is longer than `longest_period`; NaN if the state does not
        repeat; infinite if the exponents are those of an attracting periodic orbit but the state has not repeated
    unstable : whether the motion has stayed on an unstable periodic orbit
    """

    kind: MotionKind
    section_period: int = 0
    period: float = math.nan
    unstable: bool = False

    @property
    def can_be_periodic(self) -> bool:
        """Whether the motion may be periodic although no repetition was observed."""
        return self.kind in UNDECIDED_KINDS and not math.isfinite(self.period)


def motion_of_completed_run(run: Mapping[str, Any], mean_distance: float, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a completed run.

    run : its exponents in descending order with their standard errors, which may be NaN or empty, and the arrays named
        in `period.SECTION`
    mean_distance : ⟨J⟩; the end blocks are synchronized if it is below the synchronization threshold

    The rules, in this order:

    - Motion whose state repeats is periodic, even if an exponent is positive: a symmetric state can stay on an orbit
      that repels all other states (`unstable`), and chaos may have ended within the window. If successive cycles
      diverge, the run is leaving such an orbit: it is undetermined unless an exponent shows chaos. Cycles diverge if
      their distance has grown by the factor DIVERGENCE, or at all if the largest exponent is above `zero_exponent`.
    - Motion is chaotic if the largest exponent is above `chaotic_exponent` and above its error.
    - Otherwise the largest exponent must be 0, that of the flow, and at most `zero_exponent`. The motion is then
      periodic if the next exponent is negative, and quasiperiodic if the next exponent is 0 as well and the errors are
      small. If the end blocks are synchronized, which is rare on a torus, the next exponent must be 0 within one
      standard error.
    - Periodic motion is synchronized, or periodic up to the longest period and quasiperiodic beyond.
    - A largest exponent that is certain to be negative is that of uniform sliding, the only equilibrium, whose section
      points are rounding.
    - All other motion is undetermined. This includes a largest exponent above `zero_exponent` but within its error, and
      motion without repetition of a single block, or without stops and with an amplitude that still changes, as near a
      Hopf bifurcation of uniform sliding: neither is a torus.
    """
    exponents = run["lyapunov_exponent"], run["lyapunov_error"]
    motion = motion_of_repetition(repetition_of(run, settings), mean_distance, *exponents, settings)
    stops, blocks = len(run["event_time"]) > 0, np.shape(run["event_position"])[1]
    # A run that stops within its window has not reached uniform sliding.
    excluded = motion.kind == MotionKind.SLIDING and stops
    if motion.kind == MotionKind.QUASIPERIODIC and not math.isfinite(motion.period):
        excluded |= blocks == 1 or (not stops and _changes_amplitude(run, settings))
    return Motion(MotionKind.UNDETERMINED) if excluded else motion


def _changes_amplitude(run: Mapping[str, np.ndarray], settings: MotionSettings) -> bool:
    """Return whether the largest W' at upward section points differs between the halves of a run."""
    velocity = run["crossing_velocity"][run["crossing_direction"] > 0]
    first, second = (float(half.max(initial=0.0)) for half in np.array_split(velocity, 2))
    return abs(first - second) > max(AMPLITUDE_CHANGE * max(first, second), settings.period_tolerance)


def motion_of_repetition(
    repetition: Repetition, mean_distance: float, exponent: np.ndarray, error: np.ndarray, settings: MotionSettings
) -> Motion:
    """Return the kind of motion of a completed run from the repetition of its state; see `motion_of_completed_run`."""
    is_zero = not len(exponent) or not exponent[0] > settings.zero_exponent
    if repetition.divergence <= (DIVERGENCE if is_zero else 1.0):
        return motion_from_period(repetition.points, repetition.period, mean_distance, exponent, error, settings)
    motion = motion_from_period(0, math.nan, mean_distance, exponent, error, settings)
    return motion if motion.kind in (*CHAOS, MotionKind.SLIDING) else Motion(MotionKind.UNDETERMINED)


def motion_from_period(
    points: int,
    period: float,
    mean_distance: float,
    exponent: np.ndarray,
    error: np.ndarray,
    settings: MotionSettings,
) -> Motion:
    """Return the kind of motion that repeats after this many section points and this time.

    The rules are those of `motion_of_completed_run`.
    """
    error = _fill_unknown_errors(exponent, error)
    if _is_at_rest(exponent, error, settings):
        return Motion(MotionKind.SLIDING)
    positive = _is_positive(exponent, error, settings)
    if points:
        return Motion(periodic_orbit_kind(mean_distance, period, settings), points, period, positive)
    if positive:
        return Motion(chaotic_kind(mean_distance, settings))
    if not math.isfinite(period):
        kind = _kind_by_exponents(mean_distance, exponent, error, settings)
        if kind is not None:
            return Motion(kind)
        period = math.inf
    return Motion(periodic_orbit_kind(mean_distance, period, settings), 0, period)


def _kind_by_exponents(
    mean_distance: float, exponent: np.ndarray, error: np.ndarray, settings: MotionSettings
) -> MotionKind | None:
    """Return the kind of motion that is not chaotic and has not repeated; None if it attracts as periodic orbits do."""
    finite = np.flatnonzero(~np.isnan(exponent))
    zero = is_zero_exponent(exponent, error, settings)
    # An exponent above its threshold may be 0 within its error, but then the error allows weak chaos as well.
    if len(finite) and (not zero[0] or exponent[0] > settings.zero_exponent):
        return MotionKind.UNDETERMINED
    # Errors above the threshold of chaos leave the kind undetermined: chaos may have ended within the window.
    if len(finite) and settings.standard_errors * np.nanmax(error[:2]) > LARGEST_ERROR * settings.chaotic_exponent:
        return MotionKind.UNDETERMINED
    if len(finite) > 1 and not zero[1]:
        return None
    if len(finite) > 1 and mean_distance < settings.synchronization_threshold and exponent[1] < -error[1]:
        return MotionKind.UNDETERMINED
    return MotionKind.QUASIPERIODIC if len(finite) > 1 else MotionKind.UNDETERMINED


def _is_positive(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Return whether the largest exponent, if there is one, is certain to be positive."""
    # With an error of NaN nothing is certain: unlike max, maximum propagates NaN.
    return bool(
        len(exponent) and exponent[0] > np.maximum(settings.chaotic_exponent, settings.standard_errors * error[0])
    )


def _is_at_rest(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Return whether the largest exponent, if there is one, is certain to be negative, as at a fixed point."""
    return bool(
        len(exponent) and exponent[0] < -np.maximum(settings.zero_exponent, settings.standard_errors * error[0])
    )


def motion_of_run(run: Mapping[str, Any], symmetric: bool, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a run; undetermined if it did not complete.

    run : variables of its point file, or `vars` of its trajectory
    symmetric : whether its chain is its own mirror image
    """
    # The status is a number in a file and a word in a trajectory.
    if run["status"] not in (Status.COMPLETED, Status.COMPLETED.name.lower()):
        return Motion(MotionKind.UNDETERMINED)
    return motion_of_completed_run(run, synchronization_distance(float(run["mean_distance"]), symmetric), settings)


def format_motion(motion: Motion, settings: MotionSettings) -> str:
    """Return the kind of motion in words, with its period or the time within which it did not repeat."""
    if motion.kind == MotionKind.QUASIPERIODIC:
        locked = f"; locked with a period of {motion.period:.5g}" if math.isfinite(motion.period) else ""
        return f"quasiperiodic within {settings.longest_period:g} time units{locked}"
    points = motion.section_period
    period = f", repeats after {points} section point{'s' if points > 1 else ''}" if points else ""
    return f"{'unstable ' if motion.unstable else ''}{motion.kind.words}{period}"
