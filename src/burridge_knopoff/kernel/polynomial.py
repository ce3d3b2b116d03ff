"""One polynomial over one piece of the motion."""

import cython
import numpy as np


def evaluate(
    coefficient: cython.double[:, ::1], column: cython.Py_ssize_t, degree: cython.Py_ssize_t, t: cython.double
) -> cython.double:
    """Return the value at t of the polynomial whose coefficients are one column of a table, lowest power first."""
    k: cython.Py_ssize_t
    total: cython.double = coefficient[degree, column]
    for k in range(degree - 1, -1, -1):
        total = total * t + coefficient[k, column]
    return total


def evaluate_slope(
    coefficient: cython.double[:, ::1], column: cython.Py_ssize_t, degree: cython.Py_ssize_t, t: cython.double
) -> cython.double:
    """Return the derivative at t of the polynomial in one column of a table."""
    k: cython.Py_ssize_t
    total: cython.double = 0.0
    for k in range(degree, 0, -1):
        total = total * t + k * coefficient[k, column]
    return total


class Polynomial:
    """A polynomial Σ c_k t^k that callers fill and then search; `coefficient[k]` is c_k, 0 beyond the degree.

    Rows of `table` hold the coefficients, those of the first and of the second derivative, where they were asked for.
    """

    capacity: cython.Py_ssize_t
    degree: cython.Py_ssize_t
    table: cython.double[:, ::1]
    coefficient: cython.double[::1]

    def __init__(self, capacity: int) -> None:
        self.capacity = capacity
        self.degree = 0
        self.table = np.zeros((3, (capacity // 8 + 1) * 8))
        self.coefficient = self.table[0]

    def derive(self, row: cython.Py_ssize_t) -> None:
        """Fill the next row with the derivative of the polynomial in this one."""
        k: cython.Py_ssize_t
        for k in range(self.degree // 8 * 8 + 8 - 1):
            self.table[row + 1, k] = (k + 1.0) * self.table[row, k + 1]

    def at(self, row: cython.Py_ssize_t, t: cython.double) -> cython.double:
        """Return the value at t of the polynomial in a row: eight sums side by side, as each waits for the last."""
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t = self.degree // 8 * 8
        square: cython.double = t * t
        fourth: cython.double = square * square
        eighth: cython.double = fourth * fourth
        total = cython.declare(cython.double[8])
        for j in range(8):
            total[j] = self.table[row, k + j]
        while k > 0:
            k -= 8
            for j in range(8):
                total[j] = total[j] * eighth + self.table[row, k + j]
        return ((total[0] + t * total[1]) + square * (total[2] + t * total[3])) + fourth * (
            (total[4] + t * total[5]) + square * (total[6] + t * total[7])
        )

    def value(self, t: cython.double) -> cython.double:
        """Return the value at t."""
        return self.at(0, t)

    def slope(self, t: cython.double) -> cython.double:
        """Return the derivative at t."""
        self.derive(0)
        return self.at(1, t)

    def deflate(self) -> cython.Py_ssize_t:
        """Divide out the roots at t = 0 (leading coefficients that are exactly 0); return how many there were.

        A polynomial that is identically zero keeps one coefficient, 0.
        """
        k: cython.Py_ssize_t
        zeros: cython.Py_ssize_t = 0
        while zeros < self.degree and self.coefficient[zeros] == 0.0:
            zeros += 1
        if zeros > 0:
            for k in range(self.degree + 1):
                self.coefficient[k] = self.coefficient[k + zeros] if k + zeros <= self.degree else 0.0
            self.degree -= zeros
        return zeros

    def shift(self, t: cython.double) -> None:
        """Move the origin to t: the polynomial p(t + ·)."""
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for j in range(self.degree):
            for k in range(self.degree - 1, j - 1, -1):
                self.coefficient[k] += t * self.coefficient[k + 1]

    def negate(self) -> None:
        """Change the sign of the polynomial."""
        k: cython.Py_ssize_t
        for k in range(self.degree + 1):
            self.coefficient[k] = -self.coefficient[k]
