"""How near sets of returns, shape (n, 2 blocks), are to each other, by the largest difference of a coordinate."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

#: Share of the returns that must lie near another set: a few may lie where the other has a gap.
NEAR_SHARE = 0.95
#: Sets are one if they are no farther apart than this many times the distance between neighbours within them, which
#: varies from place to place.
SPACINGS = 3.0


def distance(
    first: np.ndarray, second: np.ndarray | cKDTree, share: float = NEAR_SHARE, bound: float = np.inf
) -> float:
    """Return how far the returns of the first set lie from the second: the distance within which that share does.

    bound : what is farther may be given as infinitely far: neighbours beyond it are hardly looked for
    """
    tree = second if isinstance(second, cKDTree) else cKDTree(second)
    nearest = _nearest_distances(first, tree, bound)
    near = int(np.count_nonzero(np.isfinite(nearest)))
    # The quantile lies between two of the sorted distances; only where the bound parts these does their size matter.
    below = math.floor(share * (len(first) - 1)) + 1
    if near < below:
        return np.inf
    return float(np.quantile(_nearest_distances(first, tree, np.inf) if near == below < len(first) else nearest, share))


def is_near(first: np.ndarray, second: np.ndarray, limit: float, share: float = NEAR_SHARE) -> bool:
    """Tell whether `distance(first, second)` is at most the limit."""
    return distance(first, second, share, limit) <= limit


def minimum_distance(first: np.ndarray, second: np.ndarray, bound: float = np.inf) -> float:
    """Return the distance between the two nearest returns of two sets; infinite if it is beyond the bound."""
    return float(_nearest_distances(first, cKDTree(second), bound).min())


def _nearest_distances(first: np.ndarray, tree: cKDTree, bound: float) -> np.ndarray:
    """Return how far each of the first returns is from the nearest in a tree; infinite beyond the bound."""
    # The tree leaves out what lies just at the bound. Where two sets are far apart it hardly looks.
    nearest, _ = tree.query(first, p=np.inf, distance_upper_bound=np.nextafter(bound, np.inf))
    return nearest


def spacing_of(returns: np.ndarray, share: float = NEAR_SHARE) -> float:
    """Return the distance within which that share of the returns have a neighbour, shape (n, 2 blocks)."""
    nearest, _ = cKDTree(returns).query(returns, k=2, p=np.inf)
    return float(np.quantile(nearest[:, 1], share))
