"""The bifurcations that may end or change an attractor as a parameter varies, for orbits, files and figures."""

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
    """Kinds of bifurcations and crises (bifurcations), numbered as in netCDF files.

    grazing : a stick or a slip of a periodic orbit shrinks to nothing or is born
    fold : two orbits meet and vanish, multiplier +1
    period_doubling : the period doubles, multiplier −1
    neimark_sacker : a pair of complex multipliers leaves the unit circle, a torus branches off
    pitchfork : mirror symmetry breaks, multiplier +1 of a symmetry-breaking perturbation
    crisis : an attractor that is not a periodic orbit ends

    words : its name in figures; mark : matplotlib's marker of it there, empty if it is only known to lie in a range

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
    """A kind of bifurcation as a root of a smooth function of the multipliers along a branch of orbits.

    value : returns the function of some multipliers, complex, shape (n,)
    part : of the perturbations whose multipliers it is of: `keeping` the symmetry of the orbit, `breaking` it, or both
    symmetric : whether it is of orbits that are their own mirror image half a period later, of others, or None of all
    is_root : returns whether a root is the bifurcation, from the multipliers there; None if every root is
    """

    kind: BifurcationKind
    value: Callable[[np.ndarray], np.number]
    part: str = "both"
    symmetric: bool | None = None
    is_root: Callable[[np.ndarray], bool] | None = None

    def belongs(self, part: str, symmetry: Symmetry) -> bool:
        """Return whether it is a test of these perturbations of orbits of a symmetry."""
        other = self.symmetric not in (None, symmetry == Symmetry.SYMMETRIC)
        return self.part in ("both", part) and not (part == "keeping" and other)


def _pairs(own: np.ndarray) -> np.ndarray:
    """Return the products of two multipliers each."""
    return np.array([one * other for one, other in combinations(own, 2)])


def _is_complex(own: np.ndarray) -> bool:
    """Return whether the two multipliers whose product is nearest to 1 are complex, not those of a saddle."""
    one, _ = min(combinations(own, 2), key=lambda pair: abs(pair[0] * pair[1] - 1.0))
    return abs(one.imag) > REAL


#: The kinds that multipliers tell. Each has one test in the same part of the perturbations.
MULTIPLIER_TESTS = (
    MultiplierTest(BifurcationKind.FOLD, lambda own: np.prod(own - 1.0), "keeping"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda own: np.prod(own - 1.0), "breaking"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda own: np.prod(own + 1.0), "keeping", symmetric=True),
    MultiplierTest(BifurcationKind.PERIOD_DOUBLING, lambda own: np.prod(own + 1.0), symmetric=False),
    # Also 0 if the product of two real multipliers is 1, at an ordinary saddle.
    MultiplierTest(BifurcationKind.NEIMARK_SACKER, lambda own: np.prod(_pairs(own) - 1.0), is_root=_is_complex),
)
