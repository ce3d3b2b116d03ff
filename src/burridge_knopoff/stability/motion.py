"""The kind of motion that a run ended in, from its Lyapunov exponents and its section points."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from enum import IntEnum
from typing import Any

import numpy as np

from burridge_knopoff.running.status import Status
from burridge_knopoff.stability.settings import MotionSettings


class MotionKind(IntEnum):
    """Kinds of motion, numbered as in netCDF files.

    SYNCHRONIZED is periodic, with end blocks that move as one. TRANSIENT_CHAOS is said of sets only, not of runs: chaos
    of which an ensemble shows that it ends, or not that it lasts.

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

    @property
    def words(self) -> str:
        """The kind as a sentence has it."""
        return self.name.lower().replace("_", " ")


#: Closed orbits without synchrony, and tori. On a dense set of a a torus is locked to closed orbits: which of the two
#: one value of a shows, another beside it need not.
REGULAR = (MotionKind.PERIODIC, MotionKind.QUASIPERIODIC)

#: Kinds that a closed orbit of which one has seen too little may be given.
OPEN = (MotionKind.QUASIPERIODIC, MotionKind.UNDETERMINED)


def same_result(one: np.ndarray, other: np.ndarray) -> np.ndarray:
    """Tell of which kinds of motion two are one result: synchrony, other regular motion, or chaos."""
    return (one == other) | (np.isin(one, REGULAR) & np.isin(other, REGULAR))


# Largest error of an exponent, in units of `chaotic_exponent`, with which exponents decide the kind.
LARGEST_ERROR = 3.0

# Points of a closed orbit of a long period are nearer to each other than this share of their even spacing.
CLOSER = 0.1

# A period counts if the sequence shows it at least this many times.
REPETITIONS = 3


