"""How near an attractor a trajectory is certain to stay: the radius, within which trajectories are captured.

It is less than half the way to any other attractor, and trajectories that were perturbed by that much at random have
come back. The returns of a set of many dimensions are few and far between: its radius is as wide as they need.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, perturbed
from burridge_knopoff.attractors.labels import label, moved
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.slow_set import SLOW_TIME
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.set_distance import SPACINGS, minimum_distance

#: Least radius of an attractor, 1 % of the default resolution, for v = 0.1: what comes back only from nearer belongs to
#: a set that attracts as a whole, or to none.
SMALLEST_RADIUS = 1e-5
#: Least radius of a closed orbit for which no such set is found. On some orbits a block almost sticks, or almost
#: starts: they attract from one side only, and hardly at all from the other.
TINY_RADIUS = 1e-8

#: Time by which a trajectory that comes near a set has come to a closed orbit in its midst, if it does at all.
PATIENT_TIME = 10_000.0

# Part of the way to another attractor that a radius takes at most: less than half, so that no state is near both.
SHARED = 0.4

#: Perturbed trajectories that are followed at once: one that does not come back saves following the others.
PUSH_GROUP = 4


def midst(attractors: Sequence[Attractor], index: int, tolerance: float) -> list[int]:
    """Return the closed orbits that lie in the midst of an attractor, which is chaos or a slow set.

    tolerance : distance within which the returns of closed orbits repeat
    """
    motion = attractors[index].motion
    if motion.kind not in CHAOS and not attractors[index].slow:
        return []
    reach = SPACINGS * motion.spacing
    return [
        k
        for k, other in enumerate(attractors)
        if k != index
        and other.motion.spacing <= tolerance
        and minimum_distance(motion.returns, other.motion.returns, reach) <= reach
    ]


@dataclass(frozen=True)
class Capture:
    """How far from an attractor perturbed trajectories still come back, and within what they are captured.

    largest : radius, for v = 0.1, where returns are no farther apart: beyond it a perturbation may leave the basin of a
        thin attractor although all samples come back
    recovery : trajectories have come back when they are this many times closer than they were perturbed, well beyond
        what a motion that neither attracts nor repels shows
    shrinking : the next radius that is tried is smaller by this factor
    """

    largest: float = 0.02
    recovery: float = 10.0
    shrinking: float = 2.0

    def recovered(self, motion: SteadyMotion, radius: float) -> float:
        """Return how close to an attractor a trajectory has to come after a perturbation by that radius."""
        return max(SPACINGS * motion.spacing, radius / self.recovery)

    def bounded(self, model: Model, attractors: Sequence[Attractor], tolerance: float) -> list[Attractor]:
        """Return the attractors with all radii bounded by the distances between them.

        Chaos with a closed orbit in its midst keeps its radius but asks for patience, as a trajectory that comes near
        it may be on its way to the orbit.
        """
        within = [midst(attractors, index, tolerance) for index in range(len(attractors))]
        result = []
        for index, attractor in enumerate(attractors):
            radius = min(attractor.radius, max(self.largest * model.scale, attractor.motion.spacing))
            for k, other in enumerate(attractors):
                if k != index and k not in within[index] and index not in within[k]:
                    apart = minimum_distance(attractor.motion.returns, other.motion.returns, radius / SHARED)
                    radius = min(radius, SHARED * apart)
            result.append(replace(attractor, radius=radius, patience=PATIENT_TIME if within[index] else 0.0))
        return result

    def radius(
        self,
        model: Model,
        attractors: Sequence[Attractor],
        index: int,
        least: float,
        tolerance: float,
        settings: SearchSettings,
    ) -> float:
        """Return the largest radius, up to the present one, from which all random perturbations come back.

        0 if there is none of `least`, for v = 0.1, or more.
        """
        motion = attractors[index].motion
        radius = attractors[index].radius
        inner = midst(attractors, index, tolerance)
        generator = np.random.default_rng(settings.seed)
        while radius >= least * model.scale:
            close = self.recovered(motion, radius)
            narrow = [replace(item, radius=min(item.radius, close)) for item in attractors]
            if inner:
                narrow[index] = replace(narrow[index], patience=0.0)
            left = settings.perturbations
            while left > 0:
                chosen = generator.integers(len(motion.returns), size=min(PUSH_GROUP, left))
                starts = [perturbed(state_of(motion.returns[k]), radius, generator) for k in chosen]
                if close >= radius:
                    # The gaps hide whether they come closer: wherever they are later, they have to be recognised.
                    starts = moved(model, starts, SLOW_TIME * settings.transient)
                reached, _ = label(model, narrow, starts, settings.time_limit)
                if not np.isin(reached, [index, *inner]).all():
                    break
                left -= len(chosen)
            else:
                return radius
            radius /= self.shrinking
        return 0.0
