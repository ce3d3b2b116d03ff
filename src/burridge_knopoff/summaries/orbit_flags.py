"""Flags of the synchronized orbit and its loss, shared by the file of orbits, the figures and the report."""

from __future__ import annotations

from enum import IntEnum


class OrbitStatus(IntEnum):
    """Whether there is a synchronized orbit, numbered as in netCDF files.

    If friction does not depend on speed, as under most laws at a = 0, motion is neither driven nor damped and no
    periodic orbit is isolated (neutral).
    """

    FOUND = 0
    NEUTRAL = 1
    NOT_FOUND = 2
    NOT_THREE_BLOCKS = 3


class BifurcationSide(IntEnum):
    """Side of a_c on which the branching orbits exist, numbered as in netCDF files."""

    UNDETERMINED = -1
    SUBCRITICAL = 0
    SUPERCRITICAL = 1
