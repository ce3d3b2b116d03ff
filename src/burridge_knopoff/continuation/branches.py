"""Branches: numbers of attractors along a, matched between values of a; vanished branches are remembered.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from itertools import pairwise
from typing import NamedTuple

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.continuation.matching import Matcher, Outline, outlines
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

#: Number of steps of the grid for which a vanished branch is remembered. It gets its number back after a window of
#: another motion.
REMEMBERED = 2.0


class KnownBranch(NamedTuple):
    """The last point of a branch: the value of a, the attractor there, and its side."""

    a: float
    outline: Outline
    side: int


def branches(
    a: Sequence[float], attractors: Sequence[Sequence[Attractor]], grid: Sequence[int], reach: float, matcher: Matcher
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return the branch and the side of each attractor at each a.

    a : ascending
    grid : indices of the values at which all attractors are known; at the others only those are that change
    reach : range of a over which a vanished branch is remembered

    The two of a mirror pair share a branch and lie on its sides 1 and −1; attractors that are their own mirror images
    have side 0. Branch 0 is the synchronized attractor, the first one found if there are several; the others are
    numbered from 1 in the order of their first a, and of ⟨J⟩ there.
    """
    numbering = _Numbering(matcher, reach)
    outline_maps = [outlines(row) for row in attractors]
    following = dict(pairwise(grid))
    # Attractors that do not change up to the next value of the grid are mostly not followed in between. Their numbers
    # are reserved: {index at the next value of the grid: number}.
    held: dict[int, int] = {}
    numbers = []
    for place, (value, row, now) in enumerate(zip(a, attractors, outline_maps, strict=True)):
        branch, side = numbering.numbered(value, row, now, numbering.matches(value, now, held, place in grid))
        if place in following:
            same = matcher.match_unchanged(now, outline_maps[following[place]])
            held = {new: int(branch[old]) for new, old in same.items()}
        numbers.append((branch, side))
    return [branch for branch, _ in numbers], [side for _, side in numbers]


@dataclass
class _Numbering:
    """The numbers assigned so far: the last point of each branch, and the next number."""

    matcher: Matcher
    reach: float
    seen: dict[int, KnownBranch] = field(default_factory=dict)
    following: int = 1

    def matches(self, a: float, now: Mapping[int, Outline], held: Mapping[int, int], on_grid: bool) -> dict[int, int]:
        """Return {index of an attractor at a: number of the branch that it continues}.

        Branches that exist at the previous value of a are matched first, then those that vanished earlier.
        """
        if on_grid:
            numbers = dict(held)
        else:
            numbers = self.matcher.match_unchanged({number: self.seen[number].outline for number in held.values()}, now)
        near = {
            number: item
            for number, item in self.seen.items()
            if item.a >= a - self.reach and number not in held.values()
        }
        last = max((item.a for item in near.values()), default=a)
        for recent in (True, False):
            old = {
                n: item.outline for n, item in near.items() if (item.a == last) == recent and n not in numbers.values()
            }
            numbers |= self.matcher.match(old, {i: item for i, item in now.items() if i not in numbers})
        return numbers

    def numbered(
        self, a: float, attractors: Sequence[Attractor], now: Mapping[int, Outline], numbers: Mapping[int, int]
    ) -> tuple[np.ndarray, np.ndarray]:
        """Return the branch and the side of each attractor at a, with new numbers for those that continue no branch."""
        branch, side = np.full(len(attractors), UNDETERMINED), np.zeros(len(attractors), dtype=int)
        for i in sorted(now, key=lambda i: (round(attractors[i].motion.mean_distance, 6), i)):
            number = numbers.get(i)
            if number is None:
                synchronized = attractors[i].symmetry == Symmetry.SYNCHRONIZED
                number = 0 if synchronized and 0 not in (*numbers.values(), *branch) else self.following
                self.following += number != 0
            branch[i], partner = number, attractors[i].partner
            if partner != i:
                side[i] = _side(now[i], self.seen.get(number))
                branch[partner], side[partner] = number, -side[i]
            self.seen[number] = KnownBranch(a, now[i], int(side[i]))
        return branch, side


def _side(outline: Outline, before: KnownBranch | None) -> int:
    """Return the side of the first of a mirror pair: that of the nearer one of the previous pair, if there is one."""
    if before is None or before.side == 0:
        return _orientation(outline.attractor)
    direct, mirrored = outline.distances(before.outline)[:, 0]
    return before.side if direct <= mirrored else -before.side


def _orientation(attractor: Attractor) -> int:
    """Return 1 if the first block leads the last one, at the returns, by more than in the mirrored motion, else −1."""
    last = len(attractor.motion.stop_rate) - 1
    returns, mirrored = attractor.motion.returns, attractor.motion.mirror_returns
    return 1 if np.mean(returns[:, 0] - returns[:, last]) > np.mean(mirrored[:, 0] - mirrored[:, last]) else -1
