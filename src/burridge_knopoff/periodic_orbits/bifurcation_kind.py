"""Kinds of bifurcations of periodic orbits and attractors, for orbits, files and figures."""

from __future__ import annotations

from enum import IntEnum


class BifurcationKind(IntEnum):
    """Kinds of bifurcations, including crises, numbered as in netCDF files.

    grazing : a stick or a slip of a periodic orbit appears or vanishes
    fold : two orbits meet and vanish, multiplier +1
    period_doubling : the period doubles, multiplier −1
    neimark_sacker : a pair of complex multipliers leaves the unit circle, a torus branches off
    pitchfork : mirror symmetry breaks, multiplier +1 of a symmetry-breaking perturbation
    crisis : an attractor that is not a periodic orbit ends
    hopf : an orbit without stops shrinks to uniform sliding

    words : name in texts and figures; mark : matplotlib marker in figures, empty if only a range of a is known

    >>> from burridge_knopoff import BifurcationKind
    >>> BifurcationKind.FOLD.name, int(BifurcationKind.NEIMARK_SACKER)
    ('FOLD', 3)
    """

    words: str
    mark: str

    def __new__(cls, number: int, words: str = "", mark: str = "") -> BifurcationKind:
        """Return a kind by its number, with its name and its marker."""
        kind = int.__new__(cls, number)
        kind._value_, kind.words, kind.mark = number, words, mark
        return kind

    UNDETERMINED = -1, "undetermined"
    GRAZING = 0, "grazing", "v"
    FOLD = 1, "fold", "s"
    PERIOD_DOUBLING = 2, "period doubling", "D"
    NEIMARK_SACKER = 3, "Neimark–Sacker", "o"
    PITCHFORK = 4, "pitchfork", "P"
    CRISIS = 5, "crisis"
    HOPF = 6, "Hopf", "^"
