"""Slow sets: tori near a resonance that attract as a whole, while the motion on them is too slow to settle."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.attractors.attractor import perturb
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import Returns, has_same_stop_shares, state_of, visit

#: Number of states that sample a slow set; their perturbation, in resolutions, large enough to leave a locked orbit on
#: it; and the time, in transients, in which they fall back on the set, too short to reach that orbit again.
SLOW_STATES = 12
SLOW_PUSH = 5.0
SLOW_TIME = 0.3


def sample_slow_set(model: Model, motion: SteadyMotion, settings: SearchSettings) -> SteadyMotion:
    """Return a motion together with the returns of trajectories that were perturbed off it.

    Near a resonance the motion on a torus is locked, or nearly locked, to orbits that hardly attract. The torus itself
    attracts: perturbed states fall back on it and drift along it, and so sample more of it than a settled one.
    """
    generator = np.random.default_rng(settings.seed)
    clouds: list[Returns] = []
    blocks = motion.block, motion.mirror_block
    for k in generator.integers(len(motion.returns), size=SLOW_STATES):
        size = SLOW_PUSH * settings.resolution * model.scale
        start = perturb(state_of(motion.returns[k]), size, generator)
        section = visit(model, start, SLOW_TIME * settings.transient, settings.window)
        # A state that has left for another motion does not belong to the set.
        if (
            section is not None
            and (section.block, section.mirror_block) == blocks
            and has_same_stop_shares(section.stop_count, motion.stop_rate)
        ):
            clouds.append(section)
    # The motion is continued from the last return, which has to be its own.
    returns = np.concatenate([*(cloud.returns for cloud in clouds), motion.returns])
    mirror_returns = np.concatenate([*(cloud.mirror_returns for cloud in clouds), motion.mirror_returns])
    return motion.replace_returns(returns, mirror_returns)
