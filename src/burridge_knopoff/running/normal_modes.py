"""Normal modes of consecutive slipping blocks in a uniform chain, correct to about the last bit."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.chain import Chain

# Largest number of blocks whose modes are refined: long double has no fast matrix product, and for more blocks the
# refinement would take longer than the simulation.
REFINEMENT_LIMIT = 32


def normal_modes(chain: Chain, first: int, last: int) -> tuple[np.ndarray, np.ndarray]:
    """Return eigenvalues λ, shape (n,), and modes, one per row, shape (n, n), of K restricted to blocks first … last.

    Mirror-image sets of blocks have mirror-image modes, to the bit.
    """
    length = last - first + 1
    ends = (first == 0, last == chain.blocks - 1)
    diagonal = chain.diagonal[first : last + 1]
    coupling = chain.coupling_to_next[0]
    # Blocks that include the right end only are the mirror image of blocks that include the left end only.
    mirrored = ends[1] and not ends[0]
    if mirrored:
        diagonal = diagonal[::-1]
    matrix = np.diag(diagonal) - coupling * (np.eye(length, k=1) + np.eye(length, k=-1))
    eigenvalue, vector = np.linalg.eigh(matrix)
    if length <= REFINEMENT_LIMIT:
        eigenvalue, vector = _refine(matrix, eigenvalue, vector)
    if mirrored:
        vector = vector[::-1]
    elif ends[0] == ends[1]:
        # The modes of a symmetric set of blocks are even or odd; this makes them so to the bit.
        parity = np.sign((vector * vector[::-1]).sum(axis=0))
        vector = 0.5 * (vector + parity * vector[::-1])
    return eigenvalue, np.ascontiguousarray(vector.T)


def _refine(matrix: np.ndarray, eigenvalue: np.ndarray, vector: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return eigenvalues and eigenvectors (columns) correct to about the last bit, by one Newton step in long double.

    An error in the modes is the same at every event and accumulates, whereas rounding errors average out.
    Reference: T. Ogita and K. Aishima, Jpn. J. Ind. Appl. Math. 35 (2018) 1007-1035.
    """
    long_matrix = matrix.astype(np.longdouble)
    long_vector = vector.astype(np.longdouble)
    size = len(eigenvalue)
    defect = np.eye(size) - long_vector.T @ long_vector
    projected = long_vector.T @ long_matrix @ long_vector
    values = np.diag(projected) / (1 - np.diag(defect))
    gap = values[None, :] - values[:, None] + np.eye(size)
    correction = (projected + values[None, :] * defect) / gap
    correction[np.arange(size), np.arange(size)] = np.diag(defect) / 2
    return values.astype(float), (long_vector + long_vector @ correction).astype(float)
