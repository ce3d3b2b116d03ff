"""One attractor: a settled motion with its mirror symmetry and the radius within which it captures trajectories."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import Returns, state_of, stops_alike, visit
from burridge_knopoff.motion.tuning import TUNING, Tuning
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


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


def close_returns(found: Returns, tolerance: float, tuning: Tuning = TUNING) -> int:
    """Return how many successive returns have to be close to a motion: twice round it if it is a closed orbit."""
    if not found.closed(tolerance):
        return tuning.close_returns
    return max(tuning.close_returns, 2 * orbit_length(found.returns, 10.0 * tolerance, tuning.longest_orbit))


def perturbed(start: ChainState, size: float, generator: np.random.Generator) -> ChainState:
    """Return a state with all positions and all velocities of slipping blocks changed by at most `size` at random.

    A block does not turn round by it.
    """
    blocks = len(start.position)
    change = generator.uniform(-size, size, 2 * blocks)
    moved = start.velocity + change[blocks:]
    backward = start.velocity < 0.0
    velocity = np.where(start.stuck | (np.where(backward, -moved, moved) < 0.0), 0.0, moved)
    return ChainState(start.position + change[:blocks], velocity, start.stuck)


def spread(model: Model, motion: SteadyMotion, settings: SearchSettings, tuning: Tuning = TUNING) -> SteadyMotion:
    """Return a motion with the returns of trajectories that were pushed off it as its own.

    Near a resonance the motion on a torus is locked, or nearly so, to orbits that hardly attract anything. The torus
    itself attracts; pushed states, which fall back on it and drift along, show more of it than a settled one.
    """
    generator = np.random.default_rng(settings.seed)
    clouds: list[Returns] = []
    blocks = motion.block, motion.mirror_block
    for k in generator.integers(len(motion.returns), size=tuning.slow_states):
        size = tuning.slow_push * settings.resolution * model.scale
        start = perturbed(state_of(motion.returns[k]), size, generator)
        found = visit(model, start, tuning.slow_time * settings.transient, settings.window, tuning)
        # A state that has left for another motion shows nothing of this one.
        if (
            found is not None
            and (found.block, found.mirror_block) == blocks
            and stops_alike(found.stop_count, motion.stop_rate, tuning)
        ):
            clouds.append(found)
    # The last return, from which the motion is followed on, is its own.
    returns = np.concatenate([*(cloud.returns for cloud in clouds), motion.returns])
    mirror_returns = np.concatenate([*(cloud.mirror_returns for cloud in clouds), motion.mirror_returns])
    return motion.with_returns(returns, mirror_returns, tuning)
