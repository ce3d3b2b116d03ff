"""Motion after detuning: do the end blocks keep one frequency if their masses differ, and in which mode do they move?

If a motion is its own mirror image, its end blocks have one frequency by symmetry. If they keep it with different
masses, and perturbations of their relative phase decay, they may be locked oscillators, or the friction may select one
mode of the springs, in which all blocks have one frequency. Amplitude ratio and phase of the common oscillation decide
(`motion.modes`). If N blocks oscillate freely, none of their phases decays and N Lyapunov exponents are 0; each locked
relation between the phases, and each mode that is suppressed, makes one of them negative.

Reference: A. Pikovsky, M. Rosenblum and J. Kurths, Synchronization (Cambridge University Press, 2001), chapter 8:
mutual synchronization of two self-sustained oscillators, and its range of detuning.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.frequency import sampled_motion
from burridge_knopoff.motion.modes import modes_of
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.summaries.one_frequency import has_one_frequency

#: Time for which the motion settles after the detuning, and time for which its exponents, and then its frequencies and
#: modes, are measured.
TRANSIENT, WINDOW = 4000.0, 4000.0

#: The window of the exponents is doubled up to this one if the end blocks have one frequency but it is not certain, by
#: so many standard errors, that a perturbation of their phase decays.
LONGEST_WINDOW, STANDARD_ERRORS = 64000.0, 3.0


@dataclass(frozen=True, eq=False)
class DetunedMotion:
    """A motion after a change of one mass.

    frequency, frequency_error : of each block, see `block_frequencies`, shape (blocks,)
    exponent, exponent_error : Lyapunov exponents, the largest first, shape (exponents,)
    mode_share : of each mode in the oscillation with the frequency of the first block, see
        `ModeAmplitudes.line_shares`, shape (modes,)
    end_ratio, end_phase : amplitude of the last block over that of the first in this oscillation, and phase difference
        in degrees, from 0 to 360
    final : the state at which frequencies and modes were measured
    """

    frequency: np.ndarray
    frequency_error: np.ndarray
    exponent: np.ndarray
    exponent_error: np.ndarray
    mode_share: np.ndarray
    end_ratio: float
    end_phase: float
    final: ChainState


def detuned_model(model: Model, detuning: float) -> Model:
    """Return the model with the mass of its last block multiplied by 1 + detuning."""
    return model.at(**{f"mass[{model.blocks}]": model.chain.masses[-1] * (1.0 + detuning)})


def detuned_motions(model: Model, start: ChainState, detunings: Sequence[float], exponents: int) -> list[DetunedMotion]:
    """Return the motion after each of several detunings; each begins at the last state of the one before."""
    motions: list[DetunedMotion] = []
    for detuning in detunings:
        motions.append(detuned_motion(model, motions[-1].final if motions else start, detuning, exponents))
    return motions


def detuned_motion(model: Model, start: ChainState, detuning: float, exponents: int) -> DetunedMotion:
    """Return the motion after a change of the mass of the last block.

    start : state at which the mass is multiplied by 1 + detuning; exponents : number of exponents to compute

    All numbers are NaN if the run does not complete.
    """
    detuned = detuned_model(model, detuning)
    settled = _measured(detuned, start, WINDOW, exponents)
    if settled.status != "completed":
        unknown = np.full(model.blocks, math.nan)
        exponents_with_errors = settled.lyapunov_exponent, settled.lyapunov_error
        return DetunedMotion(unknown, unknown, *exponents_with_errors, unknown, math.nan, math.nan, settled.final)
    motion = sampled_motion(detuned, settled.final, WINDOW)
    frequency, error = motion.frequencies()
    exponent, exponent_error = _resolved_exponents(detuned, settled, exponents, bool(has_one_frequency(frequency)))
    share, ratio = np.full(model.blocks, math.nan), np.complex128(math.nan)
    if np.isfinite(frequency[0]):
        modes = modes_of(motion)
        share, line = modes.line_shares(frequency[0]), modes.line(frequency[0]) @ modes.shape
        ratio = line[-1] / line[0]
    return DetunedMotion(
        frequency,
        error,
        exponent,
        exponent_error,
        share,
        # Python's own abs of a complex NaN may raise OverflowError, by an error that an earlier call left.
        float(np.abs(ratio)),
        math.degrees(np.angle(ratio)) % 360.0,
        settled.final,
    )


def _measured(model: Model, start: ChainState, window: float, exponents: int) -> Trajectory:
    """Return a run that settles and then determines Lyapunov exponents over a window."""
    settings = Settings(
        transient=TRANSIENT,
        window=window,
        sampling=window,
        trajectory=0.0,
        event_window=0.0,
        lyapunov_exponents=exponents,
        lyapunov_alignment=0.25 * TRANSIENT,
    )
    return run(model, start, settings, section_only=True)


def _resolved_exponents(
    model: Model, settled: Trajectory, exponents: int, one_frequency: bool
) -> tuple[np.ndarray, np.ndarray]:
    """Return exponents and errors of a motion, over longer windows while the third may be 0; see LONGEST_WINDOW."""
    motion, window = settled, WINDOW
    while (
        one_frequency
        and window < LONGEST_WINDOW
        and exponents > 2
        and not motion.lyapunov_exponent[2] < -STANDARD_ERRORS * motion.lyapunov_error[2]
    ):
        window *= 2.0
        motion = _measured(model, settled.final, window, exponents)
    return motion.lyapunov_exponent, motion.lyapunov_error
