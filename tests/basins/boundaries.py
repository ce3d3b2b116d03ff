"""Labels of points of the unit square whose boundaries have known exponents."""

from collections.abc import Callable

import numpy as np


def half_plane(points: np.ndarray) -> np.ndarray:
    """Return 1 on one side of a straight line, otherwise 0: α = 1."""
    return (points[:, 0] > 0.4 * points[:, 1] + 0.23).astype(int)


def disc(points: np.ndarray) -> np.ndarray:
    """Return 1 in a disc, otherwise 0: α = 1."""
    return (np.hypot(points[:, 0] - 0.5, points[:, 1] - 0.5) < 0.3).astype(int)


def cantor(parts: int) -> Callable[[np.ndarray], np.ndarray]:
    """Return labels of strips: the gaps of a Cantor set of two pieces of 1/parts, even and odd ones by their level.

    Such points leave [0, 1] under x → parts·x (mod the gap) after as many steps. D = 1 + log 2/log(parts), so that
    α = 1 − log 2/log(parts).
    """

    def label(points: np.ndarray) -> np.ndarray:
        x = points[:, 0].copy()
        level = np.zeros(len(x), dtype=int)
        for k in range(1, 40):
            scaled = parts * x
            gap = (scaled > 1.0) & (scaled < parts - 1.0)
            level[(level == 0) & gap] = k
            x = np.where(scaled <= 1.0, scaled, np.where(gap, x, scaled - (parts - 1.0)))
        return np.where(level > 0, level % 2, 2)

    return label


def striped(points: np.ndarray) -> np.ndarray:
    """Return alternate stripes, 0.0003 wide: f is constant at larger separations, and ∝ ε at smaller ones."""
    return (np.floor(points[:, 0] / 3e-4) % 2).astype(int)
