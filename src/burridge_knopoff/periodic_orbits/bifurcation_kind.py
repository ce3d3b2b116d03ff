"""What may end or change an attractor as a parameter moves: one list for orbits, files and figures."""

from __future__ import annotations

from enum import IntEnum


class BifurcationKind(IntEnum):
    """Kinds of bifurcations, numbered as in netCDF files.

    grazing : a stick of a periodic orbit, or a slip, shrinks to nothing or is born
    fold : two orbits meet and vanish, multiplier +1
    period_doubling : the period doubles, multiplier −1
    neimark_sacker : a pair of complex multipliers leaves the unit circle, a torus branches off
    pitchfork : mirror symmetry breaks, multiplier +1 of a perturbation that breaks it
    crisis : a set that is no closed orbit ends

    >>> from burridge_knopoff import BifurcationKind
    >>> BifurcationKind.FOLD.name, int(BifurcationKind.NEIMARK_SACKER)
    ('FOLD', 3)
    """

    UNDETERMINED = -1
    GRAZING = 0
    FOLD = 1
    PERIOD_DOUBLING = 2
    NEIMARK_SACKER = 3
    PITCHFORK = 4
    CRISIS = 5
