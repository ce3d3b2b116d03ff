"""The slope of a magnitude distribution by maximum likelihood, its error, and a test of the fit."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.catalogue.batches import batch_index, batch_sums, ratio_error
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
# The slopes in the two halves of a range differ if their difference is above this many standard errors.
STANDARD_ERRORS = 2.0
# If the range is wider than this many times the distance of all events from one end, the other end counts as infinite.
INFINITE_RATIO = 1000.0
# Magnitudes and ends above SCALING_LIMIT are multiplied by SCALING, since their sums and differences would overflow.
SCALING_LIMIT, SCALING = 1e300, 2.0**-64


@dataclass(frozen=True)
class Slope:
    """The slope b: between two magnitudes the rate of events falls as exp(−b·magnitude), with the moment as M^(−1−b).

    b : the slope; error : its error, √(scatter² + spread²)
    low, high : range of the fit; count : number of events in this range
    p_value : probability that a catalogue of this distribution differs at least as much from its own fit
        (Kolmogorov-Smirnov distance), at least 1/1000; `format_p_value` formats it
    scatter : standard error of b in this range: the scatter of independent catalogues
    spread : how far the slope in the lower or the upper half of the range differs from b; 0 if the two slopes differ by
        less than two standard errors, as they do if the rate falls exponentially, or if a half has too few events

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
    scatter: float
    spread: float


