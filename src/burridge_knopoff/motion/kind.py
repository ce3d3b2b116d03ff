"""The kind of motion that a run ended in, from its Lyapunov exponents and from when its state repeats.

No other module decides a kind: the attractors have it from here, and the runs that come to them have theirs.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.motion.period import has_diverging_cycles, period_of
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.status import Status


class MotionKind(IntEnum):
    """Kinds of motion, numbered as in netCDF files.

    PERIODIC motion repeats after `MotionSettings.longest_period` at most. Other regular motion is QUASIPERIODIC, also
    if it is locked with a longer period. SYNCHRONIZED is periodic, with end blocks that move as one; with these chaos
    is SYNCHRONIZED_CHAOS. TRANSIENT_CHAOS is said of sets only, not of runs: chaos of which an ensemble shows that it
    ends, or not that it lasts.

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

    @property
    def words(self) -> str:
        """The kind as a sentence has it."""
        return self.name.lower().replace("_", " ")


#: Regular motion without synchrony. On a dense set of a a torus is locked to closed orbits: which of the two one value
#: of a shows, another beside it need not.
REGULAR = (MotionKind.PERIODIC, MotionKind.QUASIPERIODIC)

#: Chaos, whatever the end blocks do, that no ensemble has shown to end.
CHAOS = (MotionKind.CHAOTIC, MotionKind.SYNCHRONIZED_CHAOS)

#: Motion in which the end blocks move as one.
SYNCHRONOUS = (MotionKind.SYNCHRONIZED, MotionKind.SYNCHRONIZED_CHAOS)

#: Kinds that a closed orbit of which one has seen too little may be given.
UNDECIDED_KINDS = (MotionKind.QUASIPERIODIC, MotionKind.UNDETERMINED)


