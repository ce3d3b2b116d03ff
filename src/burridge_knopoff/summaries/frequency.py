"""The leading frequency of a velocity."""

from __future__ import annotations

import math

import numpy as np
from scipy.signal import find_peaks, periodogram

from burridge_knopoff.summaries.correlation import is_constant

# The spectrum is sampled this many times finer than its resolution, so that a parabola fits the top of a peak.
PADDING = 8


def leading_frequency(values: np.ndarray, duration: float) -> float:
    """Return the frequency of the highest peak of the spectrum of equidistant samples that last for `duration`.

    The mean is taken off, a Hann window put on, and the peak's place is that of the parabola through the logarithms of
    the power around it. NaN if the values are constant, or no peak has a full cycle within the duration.
    """
    if is_constant(values) or len(values) < 4:
        return math.nan
    interval = duration / (len(values) - 1)
    length = PADDING * len(values)
    frequency, power = periodogram(values, 1.0 / interval, window="hann", nfft=length, detrend="constant")
    peaks = find_peaks(power)[0]
    peaks = peaks[frequency[peaks] * duration >= 1.0]
    if not len(peaks):
        return math.nan
    top = peaks[np.argmax(power[peaks])]
    left, middle, right = (math.log(power[k]) for k in (top - 1, top, top + 1))
    return float(frequency[top] + 0.5 * (left - right) / (left - 2.0 * middle + right) * frequency[1])
