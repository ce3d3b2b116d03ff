"""The frequency of each block: that of the strongest line in the spectrum of its velocity.

Blocks that are locked to each other have frequencies in a ratio of whole numbers, and keep this ratio when their
masses, springs or thresholds are made different. On a torus the strongest line of a block is that of one mode.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.fft import next_fast_len
from scipy.signal import find_peaks, periodogram

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import check_state
from burridge_knopoff.running.settings import LONGEST
from burridge_knopoff.values import MOST_NUMBERS, instance_of, refusal

# The spectrum is sampled more finely than its resolution by this factor, so that a parabola fits the top of a peak.
PADDING = 8

# Sampling interval of a velocity, in units of the interval that resolves the motion: the spectrum then extends to six
# times the frequency of the fastest mode.
SPACING = 2.0

# A velocity whose relative variation is at most this is constant: the variation is rounding.
ROUNDING = 1e-10


def block_frequencies(model: Model, state: ChainState, duration: float = 4000.0) -> tuple[np.ndarray, np.ndarray]:
    """Return the frequency of each block of a motion, and its error, in cycles per unit time, each of shape (blocks,).

    model, state : a state of settled motion, such as `Trajectory.final` or `PeriodicOrbit.reference`
    duration : time of observation, in units of 1/ω

    The frequency is that of the strongest line in the spectrum of U', refined by the phases of this line in the two
    halves of the time. It is NaN for a block whose velocity is constant. The error is the difference between the
    frequencies in the two halves; the true error is smaller, on a periodic orbit or a torus by orders of magnitude.

    Raises ValueError, one line, for a duration or a state that is not allowed.

    Source: J. Laskar, Physica D 67 (1993) 257 (fundamental frequencies of quasiperiodic motion).

    >>> from burridge_knopoff import Chain, Model, block_frequencies, law_of, simulate
    >>> model = Model(Chain(3), law_of("linearized", 0.06)).at(**{"mass[3]": 1.1})
    >>> run = simulate(model, initial="plus", transient=0, window=4000)
    >>> frequency, error = block_frequencies(model, run.final)
    >>> [round(value, 6) for value in frequency.tolist()]
    [0.217964, 0.342515, 0.217964]
    >>> bool(abs(frequency[2] / frequency[0] - 1.0) < 1e-8)
    True
    """
    instance_of(model, Model, "model")
    duration = Number(0.0, LONGEST, above=True).form(duration, "duration")
    check_state(model, state)
    count = 2 * math.ceil(0.5 * duration / (SPACING * longest_spacing(model.chain)))
    if 2 * count * model.blocks > MOST_NUMBERS:
        raise refusal("duration", duration, f"a shorter one: {model.blocks} blocks are stored at {count} times")
    start = (state.position[None], state.velocity[None], state.stuck[None].astype(bool))
    velocity = new_ensemble(model).run(*start, np.linspace(0.0, duration, count + 1).tolist())["velocity"][0]
    first = np.array([leading_frequency(one, duration) for one in velocity.T])
    interval = duration / count
    whole, *halves = (
        np.array([_frequency_offset(one, found * interval) for one, found in zip(part.T, first, strict=True)])
        / interval
        for part in (velocity, velocity[: count // 2], velocity[count // 2 :])
    )
    return first + whole, np.abs(halves[0] - halves[1])


def leading_frequency(values: np.ndarray, duration: float) -> float:
    """Return the frequency of the highest peak of the spectrum of equidistant samples that last for `duration`.

    The mean is taken off, a Hann window put on, and the peak's place is that of the parabola through the logarithms of
    the power around it. NaN if the values are constant, or no peak has a full cycle within the duration.
    """
    if is_constant(values) or len(values) < 4:
        return math.nan
    interval = duration / (len(values) - 1)
    length = next_fast_len(PADDING * len(values), real=True)
    frequency, power = periodogram(values, 1.0 / interval, window="hann", nfft=length, detrend="constant")
    peaks = find_peaks(power)[0]
    peaks = peaks[frequency[peaks] * duration >= 1.0]
    if not len(peaks):
        return math.nan
    top = peaks[np.argmax(power[peaks])]
    left, middle, right = (math.log(power[k]) for k in (top - 1, top, top + 1))
    return float(frequency[top] + 0.5 * (left - right) / (left - 2.0 * middle + right) * frequency[1])


def _frequency_offset(values: np.ndarray, frequency: float) -> float:
    """Return the offset of a line from a frequency, in cycles per sample, from its phases in the two halves.

    The weight suppresses other lines faster than any power of the number of samples.
    """
    if math.isnan(frequency):
        return math.nan
    half = len(values) // 2
    place = (np.arange(half) + 0.5) / half
    line = np.exp(-1.0 / (place * (1.0 - place)) - 2j * math.pi * frequency * np.arange(half))
    first, second = (line @ (values[start : start + half] - values.mean()) for start in (0, half))
    advance = np.angle(second / first * np.exp(-2j * math.pi * frequency * half))
    return float(advance) / (2.0 * math.pi * half)


def is_constant(values: np.ndarray) -> bool:
    """Return whether values are equal up to rounding."""
    return bool(np.ptp(values) <= ROUNDING * np.abs(values).max())
