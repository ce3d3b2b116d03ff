"""Correlation of two velocities."""

from __future__ import annotations

import math

import numpy as np

from burridge_knopoff.motion.frequency import is_constant


def correlation(one: np.ndarray, other: np.ndarray) -> float:
    """Return the Pearson correlation of two series of equal length, NaN if one of them is constant."""
    if is_constant(one) or is_constant(other):
        return math.nan
    one, other = one - one.mean(), other - other.mean()
    # Sums instead of matrix products, whose last bits depend on the alignment of the values in memory.
    product = (one * other).sum() / math.sqrt((one * one).sum() * (other * other).sum())
    return float(min(max(product, -1.0), 1.0))
