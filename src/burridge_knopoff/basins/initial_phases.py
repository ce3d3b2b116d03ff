"""Initial states given by phases: the end blocks, and optionally all others, oscillate about uniform sliding.

`summaries.phases` labels them by the attractors that they reach.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.sampling import seed_at


def has_free_ends(chain: Chain) -> bool:
    """Return whether the chain is a row of at least three blocks with open ends.

    A network has no ends. If a spring joins the end blocks, as with two blocks or in a ring, neither slides uniformly
    while the other oscillates, and K_ii does not give their frequencies: for two blocks and a spring k between them, ω²
    is K_11 − k with equal phases and K_11 + k with opposite ones; with other phases there is no single ω.
    """
    return chain.blocks > 2 and chain.ends == "open" and not chain.is_network


def single_block_frequencies(model: Model) -> np.ndarray:
    """Return the angular frequency ω of each block while its neighbours slide uniformly, shape (blocks,).

    ω² = K_ii/m_i: in the paper's chain 2 for the end blocks and 4 for the inner one. Opposite phases of the end blocks
    are a normal mode of the sliding chain of three blocks, in which the inner one does not oscillate. The slope of the
    friction law, which makes oscillations grow, reduces ω by a fraction of at most a²/16.

    Raises ValueError, one line, unless the chain is a row with open ends: see `has_free_ends`.
    """
    chain = model.chain
    if not has_free_ends(chain):
        text = f"{chain.blocks} blocks, {'network' if chain.is_network else chain.ends}"
        raise ValueError(
            f"chain: got {text}, expected a row of at least three blocks with open ends, for states given by phases"
        )
    return np.sqrt(chain.diagonal / chain.masses)


def slipping_amplitude(model: Model, inner_share: float = 0.0) -> float:
    """Return the amplitude A of the end blocks up to which all velocities are positive for all phases.

    inner_share : amplitude of the inner blocks divided by A

    The velocity of a block stays positive if its own amplitude is below v/ω.
    """
    frequencies = single_block_frequencies(model)
    frequencies[1:-1] *= inner_share
    return float(model.v / frequencies.max())


def oscillating_states(
    model: Model,
    amplitude: np.ndarray,
    phase_difference: np.ndarray,
    common_phase: np.ndarray,
    inner_share: float = 0.0,
    inner_phase: np.ndarray | float = 0.0,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states U(0) and U'(0), shape (n, blocks), and whether a block of each is at rest, shape (n,).

    amplitude : A of both end blocks, shape (n,)
    common_phase, phase_difference : θ of the first block and δ, in degrees, shape (n,)
    inner_share : amplitude of all other (inner) blocks divided by A
    inner_phase : θ_i of the inner blocks, in degrees, shape (n, blocks − 2)

    In co-moving coordinates x_1 = A cos θ and x_N = A cos(θ + δ), with U_1' = v − Aω sin θ and
    U_N' = v − Aω sin(θ + δ); x_i = share · A cos θ_i, with U_i' = v − share · Aω_i sin θ_i, for each inner block, at
    its frequency while its neighbours do not oscillate. With a share of 0 the inner blocks slide uniformly, x_i = 0 and
    U_i' = v. No block slips backward: if its oscillation has U' < 0, which is only possible above
    `slipping_amplitude`, the block is at rest.
    """
    angle = np.empty((len(amplitude), model.chain.blocks))
    angle[:, 0], angle[:, -1], angle[:, 1:-1] = common_phase, common_phase + phase_difference, inner_phase
    angle = np.radians(angle)
    amplitudes = np.tile(amplitude[:, None], angle.shape[1])
    amplitudes[:, 1:-1] *= inner_share
    position = model.sliding_offset + amplitudes * np.cos(angle)
    velocity = model.v - amplitudes * single_block_frequencies(model) * np.sin(angle)
    standing: np.ndarray = np.any(velocity < 0.0, axis=1)
    return position, np.maximum(velocity, 0.0), standing


def common_phases(a: float, shape: tuple[int, ...], seed: int) -> np.ndarray:
    """Return phases of the first block in degrees, uniform in [0, 360); those of different a are independent."""
    return 360.0 * np.random.default_rng(seed_at(seed, a)).random(shape)


def inner_phases(a: float, shape: tuple[int, ...], seed: int) -> np.ndarray:
    """Return phases of the inner blocks as `common_phases` does, independent of those."""
    return 360.0 * np.random.default_rng([*seed_at(seed, a), 1]).random(shape)
