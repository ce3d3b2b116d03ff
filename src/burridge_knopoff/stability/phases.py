"""Initial states by their phases: end blocks that oscillate about uniform sliding, all other blocks on it.

`summaries.phases` labels them by the attractors that they reach.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import Model


def end_frequencies(model: Model) -> np.ndarray:
    """Return the angular frequencies ω of the first and the last block while their neighbours slide uniformly.

    ω² = K_ii, 2 in the paper's chain. Opposite phases at this frequency are a normal mode of the sliding chain of three
    blocks, in which the middle one does not oscillate. The slope of the friction law, which lets oscillations grow,
    makes ω smaller by the share a²/16 at most.
    """
    return np.sqrt(model.chain.diagonal[[0, -1]])


def slipping_amplitude(model: Model) -> float:
    """Return v/ω, the amplitude up to which the velocity of an end block stays positive all the time."""
    return float(model.v / end_frequencies(model).max())


def oscillating_states(
    model: Model, amplitude: np.ndarray, phase_difference: np.ndarray, common_phase: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return states U(0) and U'(0) by the phases of the end blocks, shape (n, blocks), and where a block stands, (n,).

    amplitude : A, shape (n,); common_phase, phase_difference : θ of the first block and δ, in degrees, shape (n,)

    In co-moving coordinates x_1 = A cos θ and x_N = A cos(θ + δ), with U_1' = v − Aω sin θ and
    U_N' = v − Aω sin(θ + δ); all other blocks slide uniformly, x_i = 0 and U_i' = v. No block slips backward: where an
    oscillation would take it there, which happens above `slipping_amplitude` only, the block stands, U' = 0.
    """
    position = np.tile(model.sliding_offset, (len(amplitude), 1))
    velocity = np.full(position.shape, model.v)
    ends = zip((0, -1), (0.0, phase_difference), end_frequencies(model), strict=True)
    for block, ahead, frequency in ends:
        angle = np.radians(common_phase + ahead)
        position[:, block] += amplitude * np.cos(angle)
        velocity[:, block] -= amplitude * frequency * np.sin(angle)
    standing: np.ndarray = np.any(velocity < 0.0, axis=1)
    return position, np.maximum(velocity, 0.0), standing


def common_phases(a: float, shape: tuple[int, ...], seed: int) -> np.ndarray:
    """Return phases of the first block in degrees, uniform in [0, 360); those of different a are independent."""
    generator = np.random.default_rng([seed, int(np.float64(a).view(np.uint64))])
    return 360.0 * generator.random(shape)
