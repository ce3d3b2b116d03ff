"""The capture radius of an attractor: the distance within which trajectories are taken to stay with it.

It is less than half the distance to any other attractor, and trajectories that were perturbed by that much at random
have come back. A set of high dimension has returns that are far apart; its radius may be as large as their spacing.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Annotated

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, perturb
from burridge_knopoff.attractors.labels import advance, label
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.slow_set import SLOW_TIME
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.ranges import HUGE, Number
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.set_distance import SPACINGS, minimum_distance

#: Smallest radius of an attractor, for v = 0.1: 1 % of the default resolution. A motion to which only smaller
#: perturbations return belongs to a set that attracts as a whole, or does not attract.
SMALLEST_RADIUS = 1e-5
#: Smallest radius of a periodic orbit for which no such set is found. On some orbits a block almost sticks or almost
#: starts; they attract from one side, and hardly from the other.
TINY_RADIUS = 1e-8

#: Time by which a trajectory near a set has reached a periodic orbit embedded in it, if it reaches one at all.
LONGEST_PATIENCE = 10_000.0

# Largest radius as a fraction of the distance to another attractor; below one half, so that no state is near both.
SEPARATION_SHARE = 0.4

#: Number of perturbed trajectories that are followed first. If one does not come back, the others are not followed.
PERTURBATION_GROUP = 4


def embedded_orbits(attractors: Sequence[Attractor], index: int, tolerance: float) -> list[int]:
    """Return the indices of the periodic orbits embedded in an attractor, which is chaotic or a slow set.

    tolerance : distance within which the returns of periodic orbits repeat
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


@settings
@dataclass(frozen=True)
class Capture:
    """How capture radii are determined.

    Raises ValueError, one line, for anything out of range.
    """

    largest: Annotated[
        float,
        Number(0.0, HUGE, above=True),
        "largest radius, for v = 0.1, unless the returns are farther apart than that; a larger perturbation may leave "
        "the basin of a thin attractor although all samples come back",
    ] = 0.02
    recovery: Annotated[
        float,
        Number(1.0, HUGE),
        "factor by which trajectories have to come closer than they were perturbed; near a motion that neither "
        "attracts nor repels the distance changes by much less",
    ] = 10.0
    shrinking: Annotated[
        float, Number(1.0, HUGE, above=True), "factor by which the next radius that is tried is smaller"
    ] = 2.0

    def __post_init__(self) -> None:
        check_fields(self)

    def recovery_distance(self, motion: SteadyMotion, radius: float) -> float:
        """Return how close to an attractor a trajectory perturbed by this radius has to come back."""
        return max(SPACINGS * motion.spacing, radius / self.recovery)

    def bound_radii(self, model: Model, attractors: Sequence[Attractor], tolerance: float) -> list[Attractor]:
        """Return the attractors with all radii bounded by the distances between them.

        Chaos in which a periodic orbit is embedded keeps its radius but gets a patience, because a trajectory near the
        chaos may be on its way to the orbit.
        """
        within = [embedded_orbits(attractors, index, tolerance) for index in range(len(attractors))]
        result = []
        for index, attractor in enumerate(attractors):
            radius = min(attractor.radius, max(self.largest * model.scale, attractor.motion.spacing))
            for k, other in enumerate(attractors):
                if k != index and k not in within[index] and index not in within[k]:
                    apart = minimum_distance(attractor.motion.returns, other.motion.returns, radius / SEPARATION_SHARE)
                    radius = min(radius, SEPARATION_SHARE * apart)
            result.append(replace(attractor, radius=radius, patience=LONGEST_PATIENCE if within[index] else 0.0))
        return result

    def find_radius(
        self,
        model: Model,
        attractors: Sequence[Attractor],
        index: int,
        least: float,
        tolerance: float,
        settings: SearchSettings,
    ) -> float:
        """Return the largest radius, up to the present one, from which all random perturbations come back.

        least : smallest radius that is tried, for v = 0.1; the result is 0 if perturbations leave from it
        """
        inner = embedded_orbits(attractors, index, tolerance)
        generator = np.random.default_rng(settings.seed)
        radius = attractors[index].radius
        while radius >= least * model.scale:
            if self._captures(model, attractors, index, inner, radius, settings, generator):
                return radius
            radius /= self.shrinking
        return 0.0

    def _captures(
        self,
        model: Model,
        attractors: Sequence[Attractor],
        index: int,
        inner: Sequence[int],
        radius: float,
        settings: SearchSettings,
        generator: np.random.Generator,
    ) -> bool:
        """Return whether random perturbations of a radius all come back to an attractor, or to an orbit in it.

        inner : indices of the periodic orbits embedded in the attractor
        """
        motion, distance = attractors[index].motion, self.recovery_distance(attractors[index].motion, radius)
        narrow = [replace(item, radius=min(item.radius, distance)) for item in attractors]
        if inner:
            narrow[index] = replace(narrow[index], patience=0.0)
        # Most radii that are too large are refused by the first few trajectories.
        for count in filter(None, (PERTURBATION_GROUP, settings.perturbations - PERTURBATION_GROUP)):
            chosen = generator.integers(len(motion.returns), size=count)
            starts = [perturb(state_of(motion.returns[k]), radius, generator) for k in chosen]
            if distance >= radius:
                # The returns are too far apart to show that a trajectory comes closer. It has to be on the attractor
                # after a longer time instead.
                starts = advance(model, starts, SLOW_TIME * settings.transient)
            reached, _ = label(model, narrow, starts, settings.time_limit)
            if not np.isin(reached, [index, *inner]).all():
                return False
        return True
