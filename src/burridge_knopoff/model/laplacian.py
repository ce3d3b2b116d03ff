"""The matrices K of the springs and C of the dashpots: the graph Laplacian of a chain or network plus a diagonal."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.model.springs import Neighbours
from burridge_knopoff.values import read_only_copy

if TYPE_CHECKING:
    from scipy.sparse import csr_array


@dataclass(frozen=True, eq=False)
class Laplacian:
    """The matrix L with L_ij = −w_ij for neighbours i and j, and L_ii = Σ_j w_ij + g_i.

    neighbours : of each block
    weight : w_ij of each neighbour, in the order of `neighbours`, shape (n,)
    ground : g_i, the connection of block i to the driver, shape (blocks,)
    """

    neighbours: Neighbours
    weight: np.ndarray
    ground: np.ndarray

    @cached_property
    def diagonal(self) -> np.ndarray:
        """Diagonal of L, shape (blocks,)."""
        return read_only_copy(np.bincount(self.neighbours.block, self.weight, len(self.ground)) + self.ground)

    @cached_property
    def adjacency(self) -> csr_array:
        """The sparse matrix with w_ij for each neighbour j of each block i, shape (blocks, blocks)."""
        from scipy.sparse import csr_array

        blocks = len(self.ground)
        return csr_array((self.weight, self.neighbours.index, self.neighbours.start), (blocks, blocks))

    @cached_property
    def dense(self) -> np.ndarray:
        """L as an array, shape (blocks, blocks)."""
        matrix = np.diag(self.diagonal)
        np.subtract.at(matrix, (self.neighbours.block, self.neighbours.index), self.weight)
        return read_only_copy(matrix)

    @property
    def sparse(self) -> csr_array:
        """L as a sparse matrix of SciPy, shape (blocks, blocks)."""
        from scipy.sparse import diags_array

        matrix = (diags_array(self.diagonal) - self.adjacency).tocsr()
        matrix.sum_duplicates()
        return matrix

    def negative_product(self, values: np.ndarray) -> np.ndarray:
        """Return −L x for the values x of all blocks, shape (…, blocks)."""
        neighbour_sum = (self.adjacency @ values.reshape(-1, len(self.ground)).T).T.reshape(values.shape)
        return neighbour_sum - self.diagonal * values

    def eigenvalue_bound(self, masses: np.ndarray) -> float:
        """Return Gershgorin's upper bound on the eigenvalues of M⁻¹L for the diagonal matrix M of the masses."""
        bound = self.diagonal.copy()
        np.add.at(bound, self.neighbours.block, self.weight)
        return float((bound / masses).max())