def fit_slope(magnitude: ArrayLike, low: float, high: float = math.inf, *, time: ArrayLike | None = None) -> Slope:
    """Fit an exponential distribution, truncated at both ends, to the magnitudes in a range.

    magnitude : of the events, shape (events,); low, high : ends of the range
    time : of the events, in any order. The scatter of b and p then allow for events that depend on each other, as
        those of a chain do, by the scatter of parts of the catalogue (`catalogue.batches`); the scatter is NaN if
        nearly all events in the range lie in a few of these parts. Without times events count as independent, and the
        scatter follows from the Fisher information

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
    if magnitude.ndim != 1 or np.isnan(magnitude).any():
        raise refusal("magnitude", magnitude, "numbers of shape (events,)")
    if not math.isfinite(real_number(low)):
        raise refusal("low", low, "a finite number")
    if not real_number(high) >= real_number(low):
        raise refusal("high", high, f"a number of at least low ({real_number(low):g})")
    low, high = float(low), float(high)
    inside, batch = _events_inside(magnitude, time, low, high)
    where = f"between {low:g} and {high:g}"
    if len(inside) < MIN_EVENTS:
        raise ValueError(f"magnitude: got {len(inside)} events {where}, expected {MIN_EVENTS} or more")
    fit = _fit(inside, batch, low, high) if inside[0] < inside[-1] < math.inf else None
    if not (fit and math.isfinite(fit.b) and math.isfinite(fit.error)):
        got = f"{inside[0]:g} to {inside[-1]:g} {where}"
        raise ValueError(f"magnitude: got {got}, expected finite numbers that differ enough for a finite slope")
    difference = float(_largest_difference(fit.share[None], fit.decay)[0])
    p_value = _p_value(difference, float(fit.decay[0]), len(inside), _independent_events(fit))
    spread = _spread(fit, inside, batch, low, high)
    return Slope(fit.b, math.hypot(fit.scatter, spread), low, high, len(inside), p_value, fit.scatter, spread)


def _events_inside(
    magnitude: np.ndarray, time: ArrayLike | None, low: float, high: float
) -> tuple[np.ndarray, np.ndarray | None]:
    """Return the magnitudes in a range, in ascending order, and the batch of each event; None without times."""
    chosen = (magnitude >= low) & (magnitude <= high)
    if time is None:
        return np.sort(magnitude[chosen]), None
    time = real_array(time, "time")
    if time.shape != magnitude.shape or not np.isfinite(time).all():
        raise refusal("time", time, f"finite numbers of shape {magnitude.shape}, that of the magnitudes")
    inside = magnitude[chosen]
    order = np.argsort(inside, kind="stable")
    return inside[order], batch_index(time, time.min(), time.max())[chosen][order] if len(order) else None


@dataclass(frozen=True)
class _Fit:
    """A slope b with its errors: from the Fisher information, and of independent catalogues.

    share : distances of the events from one end of the range, over its width, in ascending order
    decay : for which exp(−decay·share) fits them, shape (1,)
    rises : whether that end is the upper one
    batch : of these events, None without times
    """

    b: float
    error: float
    scatter: float
    share: np.ndarray
    decay: np.ndarray
    rises: bool
    batch: np.ndarray | None


def _fit(inside: np.ndarray, batch: np.ndarray | None, low: float, high: float) -> _Fit:
    """Fit magnitudes of a range, in ascending order; b or its error may be infinite.

    A. C. Davison, Statistical Models (2003), section 4.6: a slope reacts to the sum of the shares of its events by the
    inverse of their variance, whatever their distribution and dependence.
    """
    distance, width, factor, rises = _distances(inside, low, high)
    # Measured from the end with more events, the slope is not negative.
    share = distance / width
    decay = _decay(share.mean(keepdims=True))
    b = factor * (float(decay[0]) / width)
    variance = float(_variance(decay)[0])
    error = scatter = factor / (width * math.sqrt(len(share) * variance))
    if batch is not None:
        batch = batch[::-1] if rises else batch
        scatter *= float(ratio_error(batch_sums(batch, share), batch_sums(batch))[0]) / math.sqrt(variance / len(share))
    return _Fit(-b if rises else b, error, scatter, share, decay, rises, batch)


def _independent_events(fit: _Fit) -> float:
    """Return the number of independent events whose distribution differs as much from its fit as that of the events.

    It follows from the error of the share of events below the largest difference, apart from what the slope explains.
    """
    count = len(fit.share)
    if fit.batch is None:
        return count
    at = int(np.abs((np.arange(count) + 0.5) / count - _distribution(fit.share, fit.decay)).argmax())
    below, share = (values - values.mean() for values in (fit.share <= fit.share[at], fit.share))
    below -= share * (np.sum(below * share) / np.sum(share**2))
    error = float(ratio_error(batch_sums(fit.batch, below), batch_sums(fit.batch))[0])
    square = float(below.var(ddof=1)) / count
    return count * square / error**2 if error**2 > square else count


def _spread(fit: _Fit, inside: np.ndarray, batch: np.ndarray | None, low: float, high: float) -> float:
    """Return how far the slopes of the two halves of a range differ from that of the whole; 0 if by chance."""
    before = int(np.searchsorted(inside, 0.5 * float(inside[0]) + 0.5 * float(inside[-1])))
    if min(before, len(inside) - before) < MIN_EVENTS:
        return 0.0
    # Between two events, so that rounded magnitudes keep half a bin on either side.
    middle = 0.5 * float(inside[before - 1]) + 0.5 * float(inside[before])
    halves = []
    for half, start, end in ((slice(before), low, middle), (slice(before, None), middle, high)):
        if inside[half][0] == inside[half][-1]:
            return 0.0
        halves.append(_fit(inside[half], None if batch is None else batch[half], start, end))
    lower, upper = halves
    if not abs(upper.b - lower.b) > STANDARD_ERRORS * math.hypot(lower.scatter, upper.scatter):
        return 0.0
    return max(abs(half.b - fit.b) for half in halves)


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


def _p_value(difference: float, decay: float, count: int, independent: float) -> float:
    """Return the probability of at least this Kolmogorov-Smirnov distance in catalogues of the fitted distribution.

    count : number of events; independent : number of independent events that scatter as much
    """
    size = min(count, MAX_BOOTSTRAP_EVENTS)
    # Cumulative sums of exponential numbers, divided by their total, are uniform numbers in ascending order.
    sums = np.random.default_rng(count).standard_exponential((BOOTSTRAP_SIZE, size + 1)).cumsum(axis=1)
    uniform = sums[:, :-1] / sums[:, -1:]
    # A uniform distribution is the limit of a small decay.
    decay = max(decay, 1e-6)
    share = np.log1p(uniform * math.expm1(-decay)) / -decay
    drawn = _largest_difference(share, _decay(share.mean(axis=1)))
    # Dependence on the number of events: M. A. Stephens, J. Am. Stat. Assoc. 69 (1974) 730.
    difference *= (math.sqrt(independent) + 0.26) / (math.sqrt(size) + 0.26)
    return (1 + int((drawn >= difference).sum())) / (BOOTSTRAP_SIZE + 1)


def _largest_difference(share: np.ndarray, decay: np.ndarray) -> np.ndarray:
    """Return the Kolmogorov-Smirnov distance of catalogues from exp(−decay·x) on [0, 1].

    share : x of the events in ascending order, shape (catalogues, events); decay : shape (catalogues,)

    Returns shape (catalogues,).
    """
    expected = _distribution(share, decay[:, None])
    rank = np.arange(share.shape[1] + 1) / share.shape[1]
    return np.maximum((rank[1:] - expected).max(axis=1), (expected - rank[:-1]).max(axis=1))


def _distribution(share: np.ndarray, decay: np.ndarray) -> np.ndarray:
    """Return the fraction of exp(−decay·x) on [0, 1] that lies below x = share."""
    decay = np.where(np.abs(decay) < 1e-9, 1e-9, decay)
    return np.expm1(-decay * share) / np.expm1(-decay)


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
