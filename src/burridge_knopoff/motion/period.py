"""The period of a run: the time, and the number of section points, after which its state repeats."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.motion.settings import MotionSettings

# A pair of mirror blocks stops rarely if its number of stops, divided by that of the pair with the most stops, is less
# than this: such stops do not occur in every window.
RARE_STOPS = 0.1

# A period must be observed at least this many times.
REPETITIONS = 3

# The distance between cycles of a period must be less than that of any shorter period by this factor.
IMPROVEMENT = 0.1

# States repeat with W' if they differ by at most this many times the tolerance of W': a motion that approaches its
# orbit may be farther from it in other directions.
STATE_TOLERANCE = 10.0

# Section points whose velocities W' differ by no more than this count as one point.
SAME_VELOCITY = 1e-6

# The distance between cycles in the last of PARTS parts of a run is compared with the smallest one. Distances below
# ROUNDING times the tolerance are rounding.
PARTS = 8
ROUNDING = 1e-5

#: The arrays from which a period is determined, by their names in point files.
SECTION = (
    *("crossing_velocity", "crossing_time", "crossing_direction"),
    *("event_time", "event_block", "event_kind", "event_position", "event_velocity"),
    *("trajectory_time", "position", "velocity"),
)


@dataclass(frozen=True)
class Repetition:
    """The repetition of the state of all blocks in a run.

    points, period : number of upward section points, and time, after which the state repeats; 0 and NaN if it does not.
        The number is determined up to `longest_period`. For longer periods, and for motion that rarely crosses the
        section, only the time is determined, from the states at the stops. The time is NaN, but not the number, if W'
        repeats after this many points and nothing recorded tells whether the state does, or only after twice as many
    divergence : factor by which the distance between successive cycles has grown. It is at most 1 if they approach each
        other down to rounding, as they do if the orbit attracts. In weak chaos a run may pass so close to a weakly
        unstable orbit that it repeats within the tolerance for the whole window
    """

    points: int = 0
    period: float = math.nan
    divergence: float = 0.0

    @property
    def is_observed(self) -> bool:
        """Whether the state repeats."""
        return self.points > 0 or math.isfinite(self.period)


def repetition_of(run: Mapping[str, np.ndarray], mean_distance: float, settings: MotionSettings) -> Repetition:
    """Return the repetition of the state in a run.

    run : arrays of a run named in SECTION; the events must include all stops
    mean_distance : ⟨J⟩; infinite if the chain is not its own mirror image
    """
    upward = run["crossing_direction"] > 0
    time, velocity = run["crossing_time"][upward], run["crossing_velocity"][upward]
    points, image = _section_repetition(run, settings)
    if points:
        divergence = _divergence(velocity[:, None], points, settings)
        # A synchronized state is its own mirror image.
        is_unknown = image is None and settings.synchronization_threshold <= mean_distance < math.inf
        longest_points = 2 * points if image or is_unknown else points
        period = float(time[-1] - time[-1 - longest_points])
        is_short = period <= settings.longest_period
        if is_unknown:
            return Repetition(points, math.nan, divergence if is_short else math.inf)
        return Repetition(longest_points if is_short else 0, period, divergence)
    # If states are known for the last events only, they do not cover a long enough time.
    late = len(time) >= REPETITIONS and run["event_time"][:1] > time[len(time) // 2]
    stops = (run["event_kind"] == 0) & ~np.any(late)
    block = run["event_block"][stops].astype(int)
    if not len(block):
        return Repetition()
    stop_count = np.bincount(block, minlength=run["event_position"].shape[1] + 1)[1:]
    section_stops = np.flatnonzero(stops)[block == section_blocks(stop_count)[0]]
    states = np.concatenate([run["event_position"][section_stops], run["event_velocity"][section_stops]], axis=1)
    length = orbit_length(states, settings.period_tolerance, len(states))
    if length == len(states):
        return Repetition()
    time = run["event_time"][section_stops]
    return Repetition(0, float(time[-1] - time[-1 - length]), _divergence(states, length, settings))


def _divergence(sequence: np.ndarray, length: int, settings: MotionSettings) -> float:
    """Return the `Repetition.divergence` of rows that repeat after `length` rows."""
    apart = np.abs(sequence[length:] - sequence[:-length]).max(axis=1)
    parts = min(PARTS, len(apart) // length)
    if parts < 2:
        return 0.0
    largest = np.array([part.max() for part in np.array_split(apart, parts)])
    return float(largest[-1] / max(largest.min(), ROUNDING * settings.period_tolerance))


def _section_repetition(run: Mapping[str, np.ndarray], settings: MotionSettings) -> tuple[int, bool | None]:
    """Return the number of upward section points after which W' and the states repeat, and whether as a mirror image.

    The number is 0 if they do not; the second value is None if no states are known that far apart. The second half of
    the section points is used, or more if the period is long, so that a slow approach does not hide a period.

    W is a sum over all blocks and does not distinguish a state from its mirror image: on an orbit that is its own
    mirror image after half its period, W' repeats twice in a period. The states at the first event after each section
    point must therefore repeat as well. Motion without such events is compared at the end of its trajectory.
    """
    upward = run["crossing_direction"] > 0
    velocity, time = run["crossing_velocity"][upward], run["crossing_time"][upward]
    if not len(time):
        return 0, None
    longest = len(time) - 1 - int(np.searchsorted(time, time[-1] - settings.longest_period))
    period = repetition_length(velocity, settings.period_tolerance, longest)
    if not period:
        return 0, None
    event_time = run["event_time"]
    following = np.searchsorted(event_time, time[time >= event_time[0]] if len(event_time) else time[:0], side="right")
    following = following[following < len(event_time)]
    states = np.stack([run["event_position"][following], run["event_velocity"][following]], axis=1)
    if len(states) <= period:
        return _trajectory_repetition(run, period, float(time[-1] - time[-1 - period]))
    for multiple in range(period, max(period, min(longest, len(states) // REPETITIONS)) + 1, period):
        for image in (False, True):
            if _misfit(states, multiple, image) <= STATE_TOLERANCE * settings.period_tolerance:
                return multiple, image
    return 0, None


def _trajectory_repetition(run: Mapping[str, np.ndarray], points: int, period: float) -> tuple[int, bool | None]:
    """Return what `_section_repetition` does, if W' repeats after a number of points, from the recorded trajectory."""
    time = run["trajectory_time"]
    is_later = time - period >= time[:1]
    if not is_later.any():
        return points, None
    states = np.concatenate([run["position"], run["velocity"]], axis=1)
    later = states[is_later]
    before = np.stack([np.interp(time[is_later] - period, time, column) for column in states.T], axis=1)
    mirrored = np.concatenate([half[:, ::-1] for half in np.split(before, 2, axis=1)], axis=1)
    apart = [float(np.abs(later - cycle).mean()) for cycle in (before, mirrored)]
    nearest, other = sorted(apart)
    if nearest > IMPROVEMENT * np.abs(later - later.mean(axis=0)).mean():
        return 0, None
    return points, apart[1] < apart[0] if nearest <= IMPROVEMENT * other else None


