"""One attractor: a settled motion, its mirror symmetry, and the radius within which it captures trajectories."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import ROUNDING
from burridge_knopoff.values import each_instance_of

#: Successive returns within the capture radius after which a trajectory counts as captured. A trajectory that only
#: passes by does not return that often.
CLOSE_RETURNS = 8

# Longest orbit, in returns, of which a trajectory has to complete two periods; it bounds the cost of a label.
LONGEST_ORBIT = 100


@dataclass(frozen=True, eq=False)
class Attractor:
    """An attractor of a model, represented by a settled motion.

    partner : index of its mirror image among the attractors of the same a; its own index if the mirror image is the
        same set, or if there is none
    radius : capture radius, the distance from its returns within which trajectories are captured
    slow : whether the motion on the set is too slow to settle, so that its returns are those of perturbed states
    close_returns : successive returns within the radius after which a trajectory counts as captured
    patience : time by which a captured trajectory may still reach a periodic orbit embedded in the attractor; 0 if
        there is no such orbit

    Distances are the largest difference of a position or a velocity, in the units of `Model`.

    >>> from burridge_knopoff import Chain, Model, SearchSettings, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> attractors[1].symmetry.name, attractors[1].partner
    ('SYMMETRIC', 1)
    """

    model: Model
    motion: SteadyMotion
    symmetry: Symmetry
    partner: int
    radius: float = np.inf
    slow: bool = False
    close_returns: int = field(kw_only=True)
    patience: float = 0.0

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Refuse a pickle without a model."""
        if "model" not in state:
            raise ValueError("attractor: got a pickle without its model, expected one of this version: search again")
        vars(self).update(state)

    def __repr__(self) -> str:
        return f"<Attractor, {self.symmetry.name.lower()}: {self.motion.words}>"


def attractors_of(model: Model, attractors: Sequence[Attractor]) -> list[Attractor]:
    """Return a list of attractors; raises ValueError, one line, unless all are attractors of this model."""
    attractors = each_instance_of(attractors, Attractor, "attractors")
    for index, attractor in enumerate(attractors):
        model.check_same(attractor.model, f"attractors[{index}].model")
    return attractors


def required_returns(section: Returns, tolerance: float) -> int:
    """Return the number of successive returns that capture requires: at least two periods of a periodic orbit."""
    if not section.has_periodic_spacing(tolerance):
        return CLOSE_RETURNS
    return max(CLOSE_RETURNS, 2 * orbit_length(section.returns, 10.0 * tolerance, LONGEST_ORBIT))


def perturb(start: ChainState, size: float, generator: np.random.Generator) -> ChainState:
    """Return a state with positions, and velocities of slipping blocks, changed at random by at most `size`.

    The direction of slip is not reversed.
    """
    blocks = len(start.position)
    change = generator.uniform(-size, size, 2 * blocks)
    moved = start.velocity + change[blocks:]
    # Smaller velocities of either sign are rounding errors at a stop.
    backward = start.velocity < -ROUNDING * max(1.0, np.abs(start.velocity).max())
    velocity = np.where(start.stuck | (np.where(backward, -moved, moved) < 0.0), 0.0, moved)
    return ChainState(start.position + change[:blocks], velocity, start.stuck)
