"""The slope of a magnitude distribution by maximum likelihood, its error, and a test of the fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.messages import refusal
from burridge_knopoff.values import real_array, real_number

#: Smallest number of events to which a slope is fitted.
MIN_EVENTS = 10
#: Number of random catalogues for p, which gives a standard error of 0.007 near p = 0.05.
BOOTSTRAP_SIZE = 999
#: Largest number of events in a random catalogue: in larger ones the distances have the same distribution except for a
#: factor.
MAX_BOOTSTRAP_EVENTS = 300
#: Smaller values of p are not distinguished.
SMALLEST_P = 0.005
# If the range is wider than this many times the distance of all events from one end, the other end counts as infinite.
INFINITE_RATIO = 1000.0
# Magnitudes and ends above SCALING_LIMIT are multiplied by SCALING, since their sums and differences would overflow.
SCALING_LIMIT, SCALING = 1e300, 2.0**-64


@dataclass(frozen=True)
class Slope:
    """The slope b: between two magnitudes the rate of events falls as exp(−b·magnitude), with the moment as M^(−1−b).

    b : the slope; error : its standard error, from the Fisher information
    low, high : range of the fit; count : number of events in this range
    p_value : probability that a catalogue of this distribution differs at least as much from its own fit
        (Kolmogorov-Smirnov distance), at least 1/1000; `format_p_value` formats it

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


def fit_slope(magnitude: ArrayLike, low: float, high: float = math.inf) -> Slope:
    """Fit an exponential distribution, truncated at both ends, to the magnitudes in a range.

    magnitude : of the events, shape (events,); low, high : ends of the range

    p comes from a parametric bootstrap: random catalogues of the fitted distribution are each compared with their own
    fit. Since the slope is fitted to the same events, the tables of the Kolmogorov-Smirnov distribution would be far
    too lenient (Lilliefors). If the range was chosen from the same events, p does not allow for this choice.

    Magnitudes are real numbers. If they were rounded to bins, the range should begin and end half a bin outside the
    first and the last centre (Utsu). b is then too low by a fraction of about w²/(12 s²), with w the width of the bins
    and s² the variance of the magnitudes in the range. If the range ends on the centres, b is too high by the fraction
    bw/2 or more. p is sensitive to the rounding as well.

    Raises ValueError for fewer than MIN_EVENTS events in the range, if all magnitudes are equal or too close to each
    other for b to be finite, if a magnitude in the range is infinite or any is NaN, if `low` is not
    finite, and if `high` is below `low`.

    References: K. Aki, Bull. Earthq. Res. Inst. 43 (1965) 237; for two ends, R. Page, Bull. Seismol. Soc. Am. 58 (1968)
    1131; H. W. Lilliefors, J. Am. Stat. Assoc. 62 (1967) 399 and 64 (1969) 387; for bins, T. Utsu, Geophys. Bull.
    Hokkaido Univ. 13 (1965) 99.

    >>> import numpy as np
    >>> from burridge_knopoff import fit_slope
    >>> found = fit_slope(np.random.default_rng(1).exponential(1 / 0.8, 4000), 0.0)
    >>> round(found.b, 1), found.p_value > 0.05
    (0.8, True)
    """
    magnitude = real_array(magnitude, "magnitude")
    if magnitude.ndim != 1:
        raise refusal("magnitude", magnitude.shape, "shape (events,)")
    if np.isnan(magnitude).any():
        raise refusal("magnitude", math.nan, "numbers")
    if not math.isfinite(real_number(low)):
        raise refusal("low", low, "a finite number")
    if not real_number(high) >= real_number(low):
        raise refusal("high", high, f"a number of at least low ({real_number(low):g})")
    low, high = float(low), float(high)
    inside = np.sort(magnitude[(magnitude >= low) & (magnitude <= high)])
    where = f"between {low:g} and {high:g}"
    if len(inside) < MIN_EVENTS:
        raise ValueError(f"magnitude: got {len(inside)} events {where}, expected {MIN_EVENTS} or more")
    if math.isinf(inside[-1]):
        raise ValueError(f"magnitude: got {inside[-1]:g} {where}, expected finite magnitudes")
    if inside[0] == inside[-1]:
        raise ValueError(f"magnitude: got only {inside[0]:g} {where}, expected a spread")
    distance, width, factor, rises = _distances(inside, low, high)
    # Measured from the end with more events, the slope is not negative.
    share = distance / width
    decay = _decay(share.mean(keepdims=True))
    b = factor * (float(decay[0]) / width)
    error = factor / (width * math.sqrt(len(share) * float(_variance(decay)[0])))
    if not (math.isfinite(b) and math.isfinite(error)):
        raise ValueError(f"magnitude: got differences up to {inside[-1] - inside[0]:g} {where}, expected larger ones")
    p_value = _p_value(float(_largest_difference(share[None], decay)[0]), float(decay[0]), len(share))
    return Slope(-b if rises else b, error, low, high, len(share), p_value)


