"""The normal modes of the sliding chain along a motion: which of them oscillate, with which amplitudes and phases.

Relative to uniform sliding, x_i = U_i − vτ − e_i, the springs alone give M x'' = −K x. Friction that depends weakly on
velocity leaves these oscillations nearly unchanged while all blocks slip; sticks exchange energy between them.

Blocks that have one frequency are not necessarily locked: they also have one frequency if they move in one mode. The
two differ in the shape of the common oscillation. In one mode, amplitude ratios and phases are those of the mode,
whatever the masses. Locked oscillators have their own amplitudes, and a difference of phase that shifts with the
detuning, up to a quarter of a cycle where locking ends: such a motion is a superposition of modes, all but one of which
oscillate at a frequency that is not theirs.

Reference: A. Pikovsky, M. Rosenblum and J. Kurths, Synchronization (Cambridge University Press 2001), chapters 3 and 8.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import eigh

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Number
from burridge_knopoff.motion.frequency import SampledMotion, sampled_motion, smooth_weight
from burridge_knopoff.values import MOST_NUMBERS, instance_of

# A block with a smaller share of the largest displacement in a mode does not decide the sign of the mode.
AT_REST = 1e-6

# Modes whose frequencies differ by no more than rounding, relative to the highest one, have equal frequencies.
EQUAL = 1e-10


@dataclass(frozen=True, eq=False)
class ModeAmplitudes:
    """Amplitudes and phases of the normal modes of a chain along a motion.

    frequency : of each mode, in cycles per unit time, ascending, shape (modes,)
    shape : displacements φ of the blocks in each mode, (modes, blocks): K φ = ω² M φ, φ·M φ' = 1 for the same mode and
        0 for two, and the first block that moves is displaced forward
    time : from the first state, in units of 1/ω, equidistant, shape (times,)
    amplitude, phase : A ≥ 0 and θ in (−π, π] of each mode, shape (times, modes), with φ·M x = A cos θ and
        φ·M x' = −ω A sin θ. In a mode that oscillates freely A is constant, and θ grows at the rate ω

    >>> import numpy as np
    >>> from burridge_knopoff import ChainState, Model, mode_amplitudes
    >>> model = Model("linearized", a=0.0)
    >>> antiphase = ChainState(np.array([0.05, 0.0, -0.05]), np.full(3, 0.1), np.zeros(3, bool))
    >>> modes = mode_amplitudes(model, antiphase, 100.0)
    >>> modes.amplitude[-1].round(6).tolist()
    [0.0, 0.070711, 0.0]
    """

    frequency: np.ndarray
    shape: np.ndarray
    time: np.ndarray
    amplitude: np.ndarray
    phase: np.ndarray

    def __repr__(self) -> str:
        return f"<ModeAmplitudes: {len(self.frequency)} modes over {self.time[-1]:g} time units>"

    @property
    def energy(self) -> np.ndarray:
        """Energy ω²A²/2 of each mode, shape (times, modes); the sum over the modes is (x'·M x' + x·K x)/2."""
        return 0.5 * (2.0 * np.pi * self.frequency * self.amplitude) ** 2

    def line(self, frequency: float) -> np.ndarray:
        """Return the part of each mode that oscillates at a frequency, as complex amplitudes, shape (modes,).

        frequency : in cycles per unit time, such as one of `block_frequencies`; ValueError, one line, if it is not a
            number from 0 to 1/(2Δt), the highest frequency that states at intervals of Δt resolve

        A cos(2πft + θ) gives A e^{iθ}. The product with `shape` gives the amplitudes of the blocks. The error decreases
        with the distance of other lines from this one, faster than any power of its product with the time.
        """
        frequency = Number(0.0, 0.5 / float(self.time[1])).form(frequency, "frequency")
        values = self.amplitude * np.cos(self.phase)
        weight = smooth_weight(len(self.time))
        weight /= weight.sum()
        return 2.0 * (weight * np.exp(-2j * np.pi * frequency * self.time)) @ (values - weight @ values)

    def line_shares(self, frequency: float) -> np.ndarray:
        """Return the shares of the modes in the kinetic energy of the part of the motion at a frequency: (modes,).

        Modes of equal frequencies, as in a ring, are determined up to a rotation only: they count as one mode, and the
        share of each of them is that of all. NaN if nothing moves at this frequency.
        """
        square = np.abs(self.line(frequency)) ** 2
        group = np.cumsum(np.diff(self.frequency, prepend=self.frequency[0]) > EQUAL * self.frequency[-1])
        return np.bincount(group, square)[group] / (square.sum() or math.nan)


def mode_amplitudes(model: Model, state: ChainState, duration: float = 4000.0) -> ModeAmplitudes:
    """Return the amplitudes and phases of the normal modes of the sliding chain along a motion.

    model, state : the state at which the motion begins, such as `Trajectory.final`
    duration : time of observation, in units of 1/ω

    The modes are those of the springs and masses alone: K φ = ω² M φ. Those with equal frequencies, as in a ring, are
    any that are orthogonal. Raises ValueError, one line, for a duration or a state that is not allowed.

    >>> from burridge_knopoff import Model, block_frequencies, mode_amplitudes, simulate
    >>> model = Model("linearized", a=0.03).at(**{"mass[3]": 1.3})
    >>> run = simulate(model, initial="plus", transient=0, window=6000)
    >>> modes = mode_amplitudes(model, run.final)
    >>> modes.frequency.round(3).tolist()
    [0.167, 0.214, 0.342]
    >>> frequency, _ = block_frequencies(model, run.final)
    >>> modes.line_shares(frequency[0]).round(2).tolist()
    [0.0, 1.0, 0.0]
    """
    instance_of(model, Model, "model")
    if model.blocks**2 > MOST_NUMBERS:
        raise refusal("model.blocks", model.blocks, f"at most {int(MOST_NUMBERS**0.5)}, for a dense matrix")
    return modes_of(sampled_motion(model, state, duration))


def modes_of(motion: SampledMotion) -> ModeAmplitudes:
    """Return the amplitudes and phases of the normal modes along a motion, see `mode_amplitudes`."""
    model = motion.model
    frequency, shape = sliding_modes(model.chain)
    projection = (shape * model.chain.masses).T
    rate = (motion.velocity - model.v) @ projection / (2.0 * np.pi * frequency)
    oscillation = motion.position @ projection - 1j * rate
    return ModeAmplitudes(frequency, shape, motion.time, np.abs(oscillation), np.angle(oscillation))


def sliding_modes(chain: Chain) -> tuple[np.ndarray, np.ndarray]:
    """Return the frequencies of the modes, ascending, and their shapes: `frequency` and `shape` of `ModeAmplitudes`."""
    square, columns = eigh(chain.stiffness, np.diag(chain.masses))
    shape = columns.T
    moves = np.abs(shape) > AT_REST * np.abs(shape).max(axis=1, keepdims=True)
    first = shape[np.arange(len(shape)), moves.argmax(axis=1)]
    return np.sqrt(square) / (2.0 * np.pi), shape * np.sign(first)[:, None]
