"""The slope of a magnitude distribution by maximum likelihood, its error, and a test of the fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq
from scipy.stats import kstwo

from burridge_knopoff.values import real_array, real_number, refusal

#: Fewest events to which a slope is fitted.
FEWEST = 10


@dataclass(frozen=True)
class Slope:
    """The rate of events falls as exp(−b·magnitude) between two magnitudes; events of moment M then as M^(−1−b).

    b : the slope; error : its standard error, from the Fisher information
    low, high : range of the fit; count : events in it
    p_value : probability that a catalogue of this distribution differs from it by as much (Kolmogorov-Smirnov); the
        slope was fitted to the same events, so that a good fit is called good a little too often

    >>> from burridge_knopoff import fit_slope
    >>> fit = fit_slope([0.1, 0.2, 0.3, 0.4, 0.5, 0.7, 0.9, 1.2, 1.7, 3.0], 0.0)
    >>> round(fit.b, 2), round(fit.error, 2), fit.count
    (1.11, 0.35, 10)
    """

    b: float
    error: float
    low: float
    high: float
    count: int
    p_value: float


def fit_slope(magnitude: np.ndarray, low: float, high: float = math.inf) -> Slope:
    """Return the slope of the magnitudes in a range: that of an exponential distribution cut off at both ends.

    magnitude : of the events, shape (events,); low, high : ends of the range

    Raises ValueError for fewer than FEWEST events in the range, and if they are all of one magnitude.

    Reference: K. Aki, Bull. Earthq. Res. Inst. 43 (1965) 237; for two ends, R. Page, Bull. Seismol. Soc. Am. 58 (1968)
    1131.

    >>> import numpy as np
    >>> from burridge_knopoff import fit_slope
    >>> found = fit_slope(np.random.default_rng(1).exponential(1 / 0.8, 4000), 0.0)
    >>> round(found.b, 1), found.p_value > 0.05
    (0.8, True)
    """
    magnitude = real_array(magnitude, "magnitude")
    for key, value in (("low", low), ("high", high)):
        if math.isnan(real_number(value)):
            raise refusal(key, value, "a number")
    inside = np.sort(magnitude[(magnitude >= low) & (magnitude <= high)]) - low
    if len(inside) < FEWEST:
        raise ValueError(f"magnitude: got {len(inside)} events between {low:g} and {high:g}, expected {FEWEST} or more")
    mean, width = float(inside.mean()), high - low
    if inside[0] == inside[-1]:
        raise ValueError(f"magnitude: got only {inside[0] + low:g} between {low:g} and {high:g}, expected a spread")
    if math.isinf(width):
        b, information = 1.0 / mean, mean**2
    else:
        b = brentq(lambda b: _mean(b, width) - mean, -700.0 / width, 700.0 / width)
        information = _variance(b, width)
    error = 1.0 / math.sqrt(len(inside) * information)
    expected = _distribution(inside, b, width)
    rank = np.arange(len(inside) + 1) / len(inside)
    largest = max(float((rank[1:] - expected).max()), float((expected - rank[:-1]).max()))
    return Slope(b, error, low, high, len(inside), float(kstwo.sf(largest, len(inside))))


def _mean(b: float, width: float) -> float:
    """Return the mean of exp(−bm) on [0, width]."""
    if abs(b * width) < 1e-6:
        return width / 2 - b * width**2 / 12
    return 1.0 / b - width / math.expm1(b * width)


def _variance(b: float, width: float) -> float:
    """Return the variance of exp(−bm) on [0, width]."""
    if abs(b * width) < 1e-3:
        return width**2 / 12
    return 1.0 / b**2 - (width / (2.0 * math.sinh(b * width / 2.0))) ** 2


def _distribution(magnitude: np.ndarray, b: float, width: float) -> np.ndarray:
    """Return the share of events below magnitudes, shape (events,)."""
    if math.isinf(width):
        return -np.expm1(-b * magnitude)
    if abs(b * width) < 1e-9:
        return magnitude / width
    return np.expm1(-b * magnitude) / math.expm1(-b * width)
