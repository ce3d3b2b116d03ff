"""The bifurcations that may end or change an attractor as a parameter varies, for orbits, files and figures."""

from __future__ import annotations

from enum import IntEnum


class BifurcationKind(IntEnum):
    """Kinds of bifurcations and crises (bifurcations), numbered as in netCDF files.

    grazing : a stick or a slip of a periodic orbit shrinks to nothing or is born
    fold : two orbits meet and vanish, multiplier +1
    period_doubling : the period doubles, multiplier −1
    neimark_sacker : a pair of complex multipliers leaves the unit circle, a torus branches off
    pitchfork : mirror symmetry breaks, multiplier +1 of a symmetry-breaking perturbation
    crisis : an attractor that is not a periodic orbit ends

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
