"""The frequency of each block: that of the strongest line in the spectrum of its velocity, or the rate of its slips.

On a torus the strongest line of a block is that of one mode. A block that moves in short slips has a spectrum of many
lines of nearly one height; which of them is the highest means nothing, and its frequency is the rate of its slips.

Blocks that are locked to each other have frequencies in a ratio of whole numbers, and keep this ratio when their
masses, springs or thresholds are made different. So do blocks that move in a single mode, see `motion.modes`.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from scipy.fft import next_fast_len, rfft

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner, check_state
from burridge_knopoff.running.settings import LONGEST
from burridge_knopoff.running.status import early_end
from burridge_knopoff.values import MOST_NUMBERS, instance_of, read_only_copy

# The spectrum is sampled more finely than its resolution by this factor, so that a parabola fits the top of a peak.
PADDING = 8

# Sampling interval of a velocity, in units of the interval that resolves the motion: the spectrum then extends to six
# times the frequency of the fastest mode.
SPACING = 2.0

# Relative rounding of velocities and of rates of starts. A velocity that varies by less is constant.
ROUNDING = 1e-10

# A block moves in short slips if it is faster than its mean velocity for a smaller fraction of the time. With one slip
# of the shape 1 − cos in each period, the second line is then more than 0.7 times as high as the first.
SHORT_SLIPS = 0.25

# After a slip a block that never stops is slower than this fraction of the way from the median of its velocity, that
# between short slips, to the mean. If it stays faster, a neighbour pushes it on in the same slip.
SLIP_END = 0.25

# The fewest cycles that have a frequency, and the number of parts of the time that are compared.
LEAST_CYCLES = 2
PARTS = 4

# A frequency with a larger relative error is unknown.
LARGEST_ERROR = 0.25


def block_frequencies(model: Model, state: ChainState, duration: float = 4000.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the frequency of each block of a motion, and its error, in cycles per unit time, each of shape (blocks,).

    model, state : a state of settled motion, such as `Trajectory.final` or `PeriodicOrbit.reference`
    duration : time of observation, in units of 1/ω

    The frequency is that of the strongest line in the spectrum of U', refined by the phases of this line in the two
    halves of the time. If a block is faster than on average for less than a quarter of the time, as in a relaxation
    oscillation, its frequency is the rate of its slips: of its starts, at the times of the events, or if it never
    stops, of the rises of U' through the mean, each after a fall of U' nearly to its median. The error is the largest
    deviation in four successive parts of the time, for rises through the mean with the sampling interval added; the
    true error is smaller, on a periodic orbit or a torus by orders of magnitude.

    Both are NaN for a block whose velocity is constant, and for a block that is not observed to complete two cycles:
    because the driver moves by less than twice the range of its position, because it slips fewer than three times,
    because the spectrum is higher at a lower frequency, or because the error exceeds a quarter of the frequency.

    Raises ValueError, one line, for a duration or a state that is not allowed.

    Sources: J. Laskar, Physica D 67 (1993) 257 (fundamental frequencies of quasiperiodic motion); S. Das, Y. Saiki, E.
    Sander and J. A. Yorke, Nonlinearity 30 (2017) 4111 (weighted averages, here of the times between slips).

    >>> from burridge_knopoff import Model, block_frequencies, simulate
    >>> model = Model("linearized", a=0.06).at(**{"mass[3]": 1.1})
    >>> run = simulate(model, initial="plus", transient=0, window=4000)
    >>> frequency, error = block_frequencies(model, run.final)
    >>> [round(value, 6) for value in frequency.tolist()]
    [0.217964, 0.342515, 0.217964]
    >>> bool(abs(frequency[2] / frequency[0] - 1.0) < 1e-8)
    True
    """
    instance_of(model, Model, "model")
    return sampled_motion(model, state, duration).frequencies()


