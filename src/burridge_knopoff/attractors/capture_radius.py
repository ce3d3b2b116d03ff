"""How near an attractor a trajectory is certain to stay: the radius, within which trajectories are captured.

It is less than half the way to any other attractor, and trajectories that were pushed off by that much at random have
come back. The returns of a set of many dimensions are few and far between: its radius is as wide as they need.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, perturbed
from burridge_knopoff.attractors.labels import label, moved
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.set_distance import least_distance
from burridge_knopoff.motion.tuning import TUNING, Tuning


def recovered(motion: SteadyMotion, radius: float, tuning: Tuning = TUNING) -> float:
    """Return how close to an attractor a trajectory has to come after a push by that radius."""
    return max(tuning.spacings * motion.spacing, radius / tuning.recovery)


def midst(attractors: Sequence[Attractor], index: int, tolerance: float, tuning: Tuning = TUNING) -> list[int]:
    """Return the closed orbits that lie in the midst of an attractor, which is chaos or a slow set.

    tolerance : distance within which the returns of closed orbits repeat
    """
    motion = attractors[index].motion
    if motion.kind not in CHAOS and not attractors[index].slow:
        return []
    reach = tuning.spacings * motion.spacing
    return [
        k
        for k, other in enumerate(attractors)
        if k != index
        and other.motion.spacing <= tolerance
        and least_distance(motion.returns, other.motion.returns, reach) <= reach
    ]


def bounded(
    model: Model, attractors: Sequence[Attractor], tolerance: float, tuning: Tuning = TUNING
) -> list[Attractor]:
    """Return the attractors with all radii bounded by the distances between them.

    Chaos with a closed orbit in its midst keeps its radius but asks for patience, as a trajectory that comes near it
    may be on its way to the orbit.
    """
    within = [midst(attractors, index, tolerance, tuning) for index in range(len(attractors))]
    result = []
    for index, attractor in enumerate(attractors):
        radius = min(attractor.radius, max(tuning.largest_radius * model.scale, attractor.motion.spacing))
        for k, other in enumerate(attractors):
            if k != index and k not in within[index] and index not in within[k]:
                apart = least_distance(attractor.motion.returns, other.motion.returns, radius / tuning.shared)
                radius = min(radius, tuning.shared * apart)
        result.append(replace(attractor, radius=radius, patience=tuning.patient_time if within[index] else 0.0))
    return result


def captured(
    model: Model,
    attractors: Sequence[Attractor],
    index: int,
    least: float,
    tolerance: float,
    settings: SearchSettings,
    tuning: Tuning = TUNING,
) -> float:
    """Return a radius of an attractor from which all of a number of random pushes come back, at most the present one.

    0 if there is none of `least`, for v = 0.1, or more.
    """
    motion = attractors[index].motion
    radius = attractors[index].radius
    inner = midst(attractors, index, tolerance, tuning)
    generator = np.random.default_rng(settings.seed)
    while radius >= least * model.scale:
        close = recovered(motion, radius, tuning)
        narrow = [replace(item, radius=min(item.radius, close)) for item in attractors]
        if inner:
            narrow[index] = replace(narrow[index], patience=0.0)
        left = settings.pushes
        while left > 0:
            chosen = generator.integers(len(motion.returns), size=min(tuning.push_group, left))
            starts = [perturbed(state_of(motion.returns[k]), radius, generator) for k in chosen]
            if close >= radius:
                # The gaps hide whether they come closer: wherever they are later, they have to be recognised.
                starts = moved(model, starts, tuning.slow_time * settings.transient)
            reached, _ = label(model, narrow, starts, settings.time_limit)
            if not np.isin(reached, [index, *inner]).all():
                break
            left -= len(chosen)
        else:
            return radius
        radius /= tuning.shrinking
    return 0.0
