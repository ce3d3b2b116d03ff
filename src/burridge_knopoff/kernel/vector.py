"""Rows of vectors in memory; the vectors themselves are in `vector.pxd`."""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.vector import LANES, aligned, vec

#: Doubles in a vector.
WIDTH = LANES


class Vectors:
    """`count` vectors, zero at first: `at[k]` is the k-th."""

    count: cython.Py_ssize_t
    storage: cython.double[::1]
    at: cython.pointer[vec]

    def __init__(self, count: int) -> None:
        self.count = count
        self.storage = np.zeros((count + 1) * LANES)
        self.at = aligned(cython.address(self.storage[0]))

    def set(self, values: np.ndarray) -> None:
        """Set all lanes of all vectors, shape (count · LANES,)."""
        self.table(1)[0] = values

    def table(self, rows: int) -> np.ndarray:
        """Return the same memory as a table of doubles, shape (rows, count · LANES / rows)."""
        start: cython.Py_ssize_t = cython.cast(cython.p_double, self.at) - cython.address(self.storage[0])
        whole = np.asarray(self.storage)
        return whole[start : start + self.count * LANES].reshape(rows, -1)
