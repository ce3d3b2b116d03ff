"""Whether there is a synchronized orbit and how it is lost: one list for the file of orbits, figures and the report."""

from __future__ import annotations

from enum import IntEnum


class OrbitStatus(IntEnum):
    """Whether there is a synchronized orbit, numbered as in netCDF files.

    Where friction does not depend on speed, as under most laws at a = 0, nothing feeds or damps the motion: no periodic
    orbit is isolated (neutral).
    """

    FOUND = 0
    NEUTRAL = 1
    NOT_FOUND = 2
    NOT_THREE_BLOCKS = 3


class BifurcationSide(IntEnum):
    """On which side of a_c the orbits that branch off lie, numbered as in netCDF files."""

    UNDETERMINED = -1
    SUBCRITICAL = 0
    SUPERCRITICAL = 1
