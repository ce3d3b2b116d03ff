"""Slow sets: tori near a resonance, which attract as a whole while the motion on them is too slow to settle."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.attractors.attractor import perturbed
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import Returns, has_same_stop_shares, state_of, visit

#: States that show a slow set; how far they are perturbed, in resolutions, so that they leave the locked orbit on it;
#: and how long they are left to fall back, in transients, too short to reach that orbit again.
SLOW_STATES = 12
SLOW_PUSH = 5.0
SLOW_TIME = 0.3


def spread(model: Model, motion: SteadyMotion, settings: SearchSettings) -> SteadyMotion:
    """Return a motion with the returns of trajectories that were perturbed off it as its own.

    Near a resonance the motion on a torus is locked, or nearly so, to orbits that hardly attract anything. The torus
    itself attracts; perturbed states, which fall back on it and drift along, show more of it than a settled one.
    """
    generator = np.random.default_rng(settings.seed)
    clouds: list[Returns] = []
    blocks = motion.block, motion.mirror_block
    for k in generator.integers(len(motion.returns), size=SLOW_STATES):
        size = SLOW_PUSH * settings.resolution * model.scale
        start = perturbed(state_of(motion.returns[k]), size, generator)
        found = visit(model, start, SLOW_TIME * settings.transient, settings.window)
        # A state that has left for another motion shows nothing of this one.
        if (
            found is not None
            and (found.block, found.mirror_block) == blocks
            and has_same_stop_shares(found.stop_count, motion.stop_rate)
        ):
            clouds.append(found)
    # The last return, from which the motion is followed on, is its own.
    returns = np.concatenate([*(cloud.returns for cloud in clouds), motion.returns])
    mirror_returns = np.concatenate([*(cloud.mirror_returns for cloud in clouds), motion.mirror_returns])
    return motion.replace_returns(returns, mirror_returns)
