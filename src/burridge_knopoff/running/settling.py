"""Levels of J whose last times are found in a run, and the level below which J is rounding."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState, Model

#: Levels of J: visible to the eye, visible in a figure, synchronization threshold, and two further ones, to follow the
#: decay of J.
LEVELS = (1.0e-2, 1.0e-3, 1.0e-6, 1.0e-9, 1.0e-12)

#: The most that rounding makes of J in synchrony, in units of the rounding of the coordinates. Synchrony damps rounding
#: slowly near a_c: 26 units were measured at a = 0.08, 103 at 0.086 (nonlinear law).
ROUNDING_UNITS = 1000.0


def distance_rounding(model: Model, state: ChainState) -> float:
    """Return a bound on the rounding error of J: `ROUNDING_UNITS` roundings of the largest |U_i − vτ| or |U_i'|.

    The threshold of a start compares spring forces, which are rounded like U − vτ, and not like its small part that
    oscillates.
    """
    coordinates = state.position + model.sliding_offset, state.velocity
    return float(ROUNDING_UNITS * np.finfo(float).eps * np.abs(coordinates).max())
