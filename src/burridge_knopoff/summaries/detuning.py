"""Motion after detuning: are the end blocks locked to each other if their masses differ?

By mirror symmetry both end blocks of a motion that is its own mirror image have one frequency, locked or not. If they
are locked, they keep one frequency when their own frequencies are made to differ, up to some detuning. Where friction
is constant, blocks that move in one mode of the springs keep one frequency as well, but nothing holds them there: other
motions, with other frequencies, lie next to theirs. Locking also attracts. Of the phases of N blocks that oscillate
freely none decays, and N Lyapunov exponents are 0; each relation between them that is locked makes one negative.

Reference: A. Pikovsky, M. Rosenblum and J. Kurths, Synchronization (Cambridge University Press, 2001), chapter 8:
mutual synchronization of two self-sustained oscillators, and its range of detuning.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.frequency import block_frequencies
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

#: Time after the detuning for which the motion is left to settle, and for which its exponents and then its frequencies
#: are measured.
TRANSIENT, WINDOW = 4000.0, 4000.0


@dataclass(frozen=True, eq=False)
class DetunedMotion:
    """A motion after a change of one mass.

    frequency, frequency_error : of each block, see `block_frequencies`, shape (blocks,)
    exponent, exponent_error : Lyapunov exponents, the largest first, shape (exponents,)
    """

    frequency: np.ndarray
    frequency_error: np.ndarray
    exponent: np.ndarray
    exponent_error: np.ndarray


def detuned_motion(model: Model, start: ChainState, detuning: float, exponents: int) -> DetunedMotion:
    """Return the motion after a change of the mass of the last block.

    start : state in which the mass becomes 1 + detuning times as large; exponents : how many are computed
    """
    masses = model.chain.masses
    detuned = model.at(**{f"mass[{model.blocks}]": masses[-1] * (1.0 + detuning)})
    settings = Settings(
        transient=TRANSIENT,
        window=WINDOW,
        sampling=WINDOW,
        trajectory=0.0,
        event_window=0.0,
        lyapunov_exponents=exponents,
        lyapunov_alignment=0.25 * TRANSIENT,
    )
    settled = run(detuned, start, settings, section_only=True)
    frequency, error = block_frequencies(detuned, settled.final, WINDOW)
    return DetunedMotion(frequency, error, settled.lyapunov_exponent, settled.lyapunov_error)
