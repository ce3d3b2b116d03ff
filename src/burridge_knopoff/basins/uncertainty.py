"""The uncertainty exponent α of a basin boundary.

Two states a distance ε apart end on different attractors with a probability f(ε) ∝ ε^α as ε → 0. A smooth curve in a
plane has α = 1, a fractal boundary of dimension D has α = 2 − D: the smaller α, the less a better initial state helps.

Reference: S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125-153.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from burridge_knopoff.basins.pair_separation import BATCHES, SEPARATIONS, PairCounts

#: α is fitted from the separation of this index on, over a factor of 6561; at larger separations f saturates.
FITTED_FROM = 4

# Smallest number of different pairs at a separation that is fitted, and smallest number of such separations.
_FEWEST_PAIRS = 8
_FEWEST_SEPARATIONS = 4

# A single exponent is rejected if its change over the fitted separations is larger than this, and than this many
# standard errors. The local exponent of a self-similar fractal oscillates about α by less.
_CHANGE = 0.3
_STANDARD_ERRORS = 3.0

# A change is by chance smaller than this many standard errors; what is larger enters into the error of α.
_LIKELY_ERRORS = 2.0


class ExponentKind(IntEnum):
    """Whether a boundary has a single exponent, an exponent that varies with ε, or too few different pairs to decide.

    A single exponent is assumed unless its change is significant; with few pairs the error of the change is large.
    """

    UNKNOWN = -1
    VARYING = 0
    SINGLE = 1


@dataclass(frozen=True)
class Exponent:
    """f and its exponents; all but the kind as (value, error), from a jackknife over the batches of pairs.

    fraction : f, shape (separations,)
    local : slope of log f against log ε between neighbouring separations, shape (separations − 1,)
    alpha : slope of a straight line through the fitted separations; NaN unless the kind is SINGLE. Its error includes
        half the change, as far as two standard errors of it do not explain it
    change : of that slope from the largest to the smallest fitted separation, from a parabola
    """

    kind: ExponentKind
    fraction: tuple[np.ndarray, np.ndarray]
    local: tuple[np.ndarray, np.ndarray]
    alpha: tuple[float, float]
    change: tuple[float, float]


def uncertainty_exponent(pairs: PairCounts) -> Exponent:
    """Return the exponents of a boundary from pairs at each of SEPARATIONS; NaN if there are too few pairs."""
    every = np.arange(BATCHES)[None]
    all_but_one = np.array([np.delete(every, batch) for batch in range(BATCHES)])
    x = np.log(SEPARATIONS)
    # NaN where no pair has labels, or none has different ones.
    share, shares = (_share(pairs, batches) for batches in (every, all_but_one))
    y, without = (np.log(np.where(values > 0.0, values, np.nan)) for values in (share, shares))
    local, locals_ = (np.diff(values, axis=1) / np.diff(x) for values in (y, without))
    nothing = np.nan, np.nan
    exponents = _jackknife(share, shares), _jackknife(local, locals_)
    # Fitted separations are consecutive: one with many different pairs by chance, among others with few, is left out.
    # Different pairs in a single batch leave no error estimate.
    enough = (pairs.different_count >= _FEWEST_PAIRS) & (np.count_nonzero(pairs.different_weight, axis=0) > 1)
    enough = enough[FITTED_FROM:]
    count = len(enough) if enough.all() else int(np.argmin(enough))
    if count < _FEWEST_SEPARATIONS:
        return Exponent(ExponentKind.UNKNOWN, *exponents, nothing, nothing)
    fitted = slice(FITTED_FROM, FITTED_FROM + count)
    line, lines = (_fit(x[fitted], values[:, fitted], 1) for values in (y, without))
    parabola, parabolas = (_fit(x[fitted], values[:, fitted], 2) for values in (y, without))
    span = 2.0 * (x[fitted][-1] - x[fitted][0])
    (alpha,), (alpha_error,) = _jackknife(line, lines)
    (change,), (change_error,) = _jackknife(span * parabola, span * parabolas)
    if abs(change) > max(_CHANGE, _STANDARD_ERRORS * change_error):
        return Exponent(ExponentKind.VARYING, *exponents, nothing, (change, change_error))
    # The slope at either end of the fitted separations is alpha ± change/2.
    bend = 0.5 * np.sqrt(max(change**2 - (_LIKELY_ERRORS * change_error) ** 2, 0.0))
    alpha_error = round(float(np.hypot(alpha_error, bend)), 10)
    return Exponent(ExponentKind.SINGLE, *exponents, (alpha, alpha_error), (change, change_error))


def _share(pairs: PairCounts, batches: np.ndarray) -> np.ndarray:
    """Return f from some batches of pairs, shape (n, BATCHES), as (n, separations); NaN where no pair has labels."""
    different, total = (weights[batches].sum(axis=1) for weights in (pairs.different_weight, pairs.labelled_weight))
    return np.divide(different, total, out=np.full(total.shape, np.nan), where=total > 0.0)


def _fit(x: np.ndarray, y: np.ndarray, degree: int) -> np.ndarray:
    """Return the coefficient of x^degree of the polynomial fitted to each row of y, shape (n, 1)."""
    return np.polyfit(x, y.T, degree)[0][:, None]


def _jackknife(value: np.ndarray, without: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the only row of `value`, and its jackknife error from rows that each leave out a batch; NaN if one is."""
    error = np.sqrt(len(without) - 1.0) * without.std(axis=0)
    # The last bits of LAPACK depend on the memory alignment of its arguments.
    return value[0].round(10), error.round(10)
