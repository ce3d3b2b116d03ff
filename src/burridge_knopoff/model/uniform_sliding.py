"""Uniform sliding, the equilibrium at which all blocks slip at v, and the eigenvalues of its Jacobian."""

from __future__ import annotations

import numpy as np
from scipy.linalg import eigvalsh, eigvalsh_tridiagonal

from burridge_knopoff.model.model import ChainState, Model

# Significant digits of results of LAPACK, whose last bits depend on the machine.
DIGITS = 12


def sliding_state(model: Model) -> ChainState:
    """Return the state of uniform sliding."""
    blocks = model.blocks
    return ChainState(np.zeros(blocks), np.full(blocks, model.v), np.zeros(blocks, dtype=bool))


def jacobian(model: Model) -> np.ndarray:
    """Return the Jacobian of the flow at uniform sliding, over positions and velocities, shape (2 blocks, 2 blocks)."""
    chain, blocks, masses = model.chain, model.blocks, model.chain.masses[:, None]
    damping = chain.damping_matrix + np.diag(chain.thresholds * _sliding_slope(model))
    return np.block([[np.zeros((blocks, blocks)), np.eye(blocks)], [-chain.stiffness / masses, -damping / masses]])


def negative_damping(model: Model) -> np.ndarray:
    """Return g = −threshold·dΦ(w U')/dU'/m of each block at the velocity of the driver, shape (blocks,)."""
    return -model.chain.thresholds * _sliding_slope(model) / model.chain.masses


def _sliding_slope(model: Model) -> np.ndarray:
    return model.friction_slope(np.full(model.blocks, model.v))


def eigenvalues(model: Model) -> np.ndarray:
    """Return the eigenvalues of the Jacobian at uniform sliding, complex, shape (2 blocks,).

    They are ordered from the slowest oscillation to the fastest, with the positive imaginary part of a pair first;
    non-oscillating ones precede these in order of decreasing growth rate.
    """
    stiffness, rates, root = model.chain.stiffness, negative_damping(model), np.sqrt(model.chain.masses)
    if model.chain.is_damped or (rates != rates[0]).any():
        exact = np.linalg.eigvals(jacobian(model))
        spectrum = [complex(round_digits(value.real), round_digits(value.imag)) for value in exact]
        return np.array(sorted(spectrum, key=lambda value: (abs(value.imag), value.imag < 0.0, -value.real)))
    half = 0.5 * rates[0]
    # The symmetric matrix M^(−1/2) K M^(−1/2) has the eigenvalues of M⁻¹K.
    stiffness = stiffness / np.outer(root, root)
    if model.chain.ends == "ring" or model.chain.is_network:
        kappa = eigvalsh(stiffness)
    else:
        kappa = eigvalsh_tridiagonal(np.diag(stiffness), np.diag(stiffness, 1), lapack_driver="sterf")
    square = kappa - half**2
    shift = np.array([round_digits(value) for value in np.sqrt(np.abs(square))])
    # A mode that does not oscillate has two real eigenvalues.
    shift = np.where(square > 0.0, 1j, 1.0) * shift
    return (half + shift[:, None] * np.array([1.0, -1.0])).ravel()


def is_sliding_attracting(model: Model) -> bool:
    """Return whether uniform sliding attracts: every small perturbation decays."""
    return bool((eigenvalues(model).real < 0.0).all())


def round_digits(value: float) -> float:
    """Return a number rounded to the digits on which all machines agree."""
    return float(f"{value:.{DIGITS - 1}e}")
