"""A branch segment of stable periodic orbits, continued in both directions of a to the bifurcations at its ends."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.following import CONTINUATION, ContinuationSettings, follow
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit

# Difference of ⟨J⟩, for v = 0.1, within which an orbit between two neighbours on a branch may belong to the branch.
MEAN_TOLERANCE = 1e-3

# Orbits closer than this to the previous one along a branch are not drawn.
CLOSE = 1e-5


@dataclass(frozen=True, eq=False)
class HalfBranch:
    """Orbits of one branch, continued from a stable orbit in one direction of a.

    orbits : in the order of the continuation
    """

    orbits: Sequence[BranchOrbit]

    @cached_property
    def bifurcations(self) -> list[Bifurcation]:
        """Bifurcations that the stable orbits pass, and the one at which they end if it was reached."""
        bifurcations = []
        for bifurcation in locate_bifurcations(self.orbits):
            bifurcations.append(bifurcation)
            if bifurcation.loses_stability:
                break
        return bifurcations

    @cached_property
    def end(self) -> Bifurcation | None:
        """The bifurcation at which the stable orbits end; None if it was not reached."""
        return self.bifurcations[-1] if self.bifurcations and self.bifurcations[-1].loses_stability else None

    @property
    def drawn_orbits(self) -> list[BranchOrbit]:
        """All orbits except those very close to the previous one, near a grazing."""
        return [point for point in self.orbits if point.is_grazing or not 0.0 < point.length < CLOSE]


@dataclass(frozen=True, eq=False)
class BranchSegment:
    """A segment of a branch around a stable orbit.

    downward, upward : orbits continued from it with a decreasing, and increasing, at first
    """

    downward: HalfBranch
    upward: HalfBranch

    @cached_property
    def stable_orbits(self) -> list[BranchOrbit]:
        """The stable orbits, in ascending order of a."""
        low = self.downward.end.a if self.downward.end else -np.inf
        high = self.upward.end.a if self.upward.end else np.inf
        both = (*self.downward.orbits[:0:-1], *self.upward.orbits)
        points = [point for point in both if point.multipliers.unstable_count == 0 and low <= point.orbit.a <= high]
        return sorted(points, key=lambda point: point.orbit.a)

    @property
    def drawn_orbits(self) -> list[BranchOrbit]:
        """All orbits from one end to the other, except those very close to the previous one, near a grazing."""
        return [*self.downward.drawn_orbits[:0:-1], *self.upward.drawn_orbits]

    def contains(self, orbit: PeriodicOrbit, tolerance: float) -> bool:
        """Return whether an orbit is one of the stable orbits, judged by a, stops, symmetry, period and ⟨J⟩.

        tolerance : largest relative difference from the interpolated period
        """
        a, period = self._stable_periods
        if not len(a):
            return False
        low = self.downward.end.a if self.downward.end else a[0]
        high = self.upward.end.a if self.upward.end else a[-1]
        if not low <= orbit.a <= high:
            return False
        above = int(np.clip(np.searchsorted(a, orbit.a), 1, len(a) - 1)) if len(a) > 1 else 0
        near = [self.stable_orbits[k].orbit for k in {max(above - 1, 0), above}]
        if not any(other.stop_counts in (orbit.stop_counts, orbit.stop_counts[::-1]) for other in near):
            return False
        if orbit.symmetry not in {other.symmetry for other in near}:
            return False
        expected = float(np.interp(orbit.a, a, period))
        if abs(orbit.period - expected) > tolerance * expected:
            return False
        # Near a grazing ⟨J⟩ changes as a square root.
        means = [other.mean_distance for other in near]
        margin = max(means) - min(means) + MEAN_TOLERANCE * orbit.model.scale
        return min(means) - margin <= orbit.mean_distance <= max(means) + margin

    @cached_property
    def _stable_periods(self) -> tuple[np.ndarray, np.ndarray]:
        """The values of a and the periods of the stable orbits."""
        orbits = [point.orbit for point in self.stable_orbits]
        return np.array([orbit.a for orbit in orbits]), np.array([orbit.period for orbit in orbits])


def follow_half_branch(
    orbit: PeriodicOrbit,
    upward: bool,
    a_range: tuple[float, float],
    beyond: int,
    settings: ContinuationSettings = CONTINUATION,
) -> HalfBranch:
    """Continue a stable orbit one way until a leaves a range, or until some orbits beyond the first unstable one.

    beyond : number of orbits after the first unstable one

    Raises OrbitError if the continuation cannot start.
    """
    return HalfBranch(
        follow(orbit, a_range, settings, upward=upward, is_complete=_stop_after_unstable(beyond), parameter="a")
    )


def _stop_after_unstable(beyond: int) -> Callable[[list[BranchOrbit]], bool]:
    """Return a predicate: whether there are `beyond` orbits after the first unstable one."""
    first = 0

    def is_complete(points: list[BranchOrbit]) -> bool:
        nonlocal first
        if first == 0 and points[-1].multipliers.unstable_count > 0:
            first = len(points)
        return first > 0 and len(points) - first >= beyond

    return is_complete
