"""Planes of initial states: two positions vary, and all other values are those of one state.

For one block they are its position and its velocity: the plane (U, U').
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def plane(
    position: Sequence[float] | np.ndarray, first: np.ndarray, last: np.ndarray, velocity: Sequence[float] | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the initial states of a plane, U(0) and U'(0), each of shape (len(last) len(first), blocks).

    They differ from the state given by `position` and `velocity` in U_1(0), from `first`, and in U_N(0), or U_1'(0) of
    one block, from `last`; `first` runs faster.
    """
    return states(position, np.tile(first, len(last)), np.repeat(last, len(first)), velocity)


def states(
    position: Sequence[float] | np.ndarray, first: np.ndarray, last: np.ndarray, velocity: Sequence[float] | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return initial states U(0) and U'(0), shape (n, blocks) each; arguments as for `plane`, `first`, `last` (n,)."""
    positions, velocities = (np.tile(np.array(values, dtype=float), (len(first), 1)) for values in (position, velocity))
    positions[:, 0] = first
    (positions if positions.shape[1] > 1 else velocities)[:, -1] = last
    return positions, velocities


def pixel_centres(interval: Sequence[float], pixels: int) -> np.ndarray:
    """Return the centres of equal pixels that fill an interval (low, high), shape (pixels,)."""
    low, high = interval
    return low + (high - low) * (np.arange(pixels) + 0.5) / pixels