def repetition(sequence: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many rows a sequence, shape (n,) or (n, m), repeats within tolerance; 0 if it does not.

    longest : largest period looked for; the sequence has to show it REPETITIONS times
    """
    for period in range(1, min(longest, len(sequence) // REPETITIONS) + 1):
        if _repeats(sequence, period, tolerance):
            return period
    return 0


def _repeats(sequence: np.ndarray, period: int, tolerance: float) -> bool:
    turns = sequence[: len(sequence) // period * period].reshape(-1, period, *sequence.shape[1:])
    return bool(np.ptp(turns, axis=0).max() <= tolerance)


#: What `section_period` looks at, by the names of point files.
SECTION = (
    *("crossing_velocity", "crossing_time", "crossing_direction"),
    *("event_time", "event_block", "event_kind", "event_position", "event_velocity"),
)


def section_period(run: Mapping[str, np.ndarray], settings: MotionSettings) -> int:
    """Return after how many upward section points the state of all blocks repeats; 0 if it does not.

    run : arrays of a run named in SECTION, of its events at least the stops; the second half of its section points is
        judged, so that a slow approach does not hide a period

    W is a sum over all blocks and cannot tell a state from its mirror image: on an orbit that is its own mirror image
    after half its period W' repeats twice in a period. So the states at the first event after each section point have
    to repeat as well. Where too few are known to show that, as in motion without events, W' alone is judged.
    """
    upward = run["crossing_direction"] > 0
    velocity, time = (_second_half(run[name][upward]) for name in ("crossing_velocity", "crossing_time"))
    period = repetition(velocity, settings.period_tolerance, settings.longest_period)
    event_time = run["event_time"]
    if not period or not len(event_time):
        return period
    following = np.searchsorted(event_time, time[time >= event_time[0]], side="right")
    following = following[following < len(event_time)]
    states = np.concatenate([run["event_position"][following], run["event_velocity"][following]], axis=1)
    if len(states) < REPETITIONS * period:
        return period
    for multiple in range(period, min(settings.longest_period, len(states) // REPETITIONS) + 1, period):
        if _repeats(states, multiple, settings.period_tolerance):
            return multiple
    return 0


def _stops_repeat(run: Mapping[str, np.ndarray], settings: MotionSettings) -> bool:
    """Tell whether the states at the stops of a block repeat, where W hardly ever crosses 0."""
    stops = run["event_kind"] == 0
    own = stops & (run["event_block"] == run["event_block"][stops].min(initial=np.iinfo(np.int16).max))
    states = _second_half(np.concatenate([run["event_position"][own], run["event_velocity"][own]], axis=1))
    return repetition(states, settings.period_tolerance, settings.longest_period) > 0


def _second_half(values: np.ndarray) -> np.ndarray:
    return values[len(values) // 2 :]


def section_closed(section: np.ndarray, tolerance: float) -> bool:
    """Tell whether section points W' repeat, however long the period: almost all have another within the tolerance.

    section : shape (n,); its second half is judged

    On a torus points fill an interval evenly, the closer the more there are: on a closed orbit they are closer still.
    """
    settled = np.sort(_second_half(section))
    if len(settled) < 4 * REPETITIONS:
        return False
    gap = np.diff(settled)
    nearest = np.minimum(np.concatenate([[np.inf], gap]), np.concatenate([gap, [np.inf]]))
    even = np.ptp(settled) / len(settled)
    return bool(np.quantile(nearest, 0.95) <= min(tolerance, CLOSER * even))


def zero_exponents(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> np.ndarray:
    """Return which exponents, of these standard errors, cannot be distinguished from 0; all of shape (n,)."""
    return np.abs(exponent) <= np.maximum(settings.zero_exponent, settings.standard_errors * _certain(exponent, error))


def _certain(exponent: np.ndarray, error: np.ndarray) -> np.ndarray:
    """Return the errors, infinite where that of a finite exponent is not known."""
    return np.where(np.isfinite(exponent) & np.isnan(error), np.inf, error)


def judged_distance(mean_distance: float, symmetric: bool) -> float:
    """Return the ⟨J⟩ that tells synchrony: end blocks that are not each other's mirror images do not synchronize."""
    return mean_distance if symmetric else math.inf


def closed_kind(mean_distance: float, settings: MotionSettings) -> MotionKind:
    """Return the kind of a closed orbit with that ⟨J⟩."""
    return MotionKind.SYNCHRONIZED if mean_distance < settings.synchronization_threshold else MotionKind.PERIODIC


def motion_kind(
    mean_distance: float, period: int, exponent: np.ndarray, error: np.ndarray, settings: MotionSettings
) -> MotionKind:
    """Return the kind of motion of a completed run.

    mean_distance : ⟨J⟩; the end blocks move as one where it is below the synchronization threshold
    period : of the section points, 0 if they do not repeat
    exponent, error : Lyapunov exponents, the largest first, and their standard errors; may be NaN or empty

    Periodic if the section points repeat, even where an exponent is positive: a symmetric state stays on an orbit that
    repels all others (`is_unstable`), and chaos may have ended within the window. Chaotic if the largest exponent is
    above `chaotic_exponent` and above its error. Otherwise the largest must be 0, that of the flow; then the motion is
    periodic if the next exponent is negative, and quasiperiodic if that one is 0 as well and the errors are small; but
    end blocks that move as one hardly ever move on a torus, so that there it has to be 0 within one standard error.
    Everything else is undetermined, even a largest exponent above `chaotic_exponent` if it is within its error; and
    uniform sliding that attracts, of which no exponent is 0 and the section points are rounding.
    """
    known = np.flatnonzero(~np.isnan(exponent))
    error = _certain(exponent, error)
    if period and not _is_at_rest(exponent, error, settings):
        return closed_kind(mean_distance, settings)
    if _is_positive(exponent, error, settings):
        return MotionKind.CHAOTIC
    zero = zero_exponents(exponent, error, settings)
    if len(known) and not zero[0]:
        return MotionKind.UNDETERMINED
    # Errors beyond the threshold of chaos, as where chaos ends within the window, leave the kind open.
    if len(known) and settings.standard_errors * np.nanmax(error[:2]) > LARGEST_ERROR * settings.chaotic_exponent:
        return MotionKind.UNDETERMINED
    if len(known) > 1 and not zero[1]:
        return closed_kind(mean_distance, settings)
    if len(known) > 1 and mean_distance < settings.synchronization_threshold and exponent[1] < -error[1]:
        return MotionKind.UNDETERMINED
    return (
        MotionKind.QUASIPERIODIC
        if len(known) > 1 and exponent[0] <= settings.chaotic_exponent
        else MotionKind.UNDETERMINED
    )


def is_unstable(period: int, exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> bool:
    """Tell whether a run has stayed on a closed orbit that repels: a positive exponent although the motion repeats.

    period, exponent, error : see `motion_kind`
    """
    return period > 0 and _is_positive(exponent, error, settings)


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


@dataclass(frozen=True)
class MotionOfRun:
    """The kind of motion that a run ended in.

    section_period : upward section points after which the state repeats, 0 if it does not
    unstable : whether it has stayed on a closed orbit that repels
    """

    kind: MotionKind
    section_period: int
    unstable: bool

    @property
    def words(self) -> str:
        """The kind as a sentence has it."""
        period = f", section points repeat after {self.section_period}" if self.section_period else ""
        return f"{'unstable ' if self.unstable else ''}{self.kind.words}{period}"


def motion_of_run(run: Mapping[str, Any], symmetric: bool, settings: MotionSettings) -> MotionOfRun:
    """Return the kind of motion of a run; undetermined if it did not complete.

    run : variables of its point file, or `vars` of its trajectory
    symmetric : whether its chain is its own mirror image
    """
    exponent, error = run["lyapunov_exponent"], run["lyapunov_error"]
    period = 0 if _is_at_rest(exponent, error, settings) else section_period(run, settings)
    kind = MotionKind.UNDETERMINED
    # A number in a file, a word in a trajectory.
    if run["status"] in (Status.COMPLETED, Status.COMPLETED.name.lower()):
        mean = judged_distance(float(run["mean_distance"]), symmetric)
        kind = motion_kind(mean, period, exponent, error, settings)
        upward = run["crossing_velocity"][run["crossing_direction"] > 0]
        # Weakly attracting orbits of a long period, and those that hardly ever cross the section.
        closed = kind == MotionKind.QUASIPERIODIC and section_closed(upward, settings.period_tolerance)
        if closed or (kind in OPEN and len(upward) < REPETITIONS and _stops_repeat(run, settings)):
            kind = closed_kind(mean, settings)
    return MotionOfRun(kind, period, is_unstable(period, exponent, error, settings))