def _distances(inside: np.ndarray, low: float, high: float) -> tuple[np.ndarray, float, float, bool]:
    """Return the distances of magnitudes from the end of their range near which most of them lie.

    inside : the magnitudes, in ascending order; low, high : ends of the range

    Returns the distances in ascending order and the width of the range, both in a unit of about the largest distance;
    the inverse of this unit, a power of 2, so that nothing is rounded; and whether the end is `high`.
    """
    width = high / INFINITE_RATIO - low / INFINITE_RATIO
    if width > float(inside[-1]) - low:
        high = math.inf
    elif width > high - float(inside[0]):
        low = -math.inf
    factor = 1.0
    if max(abs(value) for value in (low, high, *inside[[0, -1]].tolist()) if math.isfinite(value)) > SCALING_LIMIT:
        factor = SCALING
        inside, low, high = factor * inside, factor * low, factor * high
    mean = float(inside.mean())
    rises = math.isinf(low) or (math.isfinite(high) and mean - low > high - mean)
    distance = (high - inside)[::-1] if rises else inside - low
    largest = float(distance[-1])
    unit = math.ldexp(1.0, math.frexp(largest)[1] - 1)
    width = (high - low) / unit if math.isfinite(high - low) else INFINITE_RATIO * (largest / unit)
    return distance / unit, width, factor / unit, rises


def format_p_value(p: float) -> str:
    """Return `p = 0.12`, or `p < 0.005` for smaller values.

    >>> format_p_value(0.123), format_p_value(0.001)
    ('p = 0.12', 'p < 0.005')
    """
    return f"p < {SMALLEST_P:g}" if p < SMALLEST_P else f"p = {p:.2f}"


def _p_value(difference: float, decay: float, count: int) -> float:
    """Return the probability of at least this Kolmogorov-Smirnov distance in catalogues of the fitted distribution."""
    size = min(count, MAX_BOOTSTRAP_EVENTS)
    # Cumulative sums of exponential numbers, divided by their total, are uniform numbers in ascending order.
    sums = np.random.default_rng(count).standard_exponential((BOOTSTRAP_SIZE, size + 1)).cumsum(axis=1)
    uniform = sums[:, :-1] / sums[:, -1:]
    # A uniform distribution is the limit of a small decay.
    decay = max(decay, 1e-6)
    share = np.log1p(uniform * math.expm1(-decay)) / -decay
    drawn = _largest_difference(share, _decay(share.mean(axis=1)))
    # Dependence on the number of events: M. A. Stephens, J. Am. Stat. Assoc. 69 (1974) 730.
    difference *= (math.sqrt(count) + 0.26) / (math.sqrt(size) + 0.26)
    return (1 + int((drawn >= difference).sum())) / (BOOTSTRAP_SIZE + 1)


def _largest_difference(share: np.ndarray, decay: np.ndarray) -> np.ndarray:
    """Return the Kolmogorov-Smirnov distance of catalogues from exp(−decay·x) on [0, 1].

    share : x of the events in ascending order, shape (catalogues, events); decay : shape (catalogues,)

    Returns shape (catalogues,).
    """
    decay = np.where(np.abs(decay) < 1e-9, 1e-9, decay)[:, None]
    expected = np.expm1(-decay * share) / np.expm1(-decay)
    rank = np.arange(share.shape[1] + 1) / share.shape[1]
    return np.maximum((rank[1:] - expected).max(axis=1), (expected - rank[:-1]).max(axis=1))


def _decay(mean: np.ndarray) -> np.ndarray:
    """Return the decay for which exp(−decay·x) on [0, 1] has a given mean, shape (catalogues,).

    Newton's method starts from an approximation of the inverse Langevin function that is accurate to 5 %: A. Cohen,
    Rheol. Acta 30 (1991) 270.
    """
    small = np.minimum(mean, 1.0 - mean)
    y = 1.0 - 2.0 * small
    decay = y * (3.0 - y * y) / (2.0 * small * (1.0 - small))
    for _ in range(5):
        decay = np.maximum(decay + (_mean(decay) - small) / _variance(decay), 0.0)
    return np.where(mean <= 0.5, decay, -decay)


def _mean(decay: np.ndarray) -> np.ndarray:
    """Return the mean of exp(−decay·x) on [0, 1] for decays of 0 and above."""
    near, far = decay, np.maximum(decay, 0.01)
    series = 0.5 - near / 12.0 + near**3 / 720.0 - near**5 / 30240.0
    return np.where(decay < 0.01, series, 1.0 / far + np.exp(-far) / np.expm1(-far))


def _variance(decay: np.ndarray) -> np.ndarray:
    """Return the variance of exp(−decay·x) on [0, 1] for decays of 0 and above."""
    far = np.maximum(decay, 0.01)
    series = 1.0 / 12.0 - decay**2 / 240.0 + decay**4 / 6048.0
    return np.where(decay < 0.01, series, 1.0 / far**2 - np.exp(-far) / np.expm1(-far) ** 2)
