"""Planes of initial states: two positions vary, and all other values are those of one state."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np


def plane(
    position: Sequence[float] | np.ndarray, first: np.ndarray, last: np.ndarray, velocity: Sequence[float] | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return the initial states of a plane, U(0) and U'(0), each of shape (len(last) len(first), blocks).

    They differ from the state given by `position` and `velocity` in U_1(0), from `first`, and U_N(0), from `last`;
    `first` runs faster.
    """
    return states(position, np.tile(first, len(last)), np.repeat(last, len(first)), velocity)


def states(
    position: Sequence[float] | np.ndarray, first: np.ndarray, last: np.ndarray, velocity: Sequence[float] | np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return initial states U(0) and U'(0), shape (n, blocks) each, that differ from one in U_1(0) and U_N(0), (n,)."""
    positions = np.tile(np.array(position, dtype=float), (len(first), 1))
    positions[:, 0], positions[:, -1] = first, last
    return positions, np.tile(np.array(velocity, dtype=float), (len(first), 1))


def pixel_centres(interval: Sequence[float], pixels: int) -> np.ndarray:
    """Return the centres of equal pixels that fill an interval (low, high), shape (pixels,)."""
    low, high = interval
    return low + (high - low) * (np.arange(pixels) + 0.5) / pixels
