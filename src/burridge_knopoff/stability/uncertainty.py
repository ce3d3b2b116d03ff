"""The uncertainty exponent of a basin boundary: how little it helps to know the initial state better.

Two states a distance ε apart end on different attractors with a probability f(ε) ∝ ε^α as ε → 0. For a smooth curve in
a plane α = 1; a fractal boundary of dimension D has α = 2 − D.

Reference: S. W. McDonald, C. Grebogi, E. Ott and J. A. Yorke, Physica D 17 (1985) 125-153.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from scipy.stats import chi2

#: Separations ε of the pairs, as parts of the width of the map; where f saturates it has no exponent yet.
SEPARATIONS = (3e-3, 1e-3, 3e-4, 1e-4, 3e-5)

# Pairs that must differ at a separation for it to count.
FEWEST = 8

# Probability of a scatter about the line below which there is no single exponent.
SIGNIFICANCE = 1e-3


def sample_pairs(first: Sequence[float], last: Sequence[float], count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points of a plane, shape (count, 2), and their partners, shape (separations, count, 2).

    first, last : ranges (low, high) of both coordinates
    The partners of a point lie in one direction, drawn at random, at each of SEPARATIONS times the width of the first
    range.
    """
    generator = np.random.default_rng(seed)
    low, high = np.array([first, last], dtype=float).T
    points = low + (high - low) * generator.random((count, 2))
    angle = 2.0 * np.pi * generator.random(count)
    direction = np.stack([np.cos(angle), np.sin(angle)], axis=1)
    return points, points + (first[1] - first[0]) * np.array(SEPARATIONS)[:, None, None] * direction


def uncertain_counts(labels: np.ndarray, partners: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return how many pairs differ, and how many pairs are known, at each separation.

    labels : of the points, shape (count,); partners : shape (separations, count); below 0 where undetermined
    """
    known = (labels >= 0) & (partners >= 0)
    return ((labels != partners) & known).sum(axis=1), known.sum(axis=1)


def uncertainty_exponent(different: np.ndarray, known: np.ndarray) -> tuple[float, float]:
    """Return α and its standard error, from a straight line through log f against log ε.

    different, known : pairs that differ, and all, at each of SEPARATIONS
    Weights and error follow from the binomial counts. NaN with fewer than three separations at which enough pairs
    differ, or if no straight line goes through them.
    """
    enough = (different >= FEWEST) & (different < known)
    if enough.sum() < 3:
        return np.nan, np.nan
    x = np.log(np.array(SEPARATIONS)[enough])
    share = different[enough] / known[enough]
    y = np.log(share)
    weight = different[enough] / (1.0 - share)
    # The pairs of all separations share their first points: the binomial weights neglect that.
    (slope, intercept), covariance = np.polyfit(x, y, 1, w=np.sqrt(weight), cov="unscaled")
    scatter = float(np.sum(weight * (y - slope * x - intercept) ** 2))
    if chi2.sf(scatter, enough.sum() - 2) < SIGNIFICANCE:
        return np.nan, np.nan
    # LAPACK's last bits depend on where in memory its arguments lie.
    return round(float(slope), 10), round(float(np.sqrt(covariance[0, 0])), 10)
