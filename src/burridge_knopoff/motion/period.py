"""After which time the state of a run repeats, and after how many section points."""

from __future__ import annotations

import math
from collections.abc import Mapping

import numpy as np

from burridge_knopoff.motion.settings import MotionSettings

# A block hardly ever stops if its stops, and those of its mirror image, are less than this share of those of the blocks
# that stop the most: what is seen only then is not seen in every window.
SELDOM = 0.1

# A period counts if the section shows it at least this many times.
REPETITIONS = 3

# How much nearer the turns of a period are to each other than those of any shorter one.
BETTER = 0.1

# Turns diverge if their distance in the last of so many parts of a run is larger than in another part by this factor,
# and larger than this share of the tolerance.
PARTS = 8
DIVERGENCE = 2.0
ROUNDING = 1e-5

#: What a period is read from, by the names of point files.
SECTION = (
    *("crossing_velocity", "crossing_time", "crossing_direction"),
    *("event_time", "event_block", "event_kind", "event_position", "event_velocity"),
)


def period_of(run: Mapping[str, np.ndarray], settings: MotionSettings) -> tuple[int, float]:
    """Return after how many upward section points, and after which time, the state of all blocks repeats.

    run : arrays of a run named in SECTION, of its events at least the stops

    0 and NaN where it does not. Section points are counted up to the longest period of periodic motion; a longer period
    is known where the states at the stops repeat, and so is that of motion that hardly ever crosses the section.
    """
    points = section_period(run, settings)
    upward = run["crossing_time"][run["crossing_direction"] > 0]
    if points:
        return points, float(upward[-1] - upward[-1 - points])
    # Where the states of the last events alone are known, they do not show a period for long enough.
    late = len(upward) >= REPETITIONS and run["event_time"][:1] > upward[len(upward) // 2]
    stops = (run["event_kind"] == 0) & ~np.any(late)
    block = run["event_block"][stops].astype(int)
    if not len(block):
        return 0, math.nan
    stop_count = np.bincount(block, minlength=run["event_position"].shape[1] + 1)[1:]
    own = np.flatnonzero(stops)[block == section_blocks(stop_count)[0]]
    states = np.concatenate([run["event_position"][own], run["event_velocity"][own]], axis=1)
    length = orbit_length(states, settings.period_tolerance, len(states))
    time = run["event_time"][own]
    return 0, float(time[-1] - time[-1 - length]) if length < len(states) else math.nan


def has_diverging_cycles(run: Mapping[str, np.ndarray], points: int, settings: MotionSettings) -> bool:
    """Return whether successive turns of a run diverge: it is leaving a periodic orbit that repels.

    run, points : that repeats after so many section points

    Turns approach each other, down to rounding, if the orbit attracts. In weak chaos a run may pass so near a weakly
    repelling orbit that it repeats within the tolerance for the whole window.
    """
    velocity = run["crossing_velocity"][run["crossing_direction"] > 0]
    apart = np.abs(velocity[points:] - velocity[:-points])
    if len(apart) < PARTS * points:
        return False
    largest = [part.max() for part in np.array_split(apart, PARTS)]
    return bool(largest[-1] > max(ROUNDING * settings.period_tolerance, DIVERGENCE * min(largest)))


def section_period(run: Mapping[str, np.ndarray], settings: MotionSettings) -> int:
    """Return after how many upward section points the state of all blocks repeats; 0 if it does not.

    The second half of the section points is judged, or as much as shows a longer period, so that a slow approach does
    not hide a period.

    W is a sum over all blocks and cannot tell a state from its mirror image: on an orbit that is its own mirror image
    after half its period W' repeats twice in a period. So the states at the first event after each section point have
    to repeat as well. Where too few are known to show that, as in motion without events, W' alone is judged.
    """
    upward = run["crossing_direction"] > 0
    velocity, time = run["crossing_velocity"][upward], run["crossing_time"][upward]
    if not len(time):
        return 0
    longest = len(time) - 1 - int(np.searchsorted(time, time[-1] - settings.longest_period))
    period = repetition_length(velocity, settings.period_tolerance, longest)
    event_time = run["event_time"]
    if not period or not len(event_time):
        return period
    following = np.searchsorted(event_time, time[time >= event_time[0]], side="right")
    following = following[following < len(event_time)]
    states = np.concatenate([run["event_position"][following], run["event_velocity"][following]], axis=1)
    if len(states) < REPETITIONS * period:
        return period
    for multiple in range(period, min(longest, len(states) // REPETITIONS) + 1, period):
        if _misfit(states, multiple) <= settings.period_tolerance:
            return multiple
    return 0


def repetition_length(sequence: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many rows a sequence, shape (n,) or (n, m), repeats within tolerance; 0 if it does not.

    longest : largest period looked for; the sequence has to show it REPETITIONS times

    A sequence that still approaches its limit may seem to repeat after many rows, when it is as far from its limit as
    before: it has to repeat far better than after fewer rows.
    """
    least = np.inf
    for period in range(1, min(longest, len(sequence) // REPETITIONS) + 1):
        misfit = _misfit(sequence, period)
        if misfit <= min(tolerance, BETTER * least):
            return period
        least = min(misfit, least)
    return 0


def _misfit(sequence: np.ndarray, period: int) -> float:
    """Return how far turns are apart in the second half of a sequence, or in its last ones if that shows too few."""
    judged = max(len(sequence) - len(sequence) // 2, REPETITIONS * period) // period * period
    turns = sequence[len(sequence) - judged :].reshape(-1, period, *sequence.shape[1:])
    return float(np.ptp(turns, axis=0).max())


def section_blocks(stops: np.ndarray) -> tuple[int, int]:
    """Return the block, from 1 on, at whose stops a motion is seen, and that of its mirror image.

    stops : of each block, shape (blocks,)

    Of the pairs of mirror blocks that stop often the outermost one is taken, and of that the first block, or the one
    that stops if only one of them does. Shares of all stops decide, which do not depend on how long the motion is seen.
    """
    pairs = stops + stops[::-1]
    outer = int(np.argmax(pairs >= SELDOM * pairs.max()))
    inner = len(stops) - 1 - outer
    fewer, more = sorted((outer, inner), key=lambda one: (stops[one], -one))
    if stops[fewer] >= SELDOM * stops[more]:
        return outer + 1, outer + 1
    return more + 1, fewer + 1


def orbit_length(returns: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many returns a closed orbit repeats within the tolerance; `longest` if it takes more."""
    settled = returns[len(returns) // 3 :]
    before = settled[-min(longest, len(settled) // 2) : -1][::-1]
    for length in np.flatnonzero(np.abs(before - settled[-1]).max(axis=1) <= tolerance).tolist():
        if np.abs(settled[length + 1 :] - settled[: -length - 1]).max() <= tolerance:
            return length + 1
    return longest
