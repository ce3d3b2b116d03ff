"""The kind of motion that a run ended in, from its Lyapunov exponents and its section points."""

from __future__ import annotations

from enum import IntEnum

import numpy as np

from burridge_knopoff.stability.settings import MotionSettings


class MotionKind(IntEnum):
    """Kinds of motion, numbered as in netCDF files; SYNCHRONIZED is periodic, with end blocks that move as one."""

    UNDETERMINED = -1
    SYNCHRONIZED = 0
    PERIODIC = 1
    QUASIPERIODIC = 2
    CHAOTIC = 3


# Largest error of an exponent, in units of `chaotic_exponent`, with which exponents decide the kind.
LARGEST_ERROR = 3.0

# A period counts if the sequence shows it at least this many times.
REPETITIONS = 3


def section_period(section: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many points a sequence of section points W' repeats within tolerance; 0 if it does not.

    section : shape (n,); its second half is judged, so that a slow approach does not hide a period
    longest : largest period looked for
    """
    settled = section[len(section) // 2 :]
    for period in range(1, min(longest, len(settled) // REPETITIONS) + 1):
        turns = settled[: len(settled) // period * period].reshape(-1, period)
        if np.ptp(turns, axis=0).max() <= tolerance:
            return period
    return 0


def section_closed(section: np.ndarray, tolerance: float) -> bool:
    """Tell whether section points W' repeat, however long the period: almost all have another within the tolerance.

    section : shape (n,); its second half is judged
    """
    settled = np.sort(section[len(section) // 2 :])
    if len(settled) < 4 * REPETITIONS:
        return False
    gap = np.diff(settled)
    nearest = np.minimum(np.concatenate([[np.inf], gap]), np.concatenate([gap, [np.inf]]))
    return bool(np.quantile(nearest, 0.95) <= tolerance)


def zero_exponents(exponent: np.ndarray, error: np.ndarray, settings: MotionSettings) -> np.ndarray:
    """Return which exponents, of these standard errors, cannot be distinguished from 0; all of shape (n,)."""
    return np.abs(exponent) <= np.maximum(settings.zero_exponent, settings.standard_errors * error)


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

    Chaotic if the largest exponent is above `chaotic_exponent` and above its error. Otherwise the largest must be 0,
    that of the flow; then the motion is periodic if the section points repeat or the next exponent is negative, and
    quasiperiodic if that one is 0 as well and the errors are small. Everything else is undetermined, even a largest
    exponent above `chaotic_exponent` if it is within its error.
    """
    known = np.flatnonzero(~np.isnan(exponent))
    if len(known) and exponent[0] > max(settings.chaotic_exponent, settings.standard_errors * error[0]):
        return MotionKind.CHAOTIC
    zero = zero_exponents(exponent, error, settings)
    if len(known) and not zero[0]:
        return MotionKind.UNDETERMINED
    if period:
        return closed_kind(mean_distance, settings)
    # Errors beyond the threshold of chaos, as where chaos ends within the window, leave the kind open.
    if len(known) and settings.standard_errors * np.nanmax(error[:2]) > LARGEST_ERROR * settings.chaotic_exponent:
        return MotionKind.UNDETERMINED
    if len(known) > 1 and not zero[1]:
        return closed_kind(mean_distance, settings)
    return (
        MotionKind.QUASIPERIODIC
        if len(known) > 1 and exponent[0] <= settings.chaotic_exponent
        else MotionKind.UNDETERMINED
    )
