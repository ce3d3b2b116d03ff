"""Attractors of which only what is told is set."""

from __future__ import annotations

from typing import Any

import numpy as np

from burridge_knopoff.stability.attractor import Attractor
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.steady import SteadyMotion


def stand_in(symmetry: int, mean_distance: float, partner: int, ahead: float = 1.0, **told: Any) -> Attractor:
    """Return an attractor whose last return has block 1 `ahead`; its further features may be told."""
    of_attractor = {key: told.pop(key) for key in ("slow", "close_returns", "patience", "radius") if key in told}
    returns = np.array([[9.0, 9.0, 9.0, 0.0, 0.0, 0.0], [ahead, 0.0, 0.0, 0.0, 0.5, 0.25]])
    motion = {
        "returns": returns,
        "mirror_returns": -returns,
        "spacing": 0.0,
        "mean_distance": mean_distance,
        "mean_distance_error": 0.0,
        "stop_rate": np.array([0.1, 0.2, 0.1]),
        "kind": MotionKind.PERIODIC,
        "section_period": 1,
        "exponent": np.array([0.0, -0.1, -0.2]),
    }
    return Attractor(SteadyMotion(**{**motion, **told}), symmetry, partner, **{"radius": 0.01, **of_attractor})
