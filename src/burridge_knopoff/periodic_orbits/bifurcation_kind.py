"""Kinds of bifurcations of periodic orbits and attractors, for orbits, files and figures."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from enum import IntEnum
from itertools import combinations

import numpy as np

from burridge_knopoff.periodic_orbits.symmetry import Symmetry

#: Multipliers are real if their imaginary part is below this.
REAL = 1e-6


class BifurcationKind(IntEnum):
    """Kinds of bifurcations, including crises, numbered as in netCDF files.

    grazing : a stick or a slip of a periodic orbit appears or vanishes
    fold : two orbits meet and vanish, multiplier +1
    period_doubling : the period doubles, multiplier −1
    neimark_sacker : a pair of complex multipliers leaves the unit circle, a torus branches off
    pitchfork : mirror symmetry breaks, multiplier +1 of a symmetry-breaking perturbation
    crisis : an attractor that is not a periodic orbit ends

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


@dataclass(frozen=True)
class MultiplierTest:
    """A test function: a smooth function of the multipliers that has a root at a kind of bifurcation along a branch.

    value : the function of some multipliers, complex, shape (n,)
    part : the perturbations whose multipliers are used: `symmetry_preserving`, `symmetry_breaking` or both
    symmetric : True for orbits that are their own mirror image half a period later, False for others, None for all
    is_root : whether a root is the bifurcation, given the multipliers there; None if every root is
    """

    kind: BifurcationKind
    value: Callable[[np.ndarray], np.number]
    part: str = "both"
    symmetric: bool | None = None
    is_root: Callable[[np.ndarray], bool] | None = None

    def is_applicable(self, part: str, symmetry: Symmetry) -> bool:
        """Return whether the test applies to these perturbations of orbits with this symmetry."""
        other = self.symmetric not in (None, symmetry == Symmetry.SYMMETRIC)
        return self.part in ("both", part) and not (part == "symmetry_preserving" and other)


def _pairs(own: np.ndarray) -> np.ndarray:
    """Return the products of all pairs of multipliers."""
    return np.array([one * other for one, other in combinations(own, 2)])


def _is_complex(own: np.ndarray) -> bool:
    """Return whether the pair of multipliers whose product is closest to 1 is complex, not real as at a saddle."""
    one, _ = min(combinations(own, 2), key=lambda pair: abs(pair[0] * pair[1] - 1.0))
    return abs(one.imag) > REAL


#: Tests of the kinds that multipliers determine. Each kind has at most one test per part of the perturbations.
MULTIPLIER_TESTS = (
    MultiplierTest(BifurcationKind.FOLD, lambda own: np.prod(own - 1.0), "symmetry_preserving"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda own: np.prod(own - 1.0), "symmetry_breaking"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda own: np.prod(own + 1.0), "symmetry_preserving", symmetric=True),
    MultiplierTest(BifurcationKind.PERIOD_DOUBLING, lambda own: np.prod(own + 1.0), symmetric=False),
    # The function also vanishes if the product of two real multipliers is 1, which is no bifurcation.
    MultiplierTest(BifurcationKind.NEIMARK_SACKER, lambda own: np.prod(_pairs(own) - 1.0), is_root=_is_complex),
)
