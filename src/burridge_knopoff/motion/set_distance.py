"""Distances between sets of returns, shape (n, 2 blocks), in the largest difference of a coordinate."""

from __future__ import annotations

import math

import numpy as np
from scipy.spatial import cKDTree

#: Fraction of the returns that must lie near another set: a few may lie in gaps of the other set.
NEAR_SHARE = 0.95
#: Two sets are the same if their distance is at most this many times the spacing within them, which is not uniform.
SPACINGS = 3.0


def distance(
    first: np.ndarray, second: np.ndarray | cKDTree, share: float = NEAR_SHARE, bound: float = np.inf
) -> float:
    """Return the distance from the second set within which the fraction `share` of the first set lies.

    bound : distances beyond it may be returned as infinite, which makes the search for neighbours faster
    """
    tree = second if isinstance(second, cKDTree) else cKDTree(second)
    nearest = _nearest_distances(first, tree, bound)
    near = int(np.count_nonzero(np.isfinite(nearest)))
    # The quantile lies between two of the sorted distances. If the bound lies between these, both are needed.
    below = math.floor(share * (len(first) - 1)) + 1
    if near < below:
        return np.inf
    return float(np.quantile(_nearest_distances(first, tree, np.inf) if near == below < len(first) else nearest, share))


def is_near(first: np.ndarray, second: np.ndarray, limit: float, share: float = NEAR_SHARE) -> bool:
    """Return whether `distance(first, second)` is at most the limit."""
    return distance(first, second, share, limit) <= limit


def minimum_distance(first: np.ndarray, second: np.ndarray, bound: float = np.inf) -> float:
    """Return the distance between the two closest returns of two sets; infinite if it exceeds the bound."""
    return float(_nearest_distances(first, cKDTree(second), bound).min())


def _nearest_distances(first: np.ndarray, tree: cKDTree, bound: float) -> np.ndarray:
    """Return the distance of each return from the nearest point of a tree; infinite beyond the bound."""
    # The tree excludes points exactly at the bound. If two sets are far apart, the search is fast.
    nearest, _ = tree.query(first, p=np.inf, distance_upper_bound=np.nextafter(bound, np.inf))
    return nearest


def spacing_of(returns: np.ndarray) -> float:
    """Return the distance within which the share NEAR_SHARE of the returns, shape (n, 2 blocks), have a neighbour."""
    nearest, _ = cKDTree(returns).query(returns, k=2, p=np.inf)
    return float(np.quantile(nearest[:, 1], NEAR_SHARE))
