"""The springs of a chain and the static friction of its blocks: the forces on blocks at given positions.

In co-moving coordinates x_i = U_i − vτ − e_i, with e the positions of uniform sliding, the spring force on block i is

    s_i = f_i − (K x)_i,    f_i = threshold_i Φ(v),

with K_ii the sum of all springs at block i and, off the diagonal, minus the springs to the blocks before and after it.
A ring has a spring between the last block and the first.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.springs import SLIDING, THRESHOLD
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors

# Steps of the power method, which tighten a bound on the eigenvalues in chains of a few blocks. In long ones the first
# bound, that of Gershgorin, is good already.
WIELANDT = 3


class Springs:
    """Springs of a chain of N blocks; all arrays have shape (blocks,).

    diagonal : K_ii; before, after : strengths of the springs to the blocks i − 1 and i + 1, 0 where there is none
    threshold : static friction; sliding_force : spring force f_i in uniform sliding

    Blocks also lie side by side in the lanes of vectors, LANES of them to each of `columns`; lanes beyond the last
    block have no springs and a threshold of 1, which nothing reaches.
    """

    blocks: cython.Py_ssize_t
    columns: cython.Py_ssize_t
    diagonal: cython.double[::1]
    before: cython.double[::1]
    after: cython.double[::1]
    threshold: cython.double[::1]
    sliding_force: cython.double[::1]
    previous: cython.Py_ssize_t[::1]
    next: cython.Py_ssize_t[::1]
    fastest: cython.double
    lanes: Vectors
    from_previous: Vectors
    from_next: Vectors

    def __init__(
        self,
        diagonal: np.ndarray,
        before: np.ndarray,
        after: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
    ) -> None:
        n = len(diagonal)
        self.blocks = n
        self.diagonal = np.array(diagonal, dtype=float)
        self.before = np.array(before, dtype=float)
        self.after = np.array(after, dtype=float)
        self.threshold = np.array(threshold, dtype=float)
        self.sliding_force = np.array(sliding_force, dtype=float)
        self.previous = (np.arange(n, dtype=np.intp) - 1) % n
        self.next = (np.arange(n, dtype=np.intp) + 1) % n
        # Root of the bound of Collatz and Wielandt on the largest eigenvalue of K: any positive vector gives one.
        vector = np.ones(n)
        for _ in range(WIELANDT):
            product = diagonal * vector + before * vector[self.previous] + after * vector[self.next]
            largest = (product / vector).max()
            vector = product / largest
        self.fastest = float(np.sqrt(largest))
        columns = (n + LANES - 1) // LANES
        self.columns = columns
        self.lanes = Vectors(5 * columns)
        table = np.zeros((5, columns * LANES))
        table[THRESHOLD] = 1.0
        table[:THRESHOLD, :n] = diagonal, before, after
        table[THRESHOLD, :n] = threshold
        table[SLIDING, :n] = sliding_force
        self.lanes.set(table.ravel())
        # Where a lane finds its neighbour: in the vector of the column before, or after, or in its own.
        previous = np.tile(np.arange(LANES) + LANES - 1, (columns, 1))
        previous[0, 0] = (n - 1) % LANES
        following = np.tile(np.arange(LANES) + 1, (columns, 1))
        following[-1, (n - 1) % LANES] = LANES if columns > 1 else 0
        if columns == 1:
            previous[0, 1:] -= LANES
            following[0] %= LANES
        self.from_previous = Vectors(columns)
        self.from_previous.set(previous.ravel().astype(np.int64).view(float))
        self.from_next = Vectors(columns)
        self.from_next.set(following.ravel().astype(np.int64).view(float))

    def pull(self, displacement: cython.pointer[cython.const[cython.double]], i: cython.Py_ssize_t) -> cython.double:
        """Return −(K x)_i for a row of displacements x, or of their rates.

        The neighbours are added first, so that a mirrored state has mirrored forces to the bit.
        """
        return (
            self.before[i] * displacement[self.previous[i]] + self.after[i] * displacement[self.next[i]]
        ) - self.diagonal[i] * displacement[i]
