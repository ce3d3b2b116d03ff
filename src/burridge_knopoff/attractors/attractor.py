"""One attractor: a settled motion with its mirror symmetry and the radius within which it captures trajectories."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from burridge_knopoff.model.model import ChainState
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import ROUNDING

#: Successive returns within the capture radius after which a trajectory is captured: none passes by so often by chance.
CLOSE_RETURNS = 8

# Longest orbit, in returns, that a trajectory has to go round twice; it bounds the cost of a label.
LONGEST_ORBIT = 100


@dataclass(frozen=True, eq=False)
class Attractor:
    """A settled motion with what distinguishes it from others.

    partner : index, among the attractors of the same a, of its mirror image; its own where that is the same set, or
        where there is none
    radius : distance from its returns within which trajectories are captured
    slow : whether the motion on the set is too slow to settle, so that its returns are those of pushed states
    close_returns : successive returns within the radius after which a trajectory counts as captured
    patience : time by which a captured trajectory may still come to a closed orbit in the midst of the attractor; 0
        where there is no such orbit

    Distances are the largest difference of a position or a velocity, in the units of `Model`.

    >>> from burridge_knopoff import Chain, Model, SearchSettings, find_attractors, law_of
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> attractors[1].symmetry.name, attractors[1].partner
    ('SYMMETRIC', 1)
    """

    motion: SteadyMotion
    symmetry: Symmetry
    partner: int
    radius: float = np.inf
    slow: bool = False
    close_returns: int = field(kw_only=True)
    patience: float = 0.0

    def __repr__(self) -> str:
        return f"<Attractor, {self.symmetry.name.lower()}: {self.motion.words}>"


def close_returns(found: Returns, tolerance: float) -> int:
    """Return how many successive returns have to be close to a motion: twice round it if it is a closed orbit."""
    if not found.has_periodic_spacing(tolerance):
        return CLOSE_RETURNS
    return max(CLOSE_RETURNS, 2 * orbit_length(found.returns, 10.0 * tolerance, LONGEST_ORBIT))


def perturbed(start: ChainState, size: float, generator: np.random.Generator) -> ChainState:
    """Return a state with all positions and all velocities of slipping blocks changed by at most `size` at random.

    A block does not turn round by it.
    """
    blocks = len(start.position)
    change = generator.uniform(-size, size, 2 * blocks)
    moved = start.velocity + change[blocks:]
    # Less is rounding at a stop, of either sign.
    backward = start.velocity < -ROUNDING * max(1.0, np.abs(start.velocity).max())
    velocity = np.where(start.stuck | (np.where(backward, -moved, moved) < 0.0), 0.0, moved)
    return ChainState(start.position + change[:blocks], velocity, start.stuck)
