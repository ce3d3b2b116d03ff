"""Motion after detuning: are the end blocks locked to each other if their masses differ?

If a motion is its own mirror image, its end blocks have the same frequency by symmetry, whether they are locked or not.
Locked blocks keep a common frequency if their natural frequencies are made to differ, up to some detuning. Under
constant friction, blocks that move in a single mode of the springs have a common frequency as well, but neighbouring
motions have other frequencies. Locking is attracting. If N blocks oscillate freely, none of their phases decays and N
Lyapunov exponents are 0; each locked relation between the phases makes one of them negative.

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

#: Time for which the motion settles after the detuning, and time for which its exponents, and then its frequencies, are
#: measured.
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

    start : state at which the mass is multiplied by 1 + detuning; exponents : number of exponents to compute
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
