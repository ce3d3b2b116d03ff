"""A stretch of stable periodic orbits: followed in the friction parameter a both ways to the edges where it ends."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from dataclasses import dataclass
from functools import cached_property

import numpy as np

from burridge_knopoff.orbits.edges import Edge, locate_edges
from burridge_knopoff.orbits.following import FOLLOWING, Following, follow
from burridge_knopoff.orbits.orbit import OrbitError
from burridge_knopoff.orbits.periodic import PeriodicOrbit
from burridge_knopoff.orbits.pseudo_arclength import BranchOrbit

# Orbits closer than this along a branch are not kept apart.
CLOSE = 1e-5


@dataclass(frozen=True, eq=False)
class Stretch:
    """Orbits of one branch around a stable one.

    downward, upward : orbits followed from it with a falling, and growing, at first
    """

    downward: Sequence[BranchOrbit]
    upward: Sequence[BranchOrbit]

    @cached_property
    def low_edges(self) -> list[Edge]:
        """Edges met going down: those that the stable orbits pass, and the one at which they end, if it is met."""
        return _until_lost(locate_edges(self.downward))

    @cached_property
    def high_edges(self) -> list[Edge]:
        """Edges met going up."""
        return _until_lost(locate_edges(self.upward))

    @property
    def low_end(self) -> Edge | None:
        """The edge at which the stable orbits end, going down; None if none is met."""
        return _end(self.low_edges)

    @property
    def high_end(self) -> Edge | None:
        """The edge at which the stable orbits end, going up; None if none is met."""
        return _end(self.high_edges)

    @cached_property
    def stable(self) -> list[BranchOrbit]:
        """The stable orbits, a ascending."""
        found = [
            point for points in (self.downward[:0:-1], self.upward) for point in points if _is_between(self, point)
        ]
        return sorted(found, key=lambda point: point.orbit.a)

    @property
    def shown(self) -> list[BranchOrbit]:
        """All orbits from one end to the other, but for those on the way to a corner."""
        both = (*self.downward[:0:-1], *self.upward)
        return [point for point in both if point.corner or not 0.0 < point.length < CLOSE]

    def holds(self, orbit: PeriodicOrbit, tolerance: float) -> bool:
        """Tell whether an orbit is one of the stable ones: by its a, its stops, and its period within a share of it."""
        stable = self.stable
        if not stable:
            return False
        a = np.array([point.orbit.a for point in stable])
        low = self.low_end.a if self.low_end else a[0]
        high = self.high_end.a if self.high_end else a[-1]
        if not low <= orbit.a <= high:
            return False
        above = int(np.clip(np.searchsorted(a, orbit.a), 1, len(a) - 1)) if len(a) > 1 else 0
        near = [stable[k].orbit.signature for k in {max(above - 1, 0), above}]
        if not {orbit.signature, orbit.signature[::-1]} & set(near):
            return False
        period = float(np.interp(orbit.a, a, [point.orbit.period for point in stable]))
        return abs(orbit.period - period) <= tolerance * period


def stretch(
    orbit: PeriodicOrbit, a_range: tuple[float, float], beyond: int, settings: Following = FOLLOWING
) -> Stretch:
    """Follow a stable orbit both ways until so many orbits beyond an edge are unstable, or a leaves a range.

    Raises OrbitError if it cannot be followed at all.
    """
    if a_range[0] > orbit.a or a_range[1] < orbit.a:
        raise OrbitError(f"a = {orbit.a!r}: not within the range {a_range[0]!r} to {a_range[1]!r}")
    both = [follow(orbit, a_range, settings, upward=upward, enough=_enough(beyond)) for upward in (False, True)]
    return Stretch(*both)


def _enough(beyond: int) -> Callable[[list[BranchOrbit]], bool]:
    """Return what tells that so many orbits have passed since the first unstable one."""
    first = 0

    def enough(points: list[BranchOrbit]) -> bool:
        nonlocal first
        if first == 0 and points[-1].multipliers.unstable > 0:
            first = len(points)
        return first > 0 and len(points) - first >= beyond

    return enough


def _until_lost(edges: Iterator[Edge]) -> list[Edge]:
    """Return the edges up to the first at which stability is lost."""
    found = []
    for edge in edges:
        found.append(edge)
        if edge.loses_stability:
            break
    return found


def _end(edges: list[Edge]) -> Edge | None:
    return edges[-1] if edges and edges[-1].loses_stability else None


def _is_between(whole: Stretch, point: BranchOrbit) -> bool:
    low = whole.low_end.a if whole.low_end else -np.inf
    high = whole.high_end.a if whole.high_end else np.inf
    return point.multipliers.unstable == 0 and low <= point.orbit.a <= high
