"""How the attractors of two sets are matched; the default is by the distance of their section returns.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151, which matches sets by their distance and remembers those that vanish for a step.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np
from scipy.optimize import linear_sum_assignment
from scipy.spatial import cKDTree

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.continuation.settings import REFINEMENT
from burridge_knopoff.motion.kind import REGULAR, MotionKind
from burridge_knopoff.motion.section_returns import ReturnSection
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import velocity_maxima

#: Distance, for v = 0.1, within which sets at neighbouring values of a parameter belong to one branch. In the paper's
#: study a set that changes smoothly moves by at most 0.007 per step of a, a torus that is locked to one orbit after
#: another by at most 0.036, and coexisting sets are more than 0.04 apart, except orbits that have branched off from one
#: another.
SAME_SET = 0.03

#: Number of returns of a set, evenly chosen, that are compared with another set.
COMPARED_RETURNS = 150


@dataclass(frozen=True, eq=False)
class Outline:
    """The returns of an attractor and of its mirror image, thinned out for comparison with other sets."""

    attractor: Attractor

    @cached_property
    def tree(self) -> cKDTree:
        """All returns, in a tree for nearest neighbours."""
        return cKDTree(self.attractor.motion.returns)

    @cached_property
    def returns(self) -> np.ndarray:
        """An even selection of the returns."""
        return _thin(self.attractor.motion.returns)

    @cached_property
    def mirrored(self) -> np.ndarray:
        """An even selection of the returns of the mirror image."""
        return _thin(self.attractor.motion.mirror_returns)

    @cached_property
    def at_maxima(self) -> Outline:
        """The outline of the same set on the section of motion without stops."""
        motion, model = self.attractor.motion, self.attractor.model
        if motion.section == ReturnSection.MAXIMA:
            return self
        duration = len(motion.returns) / motion.stop_rate[motion.block - 1]
        _, rows = velocity_maxima(model, motion.state(), 0.0, duration)
        returns = rows[rows[:, 0] == motion.block, 2:]
        mirror_returns = returns[:0]
        if len(motion.mirror_returns):
            images = rows[rows[:, 0] == model.blocks + 1 - motion.mirror_block, 2:]
            mirror_returns = images.reshape(-1, 2, model.blocks)[:, :, ::-1].reshape(images.shape)
        motion = replace(motion, returns=returns, mirror_returns=mirror_returns, section=ReturnSection.MAXIMA)
        own_image = self.attractor.symmetry == Symmetry.SYMMETRIC
        return Outline(replace(self.attractor, motion=motion.symmetrized() if own_image else motion))

    def scaled(self, share: float) -> Outline:
        """Return the outline of the same set with all returns multiplied by a factor."""
        motion = self.attractor.motion
        scaled = replace(motion, returns=share * motion.returns, mirror_returns=share * motion.mirror_returns)
        return Outline(replace(self.attractor, motion=scaled))

    def distances(self, other: Outline, bound: float = np.inf) -> np.ndarray:
        """Return the directed distances of the set and of its mirror image from another set, the smaller first.

        The rows, of shape (2, 2), are for the set and its mirror image. bound : larger distances may be infinite

        Sets are in proportion to v under the linearized law, but may hardly depend on v under another. If v differs,
        the other set is compared as it is and in proportion to v, and the smaller distance counts.
        """
        share = self.attractor.model.scale / other.attractor.model.scale
        distances = self._distances(other, bound)
        return distances if share == 1.0 else np.minimum(distances, self._distances(other.scaled(share), bound))

    def _distances(self, other: Outline, bound: float) -> np.ndarray:
        sections = {item.attractor.motion.section for item in (self, other)}
        if sections == {ReturnSection.STOPS, ReturnSection.MAXIMA}:
            return self.at_maxima._distances(other.at_maxima, bound)
        distances = np.full((2, 2), np.inf)
        distances[0] = distance(self.returns, other.tree, bound=bound), distance(other.returns, self.tree, bound=bound)
        if len(self.mirrored) and len(other.mirrored):
            pairs = (self.mirrored, other.tree), (other.mirrored, self.tree)
            distances[1] = [distance(*pair, bound=bound) for pair in pairs]
        return np.sort(distances, axis=1)


def _thin(returns: np.ndarray) -> np.ndarray:
    chosen = np.linspace(0, len(returns) - 1, min(COMPARED_RETURNS, len(returns))) if len(returns) else np.zeros(0)
    return returns[chosen.astype(int)]


def outlines(attractors: Sequence[Attractor]) -> dict[int, Outline]:
    """Return {index: outline} of attractors; the first of a mirror pair represents both."""
    return {index: Outline(attractor) for index, attractor in enumerate(attractors) if attractor.partner >= index}


class Matcher(ABC):
    """How the attractors at one value of a parameter are matched to those at another, mostly a neighbouring value.

    A subclass that defines `match` and `is_unchanged` may replace the default, `DistanceMatcher`. It has to be a
    dataclass if results are cached, since its fields are part of their key.
    """

    @abstractmethod
    def match(self, before: Mapping[int, Outline], after: Mapping[int, Outline]) -> dict[int, int]:
        """Return {key in `after`: key in `before`} of the attractors that match; each matches at most one."""

    @abstractmethod
    def is_unchanged(self, before: Outline, after: Outline) -> bool:
        """Return whether an attractor is of the same type as its match: no bifurcation is searched for in between."""

    def match_unchanged(self, before: Mapping[int, Outline], after: Mapping[int, Outline]) -> dict[int, int]:
        """Return {key in `after`: key in `before`} of the attractors that match and are unchanged."""
        pairs = self.match(before, after)
        return {new: old for new, old in pairs.items() if self.is_unchanged(before[old], after[new])}

    def unmatched(
        self, before: Mapping[int, Outline], after: Mapping[int, Outline]
    ) -> tuple[dict[int, Outline], dict[int, Outline]]:
        """Return the attractors of both sets without an unchanged match in the other."""
        same = self.match_unchanged(before, after)
        return (
            {k: item for k, item in before.items() if k not in same.values()},
            {k: item for k, item in after.items() if k not in same},
        )


@dataclass(frozen=True)
class DistanceMatcher(Matcher):
    """Matches attractors by the distance of their section returns.

    longest_period : longest period of orbits that are followed along a; longer ones count as a torus
    """

    longest_period: float = REFINEMENT.longest_period

    def match(self, before: Mapping[int, Outline], after: Mapping[int, Outline]) -> dict[int, int]:
        """Return {key in `after`: key in `before`} of the sets that match; each matches at most one.

        Synchronized sets match only each other, the nearest if there are several: the motion that replaces synchrony
        where it loses stability is another branch. Uniform sliding matches only itself. Other sets are paired if they
        lie within SAME_SET, such that the sum of the distances of all pairs is smallest.

        A periodic orbit on a torus, or in a window of chaos, lies close to the set while most of the set is far from
        the orbit. The smaller directed distance therefore decides whether two sets may match. If both an orbit and the
        chaos around it continue, the larger directed distance distinguishes them.
        """
        first, second = list(before), list(after)
        # All of a set of attractors are of one model.
        largest = SAME_SET * max((item.attractor.model.scale for item in after.values()), default=1.0)
        cost = np.full((len(second), len(first)), 2.0 * largest)
        for row, column in np.ndindex(cost.shape):
            later, earlier = after[second[row]], before[first[column]]
            synchronized = [item.attractor.symmetry == Symmetry.SYNCHRONIZED for item in (later, earlier)]
            sliding = [item.attractor.motion.section == ReturnSection.SLIDING for item in (later, earlier)]
            if synchronized[0] == synchronized[1] and sliding[0] == sliding[1]:
                lesser, greater = later.distances(earlier, largest).T
                near = lesser + np.minimum(greater, largest)
                cost[row, column] = np.where(lesser < largest, near, 2.0 * largest).min()
            if all(synchronized):
                cost[row, column] -= 4.0 * largest
        pairs = zip(*linear_sum_assignment(cost), strict=True)
        return {second[row]: first[column] for row, column in pairs if cost[row, column] < 2.0 * largest}

    def is_unchanged(self, before: Outline, after: Outline) -> bool:
        """Return whether kind, symmetry and period are the same, and whether there are stops."""
        return self._features(before) == self._features(after)

    def _features(self, outline: Outline) -> tuple[int, int, int, int]:
        """Return kind, symmetry, period and section of a motion, equal for a torus and all orbits that are too long."""
        attractor, motion = outline.attractor, outline.attractor.motion
        if motion.kind in REGULAR and not motion.period <= self.longest_period:
            return MotionKind.QUASIPERIODIC, 0, 0, motion.section
        return motion.kind, attractor.symmetry, motion.section_period, motion.section
