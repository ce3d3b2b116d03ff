"""Bifurcations along a branch of periodic orbits: grazing, fold, period doubling, Neimark-Sacker, pitchfork, Hopf.

Grazings are corners of the branch, which `following` reaches. Every other kind is a change of sign, between two orbits,
of a function of the multipliers, whose root along the branch is found with additional orbits. The test function of a
fold also changes sign where a branch joins a branch of simpler orbits: less symmetric orbits begin as symmetric orbits,
and orbits of twice the period as orbits of the single period. Orbits without stops begin at a Hopf bifurcation of
uniform sliding, which has a closed form. On the branch that begins, a pitchfork and a period
doubling are distinguished from a fold by this simpler orbit.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Sections 5.3 and 10.2.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from scipy.optimize import brentq

from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.critical_values import MULTIPLIER_TESTS, critical_values
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import CONTINUATION, follow
from burridge_knopoff.periodic_orbits.hopf import hopf_bifurcations
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, orbit_of
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit, step_along
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import is_sliding, sliding_state
from burridge_knopoff.values import each_instance_of

# Accuracy in length along a branch to which roots are found, and half-widths of their brackets, to be tried in turn.
TOLERANCE = 1e-14
BRACKETS = (1e-11, 1e-10, 1e-9, 1e-8, 1e-7)

# Rounding error of a parameter of about 1; smaller errors are not reported.
ROUNDING = 1e-12

# Range, in steps, in which the branch point is searched for around the point where a branch has joined another one.
BRANCH_POINT_RANGE = 2.0
# Least length of the largest step there, as a fraction of the range.
CROSSING = 0.01

# At a grazing a stick this short, in the chain's own unit, is the one whose duration vanishes, as a square root.
NO_STICK = 1e-4

# Distance, for v = 0.1 in the chain's own units, within which an orbit at a root counts as more symmetric or of a
# shorter period; near a root this distance varies as a square root.
REDUCTION_DISTANCE = 1e-4


@dataclass(frozen=True, eq=False)
class Bifurcation:
    """A bifurcation on a branch of periodic orbits.

    value, error : parameter along which the branch was continued, and half the width of its bracket
    at : the orbit at the bifurcation; if the branch joins a branch of simpler orbits there, the simpler orbit
    before, after : orbits on the branch on either side, in the direction away from the start of the following; `after`
        is None if the branch ends or joins a branch of simpler orbits
    is_turning_point : whether the branch turns back in the parameter there

    >>> from burridge_knopoff import Model, follow, limit_cycle, locate_bifurcations, synchronized_orbit
    >>> model = Model("linearized", a=0.0865)
    >>> orbit = limit_cycle(model, synchronized_orbit(model).reference)
    >>> branch = follow(orbit, (0.086, 0.0875), parameter="a")
    >>> (bifurcation,) = locate_bifurcations(branch)
    >>> bifurcation.kind.name, bifurcation.loses_stability, bifurcation.error < 1e-9
    ('PITCHFORK', True, True)
    """

    value: float
    error: float
    kind: BifurcationKind
    at: BranchOrbit
    before: BranchOrbit
    after: BranchOrbit | None
    is_turning_point: bool

    def __repr__(self) -> str:
        at = f"{self.parameter} = {self.value:.12g} +- {self.error:.1g}"
        return f"<Bifurcation: {self.kind.name.lower()} at {at}, period {self.period:.9g}>"

    @property
    def parameter(self) -> str:
        """The parameter along which the branch was continued."""
        return self.before.line.parameter

    @property
    def a(self) -> float:
        """Friction parameter."""
        return self.value if self.parameter == "a" else self.at.orbit.a

    @property
    def period(self) -> float:
        """Period of the orbits on the branch: on the doubled branch at a period doubling, twice that of `at`."""
        return round(self.before.orbit.period / self.at.orbit.period) * self.at.orbit.period

    @property
    def mean_distance(self) -> float:
        """⟨J⟩ over a period of the orbit at the bifurcation."""
        return self.at.orbit.mean_distance

    @property
    def stick_time(self) -> float:
        """Shortest stick of the orbit at the bifurcation; 0 if its duration vanishes, NaN if no block sticks."""
        shortest = float(self.at.grazing_distances.stick.min())
        none = NO_STICK * self.at.orbit.model.chain.own_units.time
        if self.kind == BifurcationKind.GRAZING and not none <= shortest < math.inf:
            return 0.0
        return shortest if shortest < math.inf else math.nan

    @property
    def loses_stability(self) -> bool:
        """Whether the orbits before are stable and those after are unstable or do not exist."""
        return self.before.multipliers.unstable_count == 0 and not self.keeps_stability

    @property
    def keeps_stability(self) -> bool:
        """Whether the orbits on both sides are stable."""
        sides = (self.before, self.after)
        return all(point is not None and point.multipliers.unstable_count == 0 for point in sides)


def locate_bifurcations(branch: Sequence[BranchOrbit]) -> Iterator[Bifurcation]:
    """Yield the bifurcations along a branch in order, each computed on demand; `Branch.bifurcations` keeps them.

    branch : as `follow` returns it, or its orbits; raises ValueError, one line, for anything else

    Source: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Sections 5.3 and 10.2;
    docs/bifurcations.md explains how the kinds are distinguished.

    >>> from burridge_knopoff import Model, follow, limit_cycle, locate_bifurcations, synchronized_orbit
    >>> model = Model("linearized", a=0.0865)
    >>> orbit = limit_cycle(model, synchronized_orbit(model).reference)
    >>> branch = follow(orbit, (0.086, 0.0875), parameter="a")
    >>> (bifurcation,) = locate_bifurcations(branch)
    >>> bifurcation.kind.name, round(bifurcation.a, 9)
    ('PITCHFORK', 0.086972905)
    """
    return _bifurcations(each_instance_of(branch, BranchOrbit, "branch"))


def _bifurcations(branch: Sequence[BranchOrbit]) -> Iterator[Bifurcation]:
    # Orbits before the start, which alone is at no distance from another one, were followed in the other direction.
    begun = next((k for k, point in enumerate(branch) if point.length == 0.0), 0)
    if begun:
        first = replace(branch[begun], tangent=-branch[begun].tangent)
        backward = [first, *branch[begun - 1 :: -1]]
        for k in range(begun, -1, -1):
            yield from _bifurcations_next(backward, k)[::-1]
    for k in range(begun, len(branch)):
        yield from _bifurcations_next(branch, k)


def _bifurcations_next(branch: Sequence[BranchOrbit], k: int) -> list[Bifurcation]:
    """Return the bifurcations from an orbit of a branch up to the next one."""
    point, following = branch[k], branch[k + 1] if k + 1 < len(branch) else None
    if point.is_grazing:
        return [_grazing(point, following)]
    if following is None:
        return []
    return _roots(point, following) if following.reduced_orbit is None else _branch_points(point, following)


def _grazing(point: BranchOrbit, following: BranchOrbit | None) -> Bifurcation:
    """Return the grazing at a corner; the error of the parameter is the remaining length to the corner."""
    left = point.distance_to_grazing * float(point.tangent[-1]) * point.line.rates[0]
    is_turning_point = following is not None and point.tangent[-1] * following.tangent[-1] < 0.0
    return Bifurcation(
        point.value + left, max(abs(left), ROUNDING), BifurcationKind.GRAZING, point, point, following, is_turning_point
    )


def _roots(first: BranchOrbit, second: BranchOrbit) -> list[Bifurcation]:
    """Return the bifurcations between two neighbouring orbits with the same stops, sorted along the branch."""
    signs = [critical_values(point.orbit, point.multipliers) for point in (first, second)]
    roots: list[tuple[float, Bifurcation]] = []
    for key in signs[0].keys() & signs[1].keys():
        if (signs[0][key] > 0.0) != (signs[1][key] > 0.0):
            root = _root(first, second, key)
            if root is not None:
                roots.append(root)
    return [bifurcation for _, bifurcation in sorted(roots, key=lambda item: item[0])]


def _root(
    first: BranchOrbit, second: BranchOrbit, key: tuple[BifurcationKind, str]
) -> tuple[float, Bifurcation] | None:
    """Return the root of a function between two orbits as a length from the first, and the bifurcation there."""
    points: dict[float, BranchOrbit] = {0.0: first, second.length: second}

    def value(length: float) -> float:
        if length not in points:
            points[length] = step_along(first, length)
        point = points[length]
        return critical_values(point.orbit, point.multipliers)[key]

    try:
        root = float(brentq(value, 0.0, max(points), xtol=TOLERANCE, rtol=1e-12))
        value(root)
        at = points[root]
        for side in BRACKETS:
            if value(root - side) * value(root + side) < 0.0:
                break
        else:
            return None
    except OrbitError:
        return None
    low, high = points[root - side], points[root + side]
    kind = kind_at(at, key)
    is_turning_point = first.tangent[-1] * second.tangent[-1] < 0.0
    # If a symmetry other than the mirror symmetry breaks, such as that of a ring, a multiplier is +1 without a fold.
    if kind is None or (kind == BifurcationKind.FOLD and not is_turning_point):
        return None
    error = max(0.5 * abs(high.value - low.value), abs(at.value - low.value), ROUNDING)
    return root, Bifurcation(at.value, error, kind, at, first, second, is_turning_point)


def _branch_points(point: BranchOrbit, following: BranchOrbit) -> list[Bifurcation]:
    """Return the bifurcation at which a branch has joined a branch of simpler orbits, located along the latter."""
    simple = following.reduced_orbit
    if simple is None:
        return []
    lengths = point.line.rates[0] * (point.length + following.length)
    reach = BRANCH_POINT_RANGE * abs(following.value - point.value) + lengths
    around = following.value - reach, following.value + reach
    if is_sliding(simple.model, simple.reference):
        return _hopf_point(point, around)
    kind = _branch_point_kind(point.orbit, simple)
    # Steps are large enough to cross the range.
    step = max(CONTINUATION.largest_step, CROSSING * reach / point.line.rates[0])
    settings = replace(CONTINUATION, largest_step=step)
    candidates = []
    for upward in (True, False):
        candidates += [
            bifurcation
            for bifurcation in locate_bifurcations(
                follow(simple, around, settings, parameter=point.line.parameter, upward=upward)
            )
            if bifurcation.kind == kind
        ]
    if not candidates:
        return []
    bifurcation = min(candidates, key=lambda bifurcation: abs(bifurcation.value - following.value))
    return [Bifurcation(bifurcation.value, bifurcation.error, bifurcation.kind, bifurcation.at, point, None, False)]


def _hopf_point(point: BranchOrbit, around: tuple[float, float]) -> list[Bifurcation]:
    """Return the Hopf bifurcation within a range of the parameter at which the orbits of a branch end."""
    orbit, line = point.orbit, point.line
    ends = hopf_bifurcations(orbit.model, around, parameter=line.parameter)
    if not ends:
        return []
    end = min(ends, key=lambda end: abs(end.period - orbit.period))
    return_time = end.period * orbit.return_time / orbit.period
    sliding = orbit_of(end.model, sliding_state(end.model), return_time, orbit.symmetry)
    at = BranchOrbit(sliding, point.tangent, line)
    return [Bifurcation(end.value, ROUNDING, BifurcationKind.HOPF, at, point, None, False)]


def kind_at(at: BranchOrbit, key: tuple[BifurcationKind, str]) -> BifurcationKind | None:
    """Return the kind of bifurcation at the root of a test function; None if it is no bifurcation."""
    kind, part = key
    for test in MULTIPLIER_TESTS:
        if test.kind == kind and test.is_root and not test.is_root(getattr(at.multipliers, part)):
            return None
    if kind == BifurcationKind.FOLD and at.orbit.symmetry != Symmetry.SYNCHRONIZED:
        return _branch_point_kind(at.orbit, minimal_form(at.orbit, REDUCTION_DISTANCE)) or kind
    return kind


def _branch_point_kind(orbit: PeriodicOrbit, simple: PeriodicOrbit) -> BifurcationKind | None:
    """Return the kind of bifurcation at which orbits branch off simpler ones; None if these are not simpler."""
    # A period doubling may break the mirror symmetry as well.
    if simple.period < 0.75 * orbit.period:
        return BifurcationKind.PERIOD_DOUBLING
    return BifurcationKind.PITCHFORK if simple.symmetry != orbit.symmetry else None
