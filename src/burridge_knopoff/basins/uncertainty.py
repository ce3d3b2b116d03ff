"""The uncertainty exponent of a basin boundary: how little it helps to know the initial state better.

Two states a distance ε apart end on different attractors with a probability f(ε) ∝ ε^α as ε → 0. For a smooth curve in
a plane α = 1; a fractal boundary of dimension D has α = 2 − D.

Reference: S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125-153.
"""

from __future__ import annotations

from dataclasses import dataclass
from enum import IntEnum

import numpy as np

from burridge_knopoff.basins.pair_separation import BATCHES, SEPARATIONS, PairCounts

#: α is fitted from the separation of this number on, over a factor of 6561; at larger ones f saturates.
FITTED_FROM = 4

# Pairs that must differ at a separation for it to count, and separations that must count.
_FEWEST_PAIRS = 8
_FEWEST_SEPARATIONS = 4

# There is no single exponent where its change over the fitted separations is larger than this, and than so many
# standard errors. A fractal repeats itself at a ratio of separations: around its exponent the local one swings by less.
_CHANGE = 0.3
_STANDARD_ERRORS = 3.0


class ExponentKind(IntEnum):
    """Whether a boundary has an exponent: unknown, with too few pairs that differ; varying with ε; or a single one.

    A single one is told unless its change is beyond the error of that, which with few pairs is large.
    """

    UNKNOWN = -1
    VARYING = 0
    SINGLE = 1


@dataclass(frozen=True)
class Exponent:
    """f and its exponents; all but the kind as (value, standard error), from a jackknife over the batches of pairs.

    fraction : f, shape (separations,)
    local : slope of log f against log ε between neighbouring separations, shape (separations − 1,)
    alpha : slope of a straight line through the fitted separations; NaN unless the kind is SINGLE
    change : of that slope from the largest to the smallest fitted separation, from a parabola
    """

    kind: ExponentKind
    fraction: tuple[np.ndarray, np.ndarray]
    local: tuple[np.ndarray, np.ndarray]
    alpha: tuple[float, float]
    change: tuple[float, float]


def uncertainty_exponent(pairs: PairCounts) -> Exponent:
    """Return the exponents of a boundary from pairs at each of SEPARATIONS; NaN what too few pairs tell."""
    every = np.arange(BATCHES)[None]
    all_but_one = np.array([np.delete(every, batch) for batch in range(BATCHES)])
    x = np.log(SEPARATIONS)
    # NaN where no pair is known, or none differs: the logarithm of 0 tells nothing.
    share, shares = (_share(pairs, batches) for batches in (every, all_but_one))
    y, without = (np.log(np.where(values > 0.0, values, np.nan)) for values in (share, shares))
    local, locals_ = (np.diff(values, axis=1) / np.diff(x) for values in (y, without))
    nothing = np.nan, np.nan
    found = _jackknife(share, shares), _jackknife(local, locals_)
    # Without gaps: a separation at which by chance many pairs differ tells nothing among others.
    # If all of them are in one batch, nothing is known without it, and no error.
    enough = (pairs.different_count >= _FEWEST_PAIRS) & (np.count_nonzero(pairs.different_weight, axis=0) > 1)
    enough = enough[FITTED_FROM:]
    count = len(enough) if enough.all() else int(np.argmin(enough))
    if count < _FEWEST_SEPARATIONS:
        return Exponent(ExponentKind.UNKNOWN, *found, nothing, nothing)
    fitted = slice(FITTED_FROM, FITTED_FROM + count)
    line, lines = (_fit(x[fitted], values[:, fitted], 1) for values in (y, without))
    parabola, parabolas = (_fit(x[fitted], values[:, fitted], 2) for values in (y, without))
    span = 2.0 * (x[fitted][-1] - x[fitted][0])
    (alpha,), (alpha_error,) = _jackknife(line, lines)
    (change,), (change_error,) = _jackknife(span * parabola, span * parabolas)
    if abs(change) > max(_CHANGE, _STANDARD_ERRORS * change_error):
        return Exponent(ExponentKind.VARYING, *found, nothing, (change, change_error))
    return Exponent(ExponentKind.SINGLE, *found, (alpha, alpha_error), (change, change_error))


def _share(pairs: PairCounts, batches: np.ndarray) -> np.ndarray:
    """Return f from some batches of pairs, shape (n, BATCHES), as (n, separations); NaN where no pair is known."""
    different, known = (weights[batches].sum(axis=1) for weights in (pairs.different_weight, pairs.labelled_weight))
    return np.divide(different, known, out=np.full(known.shape, np.nan), where=known > 0.0)


def _fit(x: np.ndarray, y: np.ndarray, degree: int) -> np.ndarray:
    """Return the coefficient of x^degree in the polynomial nearest to each row of y, shape (n, 1)."""
    return np.polyfit(x, y.T, degree)[0][:, None]


def _jackknife(value: np.ndarray, without: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return the only row of a value, and its error from the rows without one batch each; NaN with a NaN among them."""
    error = np.sqrt(len(without) - 1.0) * without.std(axis=0)
    # LAPACK's last bits depend on where in memory its arguments lie.
    return value[0].round(10), error.round(10)
