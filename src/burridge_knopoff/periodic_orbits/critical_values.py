"""Test functions of bifurcations: functions of the multipliers of an orbit that change sign there."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from itertools import combinations

import numpy as np

from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.floquet import Multipliers, multipliers
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

#: Multipliers are real if their imaginary part is below this.
REAL = 1e-6


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


def _pairs(mu: np.ndarray) -> np.ndarray:
    """Return the products of all pairs of multipliers."""
    return np.array([one * other for one, other in combinations(mu, 2)])


def _is_complex(mu: np.ndarray) -> bool:
    """Return whether the pair of multipliers whose product is closest to 1 is complex, not real as at a saddle."""
    first, _ = min(combinations(mu, 2), key=lambda pair: abs(pair[0] * pair[1] - 1.0))
    return abs(first.imag) > REAL


#: Tests of the kinds that multipliers determine. Each kind has at most one test per part of the perturbations.
MULTIPLIER_TESTS = (
    MultiplierTest(BifurcationKind.FOLD, lambda mu: np.prod(mu - 1.0), "symmetry_preserving"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda mu: np.prod(mu - 1.0), "symmetry_breaking"),
    MultiplierTest(BifurcationKind.PITCHFORK, lambda mu: np.prod(mu + 1.0), "symmetry_preserving", symmetric=True),
    MultiplierTest(BifurcationKind.PERIOD_DOUBLING, lambda mu: np.prod(mu + 1.0), symmetric=False),
    # The function also vanishes if the product of two real multipliers is 1, which is no bifurcation.
    MultiplierTest(BifurcationKind.NEIMARK_SACKER, lambda mu: np.prod(_pairs(mu) - 1.0), is_root=_is_complex),
)


def critical_values(
    orbit: PeriodicOrbit, spectrum: Multipliers | None = None
) -> dict[tuple[BifurcationKind, str], float]:
    """Return the values of the test functions, {(kind of bifurcation, part of the perturbations): value}.

    Each is a smooth function that changes sign at the bifurcation, such as the product of all μ − 1; see
    MULTIPLIER_TESTS.
    """
    spectrum = multipliers(orbit) if spectrum is None else spectrum
    return {
        (test.kind, part): float(test.value(mu).real)
        for part, mu in (
            ("symmetry_preserving", spectrum.symmetry_preserving),
            ("symmetry_breaking", spectrum.symmetry_breaking),
        )
        if len(mu)
        for test in MULTIPLIER_TESTS
        if test.is_applicable(part, orbit.symmetry)
    }