@dataclass(frozen=True, eq=False)
class SampledMotion:
    """A motion at an even number of equal time steps.

    begin : state at time 0
    time : from 0 to the duration, shape (n + 1,); position, velocity : x and U' there, shape (n + 1, blocks) each
    """

    model: Model
    begin: ChainState
    time: np.ndarray
    position: np.ndarray
    velocity: np.ndarray

    def frequencies(self) -> tuple[np.ndarray, np.ndarray]:
        """Return frequency and error of each block, see `block_frequencies`."""
        repeated = LEAST_CYCLES * np.ptp(self.position, axis=0) <= self.model.v * self.time[-1]
        starts: list[np.ndarray | None] = [None] * self.model.blocks
        if any(has_short_slips(values) for values in self.velocity.T):
            starts = slip_starts(self.model, self.begin, self.time)
        per_sample = np.array([_frequency(*block) for block in zip(self.velocity.T, starts, strict=True)])
        frequency, error = np.where(repeated, per_sample.T / self.time[1], math.nan)
        return frequency, error


def sampled_motion(model: Model, state: ChainState, duration: float) -> SampledMotion:
    """Return the motion from a state.

    Raises ValueError, one line, for a duration or a state that is not allowed, and if the run does not complete.
    """
    duration = Number(0.0, LONGEST, above=True).form(duration, "duration")
    check_state(model, state)
    count = 2 * math.ceil(0.5 * duration / (SPACING * longest_spacing(model.chain)))
    if 2 * count * model.blocks > MOST_NUMBERS:
        raise refusal("duration", duration, f"a shorter one: {model.blocks} blocks are stored at {count} times")
    time = np.linspace(0.0, duration, count + 1)
    start = (state.position[None], state.velocity[None], state.stuck[None].astype(bool))
    motion = new_ensemble(model).run(*start, time.tolist())
    if ended := early_end(motion["status"].item(), motion["end"].item()):
        raise refusal("duration", duration, f"a shorter one: {ended}")
    return SampledMotion(model, state, time, motion["position"][0], motion["velocity"][0])


def slip_starts(model: Model, state: ChainState, time: np.ndarray) -> list[np.ndarray | None]:
    """Return the starts of each block during equidistant times, in samples; None for a block that never stops."""
    runner = Runner(model, events_from=math.inf, keep_events=True)
    runner.begin(state, 0.0)
    runner.run(time[-1])
    log = runner.log.earlier_events
    block, kind = log.values().T
    return starts_of_blocks(log.times() / time[1], block, kind, model.blocks)


def starts_of_blocks(time: np.ndarray, block: np.ndarray, kind: np.ndarray, blocks: int) -> list[np.ndarray | None]:
    """Return the times of the starts of each block among events, None for a block that never stops.

    time, block, kind : of the events in their order; block from 1 on, kind 0 stop | 1 start
    """
    of_blocks = [block == 1 + n for n in range(blocks)]
    return [time[events & (kind == 1)] if (kind[events] == 0).any() else None for events in of_blocks]


