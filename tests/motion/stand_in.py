"""Attractors with given features; all others have defaults."""

from typing import Any

import numpy as np

from burridge_knopoff import Attractor, Model, MotionKind, SteadyMotion, Symmetry
from burridge_knopoff.motion.section_returns import Returns

CLOSED = (MotionKind.PERIODIC, MotionKind.SYNCHRONIZED)
ASYMMETRIC, SYMMETRIC, SYNCHRONIZED = Symmetry.ASYMMETRIC, Symmetry.SYMMETRIC, Symmetry.SYNCHRONIZED
MODEL = Model("linearized", a=0.08)
#: Returns of an arbitrary motion.
ROWS = np.random.default_rng(4).uniform(-1.0, 1.0, (40, 6))


def stand_in(
    symmetry: int = SYMMETRIC, mean_distance: float = 0.1, partner: int = 0, ahead: float = 1.0, **features: Any
) -> Attractor:
    """Return an attractor whose last return has block 1 `ahead`; further features may be given."""
    of_attractor = {
        key: features.pop(key) for key in ("model", "slow", "close_returns", "patience", "radius") if key in features
    }
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
        "period": 10.0 if features.get("kind", MotionKind.PERIODIC) in CLOSED else np.nan,
        "exponent": np.array([0.0, -0.1, -0.2]),
    }
    of_attractor = {"model": MODEL, "radius": 0.01, "close_returns": 8, **of_attractor}
    return Attractor(motion=SteadyMotion(**{**motion, **features}), symmetry=symmetry, partner=partner, **of_attractor)


def section(
    returns: np.ndarray,
    mirror_returns: np.ndarray,
    spacing: float,
    drift: float,
    stop_count: tuple[int, ...] = (1, 2, 1),
    window: float = 100.0,
) -> Returns:
    """Return a window with these results."""
    return Returns(returns, mirror_returns, spacing, drift, np.array(stop_count), window)


def at(*places: float, ahead: float = 0.0, **features: Any) -> Attractor:
    """Return an attractor with all coordinates of its returns at these places, except block 1, which is `ahead`.

    In its mirror image block 3 is.
    """
    tilt = np.array([ahead, 0.0, 0.0, 0.0, 0.0, 0.0])
    returns = np.repeat(np.array(places)[:, None], 6, axis=1)
    return stand_in(returns=returns + tilt, mirror_returns=returns + tilt[[2, 1, 0, 3, 4, 5]], **features)


def nearest(first: np.ndarray, second: np.ndarray, rank: int) -> np.ndarray:
    """Return the distance of each row of a set from its nearest row, or nearest but one, of another, by brute force."""
    return np.sort(np.abs(first[:, None] - second[None]).max(axis=2), axis=1)[:, rank]
