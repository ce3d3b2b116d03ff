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

from burridge_knopoff.motion.evidence import DIVERGENCE, Evidence, evidence_of
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.status import Status


class MotionKind(IntEnum):
    """Kinds of motion, numbered as in netCDF files.

    In SYNCHRONIZED motion, which is regular, and in SYNCHRONIZED_CHAOS the end blocks move together: ⟨J⟩ alone tells,
    whether the motion repeats or lies on a torus. Other regular motion is PERIODIC if it repeats within
    `MotionSettings.longest_period`, and QUASIPERIODIC otherwise, even if it is locked with a longer period.
    TRANSIENT_CHAOS describes sets, not runs: chaos that an ensemble shows to end, or does not show to last. A run is
    CHAOTIC as long as its chaos lasts. SLIDING is uniform sliding. Motion that still changes in its window is
    UNDETERMINED.

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

#: Kinds assigned to motion without synchrony that may be a periodic orbit whose repetition was not observed.
UNDECIDED_KINDS = (MotionKind.QUASIPERIODIC, MotionKind.UNDETERMINED)


def is_same_result(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Return where two kinds of motion are one result: synchrony, other regular motion, or the same chaos."""
    return (one == other) | (np.isin(one, REGULAR) & np.isin(other, REGULAR))


def merge_chaos(kind: np.ndarray) -> np.ndarray:
    """Return kinds with CHAOTIC in place of transient and synchronized chaos."""
    return np.where(np.isin(kind, (*CHAOS, MotionKind.TRANSIENT_CHAOS)), MotionKind.CHAOTIC, kind)


# Largest error of an exponent, in units of `chaotic_exponent`, for which exponents can decide the kind.
LARGEST_ERROR = 3.0


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


def regular_kind(mean_distance: float, period: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of regular motion with this ⟨J⟩ and period; NaN or infinite if it has not repeated."""
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
        repeat, or if nothing recorded tells it from its mirror image; infinite if the exponents are those of an
        attracting periodic orbit but the state has not repeated
    unstable : whether the motion has stayed on an unstable periodic orbit
    """

    kind: MotionKind
    section_period: int = 0
    period: float = math.nan
    unstable: bool = False

    @property
    def can_be_periodic(self) -> bool:
        """Whether the motion may be periodic, or weakly chaotic, although no repetition was observed."""
        return self.kind in (*UNDECIDED_KINDS, MotionKind.SYNCHRONIZED) and not math.isfinite(self.period)


def motion_of_completed_run(run: Mapping[str, Any], mean_distance: float, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a completed run.

    run : its exponents in descending order with their standard errors, which may be NaN or empty, and the arrays named
        in `evidence.RECORD`
    mean_distance : ⟨J⟩; the end blocks are synchronized if it is below the synchronization threshold

    The rules, in this order:

    - Motion whose state repeats is periodic, even if an exponent is positive: a symmetric state can stay on an orbit
      that repels all other states (`unstable`), and chaos may have ended within the window. If successive cycles
      diverge, the run is leaving such an orbit: it is undetermined unless an exponent shows chaos. Cycles diverge if
      their distance has grown by the factor DIVERGENCE, or at all if the largest exponent is above `zero_exponent`.
    - Motion is chaotic if the largest exponent is above `chaotic_exponent` and above its error, unless its section
      points repeat in the last part of the window: then the chaos has just ended.
    - Otherwise the largest exponent must be 0, that of the flow, and at most `zero_exponent`. The motion is then
      regular: periodic if the next exponent is negative, and quasiperiodic if the next exponent is 0 as well and the
      errors are small.
    - Regular motion is synchronized if ⟨J⟩ says so. Otherwise it is periodic up to the longest period and quasiperiodic
      beyond.
    - A largest exponent that is certain to be negative is that of uniform sliding, the only equilibrium, whose section
      points are rounding.
    - All other motion is undetermined. This includes a largest exponent above `zero_exponent` but within its error,
      motion without repetition of a single block, and regular motion that still changes: ⟨J⟩ approaches 0 or another
      value, the distance of the end blocks grows from synchrony, or, without stops, the amplitude changes, as near a
      Hopf bifurcation of uniform sliding.
    """
    evidence = evidence_of(run, mean_distance, settings)
    return motion_of_evidence(evidence, mean_distance, run["lyapunov_exponent"], run["lyapunov_error"], settings)


def motion_of_evidence(
    evidence: Evidence, mean_distance: float, exponent: np.ndarray, error: np.ndarray, settings: MotionSettings
) -> Motion:
    """Return the kind of motion of a completed run from its evidence; see `motion_of_completed_run`."""
    repetition = evidence.repetition
    is_zero = not len(exponent) or not exponent[0] > settings.zero_exponent
    leaves = not repetition.divergence <= (DIVERGENCE if is_zero else 1.0)
    points, period = (0, math.nan) if leaves else (repetition.points, repetition.period)
    motion = motion_from_period(points, period, mean_distance, exponent, error, settings)
    if motion.kind == MotionKind.SLIDING:
        # A run that stops within its window has not reached uniform sliding.
        excluded = evidence.stops
    else:
        excluded = evidence.settles if motion.kind in CHAOS else evidence.drifts or leaves
    return Motion(MotionKind.UNDETERMINED) if excluded else motion


def motion_from_period(
    points: int,
    period: float,
    mean_distance: float,
    exponent: np.ndarray,
    error: np.ndarray,
    settings: MotionSettings,
) -> Motion:
    """Return the kind of motion that repeats after this many section points and this time; see `Repetition`.

    The rules are those of `motion_of_completed_run`.
    """
    error = _fill_unknown_errors(exponent, error)
    if _is_at_rest(exponent, error, settings):
        return Motion(MotionKind.SLIDING)
    positive = _is_positive(exponent, error, settings)
    if points and math.isnan(period):
        return Motion(MotionKind.PERIODIC, unstable=positive)
    if points:
        return Motion(regular_kind(mean_distance, period, settings), points, period, positive)
    if positive:
        return Motion(chaotic_kind(mean_distance, settings))
    if not math.isfinite(period):
        if not _is_regular(exponent, error, settings):
            return Motion(MotionKind.UNDETERMINED)
        # A second exponent below 0 is that of an attracting periodic orbit.
        period = math.nan if is_zero_exponent(exponent, error, settings)[1] else math.inf
    return Motion(regular_kind(mean_distance, period, settings), 0, period)


def _is_regular(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Return whether exponents that do not show chaos are those of a periodic orbit or a torus."""
    if np.count_nonzero(~np.isnan(exponent)) < 2:
        return False
    # An exponent above its threshold may be 0 within its error, but then the error allows weak chaos as well.
    if not is_zero_exponent(exponent, error, settings)[0] or exponent[0] > settings.zero_exponent:
        return False
    # Errors above the threshold of chaos leave the kind undetermined: chaos may have ended within the window.
    return bool(settings.standard_errors * np.nanmax(error[:2]) <= LARGEST_ERROR * settings.chaotic_exponent)


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
