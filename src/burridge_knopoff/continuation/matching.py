"""Branches: which attractors at neighbouring values of a are one, by the distance of sets.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151, which matches sets by their distance and remembers those that vanish for a step.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from itertools import pairwise

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED
from burridge_knopoff.motion.kind import REGULAR, MotionKind
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.motion.tuning import TUNING, Tuning
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


@dataclass(frozen=True, eq=False)
class Outline:
    """The returns of an attractor, thinned out, and those of its mirror image, as sets that can be compared.

    attractor : see `Attractor`; points : how many returns are compared with another set
    """

    attractor: Attractor
    points: int

    @cached_property
    def tree(self) -> cKDTree:
        """All returns, for the search of neighbours."""
        return cKDTree(self.attractor.motion.returns)

    @cached_property
    def own(self) -> np.ndarray:
        """Some returns, spread evenly over all."""
        return _thinned(self.attractor.motion.returns, self.points)

    @cached_property
    def mirrored(self) -> np.ndarray:
        """The same of the mirror image."""
        return _thinned(self.attractor.motion.mirror_returns, self.points)

    def distances(self, other: Outline, share: float, bound: float = np.inf) -> np.ndarray:
        """Return how far the set, and its mirror image, is from another: both directed distances, the lesser first.

        Shape (2, 2); share : of the returns that must lie near the other set
        bound : what is farther may be given as infinitely far
        """
        found = np.full((2, 2), np.inf)
        found[0] = distance(self.own, other.tree, share, bound), distance(other.own, self.tree, share, bound)
        if len(self.mirrored) and len(other.mirrored):
            pairs = (self.mirrored, other.tree), (other.mirrored, self.tree)
            found[1] = [distance(*pair, share, bound) for pair in pairs]
        return np.sort(found, axis=1)


def _thinned(returns: np.ndarray, points: int) -> np.ndarray:
    chosen = np.linspace(0, len(returns) - 1, min(points, len(returns))) if len(returns) else np.zeros(0)
    return returns[chosen.astype(int)]


def outlines(attractors: Sequence[Attractor], tuning: Tuning = TUNING) -> dict[int, Outline]:
    """Return the outlines of attractors by their index; of a mirror pair the first stands for both."""
    return {
        index: Outline(attractor, tuning.compared_returns)
        for index, attractor in enumerate(attractors)
        if attractor.partner >= index
    }


def matched(
    before: Mapping[int, Outline], after: Mapping[int, Outline], scale: float, tuning: Tuning = TUNING
) -> dict[int, int]:
    """Return {key in `after`: key in `before`} of the sets that are one: each has one at most.

    Synchronized sets match each other, the nearest if there are several, and nothing else: what synchrony turns into
    where it loses its stability is another branch. Of all others those are paired that lie within `same_set` (times the
    scale of the model), so that the distances of all pairs are least in sum.

    An orbit that lies on a torus, or a window in the midst of chaos, is near it although most of that is not near the
    orbit: so the lesser directed distance tells what may follow what along a. Where an orbit and the chaos around it
    both go on, the greater one as well tells which is which.
    """
    first, second = list(before), list(after)
    largest = tuning.same_set * scale
    cost = np.full((len(second), len(first)), 2.0 * largest)
    for row, column in np.ndindex(cost.shape):
        one, other = after[second[row]], before[first[column]]
        synchronized = [item.attractor.symmetry == Symmetry.SYNCHRONIZED for item in (one, other)]
        if synchronized[0] == synchronized[1]:
            lesser, greater = one.distances(other, tuning.near_share, largest).T
            near = lesser + np.minimum(greater, largest)
            cost[row, column] = np.where(lesser < largest, near, 2.0 * largest).min()
        if all(synchronized):
            cost[row, column] -= 4.0 * largest
    pairs = zip(*linear_sum_assignment(cost), strict=True)
    return {second[row]: first[column] for row, column in pairs if cost[row, column] < 2.0 * largest}


def unchanged(
    before: Mapping[int, Outline], after: Mapping[int, Outline], scale: float, tuning: Tuning = TUNING
) -> dict[int, int]:
    """Return {key in `after`: key in `before`} of the sets that are one, and of one kind, symmetry and period."""
    found = matched(before, after, scale, tuning)
    longest = tuning.longest_followed
    return {new: old for new, old in found.items() if _features(before[old], longest) == _features(after[new], longest)}


def differing(
    before: Mapping[int, Outline], after: Mapping[int, Outline], scale: float, tuning: Tuning = TUNING
) -> tuple[dict[int, Outline], dict[int, Outline]]:
    """Return those of both sets that have no counterpart in the other, or one of another kind, symmetry or period."""
    same = unchanged(before, after, scale, tuning)
    return (
        {k: item for k, item in before.items() if k not in same.values()},
        {k: item for k, item in after.items() if k not in same},
    )


def _features(outline: Outline, longest: float) -> tuple[int, int, int]:
    """Return kind, symmetry and section points of a motion; one for a torus and all orbits longer than `longest`."""
    attractor, motion = outline.attractor, outline.attractor.motion
    if motion.kind in REGULAR and not motion.period <= longest:
        return MotionKind.QUASIPERIODIC, 0, 0
    return motion.kind, attractor.symmetry, motion.section_period


def branches(
    a: Sequence[float],
    attractors: Sequence[Sequence[Attractor]],
    grid: Sequence[int],
    reach: float,
    scale: float,
    tuning: Tuning = TUNING,
) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return the branch and the side of each attractor at each a.

    a : ascending; grid : where in it all attractors are known: in between are those only that change from one of these
        values to the next
    reach : for how far in a an attractor that has vanished is remembered; scale : of the model, see `Model.scale`

    The two of a mirror pair share a branch and lie on its sides 1 and −1; attractors that are their own mirror images
    have side 0. Branch 0 is the synchronized attractor, the first one found if there are several; the others are
    numbered from 1 in the order of their first a, and of ⟨J⟩ there.
    """
    branch_of: list[np.ndarray] = []
    side_of: list[np.ndarray] = []
    seen: dict[int, tuple[float, Outline, int]] = {}
    shown = [outlines(here, tuning) for here in attractors]
    next_in_grid = dict(pairwise(grid))
    held: dict[int, int] = {}
    following = 1
    for place, (value, here, now) in enumerate(zip(a, attractors, shown, strict=True)):
        kept = {n: seen[n][1] for n in held.values()}
        found = dict(held) if place in grid else unchanged(kept, now, scale, tuning)
        near = {n: item for n, item in seen.items() if item[0] >= value - reach and n not in held.values()}
        last = max((where for where, *_ in near.values()), default=value)
        for recent in (True, False):
            old = {n: item for n, (where, item, _) in near.items() if (where == last) == recent}
            old = {n: item for n, item in old.items() if n not in found.values()}
            found |= matched(old, {i: item for i, item in now.items() if i not in found}, scale, tuning)
        branch, side = np.full(len(here), UNDETERMINED), np.zeros(len(here), dtype=int)
        for i in sorted(now, key=lambda i: (round(here[i].motion.mean_distance, 6), i)):
            if i in found:
                branch[i] = found[i]
            elif here[i].symmetry == Symmetry.SYNCHRONIZED and 0 not in (*found.values(), *branch):
                branch[i] = 0
            else:
                branch[i] = following
                following += 1
            number, partner = int(branch[i]), here[i].partner
            if partner != i:
                side[i] = _side(now[i], seen.get(number), tuning)
                branch[partner], side[partner] = number, -side[i]
            seen[number] = (value, now[i], int(side[i]))
        if place in next_in_grid:
            # What does not change up to the next value of the grid is hardly looked at in between, and leaves its
            # number to no other set there.
            same = unchanged(now, shown[next_in_grid[place]], scale, tuning)
            held = {new: int(branch[old]) for new, old in same.items()}
        branch_of.append(branch)
        side_of.append(side)
    return branch_of, side_of


def _side(outline: Outline, before: tuple[float, Outline, int] | None, tuning: Tuning) -> int:
    """Return the side of the first of a mirror pair: that of the nearer one of the pair before it, if there is one."""
    if before is None or before[2] == 0:
        return _orientation(outline.attractor)
    own, mirrored = outline.distances(before[1], tuning.near_share)[:, 0]
    return before[2] if own <= mirrored else -before[2]


def _orientation(attractor: Attractor) -> int:
    """Return 1 where the first block, at the returns, is ahead of the last one by more than in the mirrored motion."""
    last = len(attractor.motion.stop_rate) - 1
    own, mirrored = attractor.motion.returns, attractor.motion.mirror_returns
    return 1 if np.mean(own[:, 0] - own[:, last]) > np.mean(mirrored[:, 0] - mirrored[:, last]) else -1