def is_same_result(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Tell of which kinds of motion two are one result: synchrony, other regular motion, or one sort of chaos."""
    return (one == other) | (np.isin(one, REGULAR) & np.isin(other, REGULAR))


def merge_chaos(kind: np.ndarray) -> np.ndarray:
    """Return kinds with CHAOTIC for every sort of chaos: one that ends, and one with end blocks that move as one."""
    return np.where(np.isin(kind, (*CHAOS, MotionKind.TRANSIENT_CHAOS)), MotionKind.CHAOTIC, kind)


# Largest error of an exponent, in units of `chaotic_exponent`, with which exponents decide the kind.
LARGEST_ERROR = 3.0


def is_zero_exponent(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> np.ndarray:
    """Return which exponents, of these standard errors, cannot be distinguished from 0; all of shape (n,)."""
    return np.abs(exponent) <= np.maximum(
        settings.zero_exponent, settings.standard_errors * _fill_unknown_errors(exponent, error)
    )


def _fill_unknown_errors(exponent: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Return the errors, infinite where that of a finite exponent is not known."""
    return np.where(np.isfinite(exponent) & np.isnan(error), np.inf, error)


def synchronization_distance(mean_distance: float, symmetric: bool) -> float:
    """Return the ⟨J⟩ that tells synchrony: end blocks that are not each other's mirror images do not synchronize."""
    return mean_distance if symmetric else math.inf


def periodic_orbit_kind(mean_distance: float, period: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of a closed orbit with that ⟨J⟩ and that period, which may be infinite: longer than was seen."""
    if mean_distance < settings.synchronization_threshold:
        return MotionKind.SYNCHRONIZED
    return MotionKind.PERIODIC if period <= settings.longest_period else MotionKind.QUASIPERIODIC


def chaotic_kind(mean_distance: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of chaos with that ⟨J⟩."""
    synchronized = mean_distance < settings.synchronization_threshold
    return MotionKind.SYNCHRONIZED_CHAOS if synchronized else MotionKind.CHAOTIC


@dataclass(frozen=True)
class Motion:
    """The kind of motion of a run.

    section_period : upward section points after which the state repeats, 0 if it does not
    period : time after which it does, also if that is too long for periodic motion; NaN if it does not, infinite if the
        motion attracts as a closed orbit does, but has not repeated
    unstable : whether it has stayed on a closed orbit that repels
    """

    kind: MotionKind
    section_period: int = 0
    period: float = math.nan
    unstable: bool = False

    @property
    def can_be_periodic(self) -> bool:
        """Whether the motion may be a closed orbit of which one has seen too little."""
        return self.kind in UNDECIDED_KINDS and not math.isfinite(self.period)


def motion_of_completed_run(run: Mapping[str, Any], mean_distance: float, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a completed run.

    run : its exponents, the largest first, with their standard errors, which may be NaN or empty, and the arrays named
        in `period.SECTION`
    mean_distance : ⟨J⟩; the end blocks move as one where it is below the synchronization threshold

    Closed if the section points repeat, even where an exponent is positive: a symmetric state stays on an orbit that
    repels all others (`unstable`), and chaos may have ended within the window. A run whose turns diverge is leaving
    such an orbit and does not show where it goes: it is undetermined unless an exponent shows chaos. Chaotic if the
    largest exponent is above `chaotic_exponent` and above its error. Otherwise the largest must be 0, that of the flow;
    then the motion is closed if its states repeat or if the next exponent is negative, and quasiperiodic if that one is
    0 as well and the errors are small; but end blocks that move as one hardly ever move on a torus, so that there it
    has to be 0 within one standard error. What is closed is synchronized, or periodic up to the longest period and
    quasiperiodic beyond. Everything else is undetermined, even a largest exponent above `chaotic_exponent` if it is
    within its error; and uniform sliding that attracts, of which no exponent is 0 and the section points are rounding.
    """
    exponents = run["lyapunov_exponent"], run["lyapunov_error"]
    points, period = period_of(run, settings)
    if points and has_diverging_cycles(run, points, settings):
        found = motion_from_period(0, math.nan, mean_distance, *exponents, settings)
        return found if found.kind in CHAOS else Motion(MotionKind.UNDETERMINED)
    return motion_from_period(points, period, mean_distance, *exponents, settings)


def motion_from_period(
    points: int,
    period: float,
    mean_distance: float,
    exponent: np.ndarray,
    error: np.ndarray,
    settings: MotionSettings,
) -> Motion:
    """Return the kind of motion that repeats after this many section points and this time; see `motion_of_run`."""
    error = _fill_unknown_errors(exponent, error)
    if _is_at_rest(exponent, error, settings):
        return Motion(MotionKind.UNDETERMINED)
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
    """Return the kind of motion that is not chaotic and has not repeated; None if it attracts as closed orbits do."""
    known = np.flatnonzero(~np.isnan(exponent))
    zero = is_zero_exponent(exponent, error, settings)
    if len(known) and not zero[0]:
        return MotionKind.UNDETERMINED
    # Errors beyond the threshold of chaos, as where chaos ends within the window, leave the kind open.
    if len(known) and settings.standard_errors * np.nanmax(error[:2]) > LARGEST_ERROR * settings.chaotic_exponent:
        return MotionKind.UNDETERMINED
    if len(known) > 1 and not zero[1]:
        return None
    if len(known) > 1 and mean_distance < settings.synchronization_threshold and exponent[1] < -error[1]:
        return MotionKind.UNDETERMINED
    return (
        MotionKind.QUASIPERIODIC
        if len(known) > 1 and exponent[0] <= settings.chaotic_exponent
        else MotionKind.UNDETERMINED
    )


def _is_positive(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Tell whether the largest exponent, if there is one, is certain to be positive."""
    # An error that is not known makes nothing certain: unlike max, maximum keeps it.
    return bool(
        len(exponent) and exponent[0] > np.maximum(settings.chaotic_exponent, settings.standard_errors * error[0])
    )


def _is_at_rest(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Tell whether the largest exponent, if there is one, is certain to be negative: the flow has none that is 0."""
    return bool(
        len(exponent) and exponent[0] < -np.maximum(settings.zero_exponent, settings.standard_errors * error[0])
    )


def motion_of_run(run: Mapping[str, Any], symmetric: bool, settings: MotionSettings) -> Motion:
    """Return the kind of motion of a run; undetermined if it did not complete.

    run : variables of its point file, or `vars` of its trajectory
    symmetric : whether its chain is its own mirror image
    """
    # A number in a file, a word in a trajectory.
    if run["status"] not in (Status.COMPLETED, Status.COMPLETED.name.lower()):
        return Motion(MotionKind.UNDETERMINED)
    return motion_of_completed_run(run, synchronization_distance(float(run["mean_distance"]), symmetric), settings)


def format_motion(motion: Motion, settings: MotionSettings) -> str:
    """Return the kind of motion as a sentence has it, with what the longest period of periodic motion leaves open."""
    if motion.kind == MotionKind.QUASIPERIODIC:
        locked = f"; locked with a period of {motion.period:.5g}" if math.isfinite(motion.period) else ""
        return f"quasiperiodic within {settings.longest_period:g} time units{locked}"
    period = f", section points repeat after {motion.section_period}" if motion.section_period else ""
    return f"{'unstable ' if motion.unstable else ''}{motion.kind.words}{period}"
