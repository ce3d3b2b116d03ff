"""A table that grows: one time and a few values a row, for events and section crossings."""

import cython
import numpy as np

from burridge_knopoff.values import MOST_NUMBERS


class Record:
    """Rows of a time and `width` values; `append` makes room for a row and returns its number.

    A table of MOST_NUMBERS is `full`: no row is added any more.
    """

    width: cython.Py_ssize_t
    count: cython.Py_ssize_t
    most: cython.Py_ssize_t
    full: cython.bint
    time: cython.double[::1]
    value: cython.double[:, ::1]

    def __init__(self, width: int) -> None:
        self.width = width
        self.count = 0
        self.most = int(MOST_NUMBERS) // (width + 1)
        self.full = False
        self.time = np.zeros(1024)
        self.value = np.zeros((1024, width))

    def append(self, time: cython.double) -> cython.Py_ssize_t:
        """Add a row at this time and return its number; of a full table that of the last row, which is overwritten."""
        if self.count >= self.most:
            self.full = True
            return self.count - 1
        if self.count == self.time.shape[0]:
            self._grow()
        self.time[self.count] = time
        self.count += 1
        return self.count - 1

    def _grow(self) -> cython.int:
        time = np.zeros(2 * self.count)
        time[: self.count] = self.time
        value = np.zeros((2 * self.count, self.width))
        value[: self.count] = self.value
        self.time = time
        self.value = value
        return 0

    def times(self) -> np.ndarray:
        """Return the times so far, shape (count,): not a copy of what may be long."""
        return np.asarray(self.time)[: self.count]

    def values(self) -> np.ndarray:
        """Return the values so far, shape (count, width): not a copy either."""
        return np.asarray(self.value)[: self.count]