def repetition_length(sequence: np.ndarray, tolerance: float, longest: int) -> int:
    """Return the number of rows after which a sequence, shape (n,) or (n, m), repeats within tolerance, or 0.

    longest : largest period to be tested; the sequence must contain it REPETITIONS times

    A sequence that still approaches its limit may seem to repeat after many rows: its distance from the limit changes
    little. The repetition must therefore be much closer than after any smaller number of rows.
    """
    least = np.inf
    for period in range(1, min(longest, len(sequence) // REPETITIONS) + 1):
        misfit = _misfit(sequence, period)
        if misfit <= min(tolerance, IMPROVEMENT * least):
            return period
        least = min(misfit, least)
    return 0


def _misfit(sequence: np.ndarray, period: int, image: bool = False) -> float:
    """Return the distance between cycles in the second half of a sequence, or in its last REPETITIONS cycles.

    Of a shorter sequence, all of it is compared with what follows a cycle later.

    image : whether each cycle is compared with the mirror image of the next one, of rows of shape (2, blocks)
    """
    length = max(len(sequence) - len(sequence) // 2, REPETITIONS * period) // period * period
    if length > len(sequence):
        later = sequence[period:, :, ::-1] if image else sequence[period:]
        return float(np.abs(later - sequence[:-period]).max())
    cycles = sequence[len(sequence) - length :].reshape(-1, period, *sequence.shape[1:])
    if image:
        cycles = np.concatenate([cycles[::2], cycles[1::2, ..., ::-1]])
    return float(np.ptp(cycles, axis=0).max())


def count_distinct(velocity: np.ndarray) -> int:
    """Return how many section points W', shape (n,), differ by more than SAME_VELOCITY."""
    return int(np.count_nonzero(np.diff(np.sort(velocity)) > SAME_VELOCITY)) + 1 if len(velocity) else 0


def section_blocks(stops: np.ndarray) -> tuple[int, int]:
    """Return the block, from 1, whose stops define the section of a motion, and that of its mirror image.

    stops : number of stops of each block, shape (blocks,)

    The outermost pair of mirror blocks that does not stop rarely is used: its first block, or the block that stops if
    only one does. Only ratios of the numbers matter, so that the choice does not depend on the length of the run.
    """
    pairs = stops + stops[::-1]
    outer = int(np.argmax(pairs >= RARE_STOPS * pairs.max()))
    inner = len(stops) - 1 - outer
    rare, frequent = sorted((outer, inner), key=lambda k: (stops[k], -k))
    if stops[rare] >= RARE_STOPS * stops[frequent]:
        return outer + 1, outer + 1
    return frequent + 1, rare + 1


def orbit_length(returns: np.ndarray, tolerance: float, longest: int) -> int:
    """Return the number of returns after which a periodic orbit repeats within the tolerance, at most `longest`."""
    settled = returns[len(returns) // 3 :]
    before = settled[-min(longest, len(settled) // 2) : -1][::-1]
    for length in np.flatnonzero(np.abs(before - settled[-1]).max(axis=1) <= tolerance).tolist():
        if np.abs(settled[length + 1 :] - settled[: -length - 1]).max() <= tolerance:
            return length + 1
    return longest
