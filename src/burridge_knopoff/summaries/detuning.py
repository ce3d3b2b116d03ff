"""Motion after detuning: do the end blocks keep one frequency if their masses differ?

By mirror symmetry both end blocks of a motion that is its own mirror image have one frequency, locked or not. If they
are locked to each other they keep one frequency when their own frequencies are made to differ, up to some detuning. The
converse does not hold: blocks that move in one mode of the springs keep one frequency as well.

Reference: A. Pikovsky, M. Rosenblum and J. Kurths, Synchronization (Cambridge University Press, 2001), chapter 8:
mutual synchronization of two self-sustained oscillators, and its range of detuning.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.periodic_orbits.grazing_distances import longest_spacing
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.summaries.correlation import correlation
from burridge_knopoff.summaries.frequency import leading_frequency

#: Time after the detuning for which the motion is left to settle, and for which it is measured.
TRANSIENT, WINDOW = 4000.0, 1000.0


def detuned_motion(model: Model, start: ChainState, detuning: float) -> tuple[np.ndarray, float]:
    """Return the frequencies of the blocks, and the correlation of the end blocks, after a change of the last mass.

    start : state in which the mass of the last block becomes 1 + detuning times as large

    The frequency of a block, in cycles per unit time, is that of the highest peak of the spectrum of its velocity,
    shape (blocks,), NaN if there is none; the correlation is Pearson's of the velocities of the end blocks.
    """
    masses = model.chain.masses.copy()
    masses[-1] *= 1.0 + detuning
    detuned = replace(model, chain=replace(model.chain, mass=tuple(masses.tolist())))
    count = int(np.ceil(WINDOW / longest_spacing(detuned.chain))) + 1
    instants = [0.0, *np.linspace(TRANSIENT, TRANSIENT + WINDOW, count).tolist()]
    state = (start.position[None], start.velocity[None], start.stuck[None].astype(bool))
    velocity = new_ensemble(detuned).run(*state, instants)["velocity"][0][1:]
    frequency = np.array([leading_frequency(one, WINDOW) for one in velocity.T])
    return frequency, correlation(velocity[:, 0], velocity[:, -1])
