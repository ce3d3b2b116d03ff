"""Flags of the synchronized orbit and its stability, shared by the file of orbits, the figures and the report."""

from __future__ import annotations

import math
from enum import IntEnum

import xarray


class OrbitStatus(IntEnum):
    """Whether there is a synchronized orbit, numbered as in netCDF files.

    If friction does not depend on speed, as under most laws at a = 0, motion is neither driven nor damped and no
    periodic orbit is isolated (neutral).
    """

    FOUND = 0
    NEUTRAL = 1
    NOT_FOUND = 2
    NOT_THREE_BLOCKS = 3


class CriticalStability(IntEnum):
    """The stability of the synchronized orbit at a_c as a grows, numbered as in netCDF files.

    If the orbit repels mirror-symmetric perturbations, it is unstable on both sides: synchrony does not end there.
    """

    UNDETERMINED = -1
    UNSTABLE = 0
    LOST = 1
    GAINED = 2


class BifurcationSide(IntEnum):
    """Side of a_c on which the branching orbits exist, numbered as in netCDF files."""

    UNDETERMINED = -1
    SUBCRITICAL = 0
    SUPERCRITICAL = 1


def stability_edge(orbits: xarray.Dataset) -> float:
    """Return a_c of one law; NaN if there is none, or if the orbit is unstable on both sides."""
    unstable = orbits["critical_stability"].item() == CriticalStability.UNSTABLE
    return math.nan if unstable else orbits["critical_a"].item()
