"""Whether there is a synchronized orbit and how it is lost: one list for orbits, files and the report."""

from __future__ import annotations

from enum import IntEnum

from burridge_knopoff.model.chain import Chain


def has_orbit(chain: Chain) -> bool:
    """Tell whether the orbit is looked for in a chain: one of three blocks that is its own mirror image."""
    return chain.blocks == 3 and chain.is_mirror_symmetric


class OrbitStatus(IntEnum):
    """Whether there is a synchronized orbit, numbered as in netCDF files.

    Where friction does not depend on speed, as under most laws at a = 0, nothing feeds or damps the motion: no periodic
    orbit is isolated (neutral).
    """

    FOUND = 0
    NEUTRAL = 1
    NOT_FOUND = 2
    NOT_THREE_BLOCKS = 3


class Bifurcation(IntEnum):
    """How the synchronized orbit is lost, numbered as in netCDF files."""

    UNDETERMINED = -1
    PITCHFORK = 1
    FLIP = 2


class BifurcationSide(IntEnum):
    """On which side of a_c the orbits that branch off lie, numbered as in netCDF files."""

    UNDETERMINED = -1
    SUBCRITICAL = 0
    SUPERCRITICAL = 1
