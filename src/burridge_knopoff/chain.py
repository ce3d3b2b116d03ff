"""The chain: blocks coupled to their neighbours and to the driver by springs."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

MAXIMUM_BLOCKS = 1024


@dataclass(frozen=True)
class Chain:
    """N equal blocks in a row.

    Every spring between two blocks has strength 1; block i hangs on the driver by a spring of strength D_i, the number
    of its neighbours. The spring force on it is s_i = D_i vτ − (K U)_i with K = graph Laplacian + diag(D), so that
    K·1 = D. N = 3 is the paper's chain (Eq. 2), N = 2 the two-block train model that it cites.

    Raises ValueError if there are fewer than 2 or more than MAXIMUM_BLOCKS blocks.
    """

    blocks: int = 3

    def __post_init__(self) -> None:
        if isinstance(self.blocks, bool) or not isinstance(self.blocks, int):
            raise ValueError(f"blocks: {self.blocks!r} is not a whole number")
        if not 2 <= self.blocks <= MAXIMUM_BLOCKS:
            raise ValueError(f"blocks: {self.blocks} is not allowed: 2 to {MAXIMUM_BLOCKS}")

    @property
    def driving(self) -> np.ndarray:
        """Strengths D of the driving springs, shape (blocks,)."""
        driving = np.full(self.blocks, 2.0)
        driving[0] = driving[-1] = 1.0
        return driving

    @property
    def stiffness(self) -> np.ndarray:
        """The matrix K, shape (blocks, blocks); tridiagonal, 2 D_i on the diagonal and −1 beside it."""
        return np.diag(2.0 * self.driving) - np.eye(self.blocks, k=1) - np.eye(self.blocks, k=-1)

    def sliding_offset(self, friction: float) -> np.ndarray:
        """Return e with K e = −friction·1, shape (blocks,): uniform sliding is U_i = vτ + e_i under that friction."""
        # Elimination along the tridiagonal matrix. LAPACK's last bit depends on where in memory its arguments lie, and
        # with it would every number of a study that is run from another folder.
        pivot = 2.0 * self.driving
        load = np.ones(self.blocks)
        for i in range(1, self.blocks):
            pivot[i] -= 1.0 / pivot[i - 1]
            load[i] += load[i - 1] / pivot[i - 1]
        for i in range(self.blocks - 1, -1, -1):
            load[i] = (load[i] + (load[i + 1] if i + 1 < self.blocks else 0.0)) / pivot[i]
        # Mirror-symmetric to the bit, as the chain is.
        return -0.5 * friction * (load + load[::-1])
