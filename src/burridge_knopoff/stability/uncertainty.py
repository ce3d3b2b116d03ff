"""The uncertainty exponent of a basin boundary: how little it helps to know the initial state better.

Two states a distance ε apart end on different attractors with a probability f(ε) ∝ ε^α. For a smooth curve in a plane
α = 1; a fractal boundary of dimension D has α = 2 − D.

Reference: S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125-153.
"""

from __future__ import annotations

import numpy as np
from scipy.stats import linregress

#: Separations ε in pixels.
SEPARATIONS = (1, 2, 4, 8, 16)

# Bands of the map that are left out in turn for the error.
BANDS = 8


def uncertain_fraction(labels: np.ndarray) -> np.ndarray:
    """Return the share of pairs of pixels, along rows and columns, with different labels, for each of SEPARATIONS.

    labels : shape (rows, columns); pairs with an undetermined pixel (below 0) are left out; NaN where there is no pair
    """
    fractions = []
    for gap in SEPARATIONS:
        pairs = [(labels[gap:], labels[:-gap]), (labels[:, gap:], labels[:, :-gap])]
        known = [(one >= 0) & (other >= 0) for one, other in pairs]
        count = sum(int(mask.sum()) for mask in known)
        different = sum(int(((one != other) & mask).sum()) for (one, other), mask in zip(pairs, known, strict=True))
        fractions.append(different / count if count else np.nan)
    return np.array(fractions)


def uncertainty_exponent(labels: np.ndarray) -> tuple[float, float]:
    """Return α and its standard error, from a straight line through log f against log ε and a jackknife over bands.

    NaN where the map shows one basin only, or is smaller than four of the largest separation.
    """
    if min(labels.shape) < 4 * SEPARATIONS[-1]:
        return np.nan, np.nan
    whole = _slope(uncertain_fraction(labels))
    bands = np.array_split(np.arange(len(labels)), BANDS)
    left_out = []
    for band in bands:
        rest = labels.copy()
        rest[band] = -1
        left_out.append(_slope(uncertain_fraction(rest)))
    spread = np.array(left_out) - np.mean(left_out)
    return whole, float(np.sqrt((BANDS - 1) / BANDS * np.sum(spread**2)))


def _slope(fractions: np.ndarray) -> float:
    if not np.all(fractions > 0.0):
        return np.nan
    return float(linregress(np.log(SEPARATIONS), np.log(fractions)).slope)