def _frequency(values: np.ndarray, starts: np.ndarray | None) -> tuple[float, float]:
    """Return the frequency in cycles per sample and its error, from samples and starts; NaN without two full cycles."""
    if is_constant(values):
        return math.nan, math.nan
    slips = has_short_slips(values)
    whole = np.diff(slip_times(values) if starts is None else starts) if slips else values
    frequency = _line_frequency(whole) if not slips else mean_rate(whole) if len(whole) else math.nan
    cycles = len(whole) if slips else int(np.nan_to_num(frequency) * len(values))
    if cycles < LEAST_CYCLES:
        return math.nan, math.nan
    # Each part has two cycles if the whole has four.
    parts = np.array_split(whole, min(max(cycles // 2, 2), PARTS))
    of_parts = [mean_rate(part) if slips else _line_frequency(part) for part in parts]
    error = float(np.abs(np.subtract(of_parts, frequency)).max())
    if slips:
        error += frequency * (1.0 / len(values) if starts is None else ROUNDING)
    return (frequency, error) if error <= LARGEST_ERROR * frequency else (math.nan, math.nan)


def leading_frequency(values: np.ndarray, duration: float, starts: np.ndarray | None = None) -> float:
    """Return the frequency of the highest peak of the spectrum of equidistant samples of U' that last for `duration`.

    The mean is taken off, a Hann window put on, and the peak's place is that of the parabola through the logarithms of
    the power around it. A frequency above half the rate of the samples has its image below it.

    Of short slips it is their rate, that of the starts of the block in this duration, between which sticks of any
    length count. `starts` is None for a block that never stops: its slips are told apart by samples, see `slip_times`.

    NaN if the values are constant, if no peak has a full cycle within the duration, and for fewer than three short
    slips.
    """
    if is_constant(values) or len(values) < 4:
        return math.nan
    if has_short_slips(values):
        times = slip_times(values) * (duration / (len(values) - 1)) if starts is None else starts
        return mean_rate(np.diff(times)) if len(times) > LEAST_CYCLES else math.nan
    return _highest_peak(values, duration)[0]


def _highest_peak(values: np.ndarray, duration: float) -> tuple[float, bool]:
    """Return the frequency of the highest peak of the spectrum, and whether the spectrum is nowhere higher."""
    length = next_fast_len(PADDING * len(values), real=True)
    step = (len(values) - 1) / (duration * length)
    # A periodogram without its scale, which would take twice as long. Both ends have no image at negative frequencies.
    power = np.abs(rfft(_hann_window(len(values)) * (values - values.mean()), length)) ** 2
    power[[0, -1] if length % 2 == 0 else [0]] *= 0.5
    peaks = 1 + np.flatnonzero((power[1:-1] > power[:-2]) & (power[1:-1] >= power[2:]))
    peaks = peaks[peaks * step * duration >= 1.0]
    if not len(peaks):
        return math.nan, False
    top = peaks[np.argmax(power[peaks])]
    left, middle, right = (math.log(power[k]) for k in (top - 1, top, top + 1))
    offset = 0.5 * (left - right) / (left - 2.0 * middle + right)
    return float(step * (top + offset)), bool(power[top] == power.max())


@lru_cache(maxsize=8)
def _hann_window(count: int) -> np.ndarray:
    """Return the periodic Hann window, shape (count,); that of `scipy.signal` takes a second to import."""
    return read_only_copy(0.5 + 0.5 * np.cos(np.linspace(-np.pi, np.pi, count + 1)[:-1]))


def has_short_slips(values: np.ndarray) -> bool:
    """Return whether a velocity exceeds its mean for so little of the time that its spectrum is a comb."""
    return bool((values > values.mean()).mean() < SHORT_SLIPS)


def slip_times(values: np.ndarray) -> np.ndarray:
    """Return the times, in samples, at which a velocity rises through its mean, in each slip for the first time.

    A slip ends where the block rests in a sample, or if it never does, where the velocity falls nearly to its median.
    Of a block that stops, the starts among the events are the better answer: samples miss shorter sticks.
    """
    above = values - values.mean()
    rests = values == 0.0
    ends = np.cumsum(rests if rests.any() else above < (1.0 - SLIP_END) * np.median(above))
    before = np.flatnonzero((above[:-1] <= 0.0) & (above[1:] > 0.0))
    before = before[np.diff(ends[before], prepend=0) > 0]
    return before + above[before] / (above[before] - above[before + 1])


def mean_rate(cycles: np.ndarray) -> float:
    """Return the mean rate of successive cycles of given durations; more accurate than their number on a torus."""
    weight = smooth_weight(len(cycles))
    return float(weight.sum() / (weight @ cycles))


def smooth_weight(count: int) -> np.ndarray:
    """Return weights of equidistant samples with which averages over quasiperiodic motion converge fastest."""
    place = (np.arange(count) + 0.5) / count
    return np.exp(-1.0 / (place * (1.0 - place)))


def _line_frequency(values: np.ndarray) -> float:
    """Return the frequency of the strongest line in cycles per sample, refined by its phases; NaN if it is too low."""
    if is_constant(values) or len(values) < 4:
        return math.nan
    frequency, is_strongest = _highest_peak(values, len(values) - 1.0)
    return frequency + _frequency_offset(values, frequency) if is_strongest else math.nan


def _frequency_offset(values: np.ndarray, frequency: float) -> float:
    """Return the offset of a line from a frequency, in cycles per sample, from its phases in the two halves.

    The weight suppresses other lines faster than any power of the number of samples.
    """
    if math.isnan(frequency):
        return math.nan
    half = len(values) // 2
    line = smooth_weight(half) * np.exp(-2j * math.pi * frequency * np.arange(half))
    first, second = (line @ (values[start : start + half] - values.mean()) for start in (0, half))
    advance = np.angle(second / first * np.exp(-2j * math.pi * frequency * half))
    return float(advance) / (2.0 * math.pi * half)


def is_constant(values: np.ndarray) -> bool:
    """Return whether values are equal up to rounding."""
    return bool(np.ptp(values) <= ROUNDING * np.abs(values).max())
