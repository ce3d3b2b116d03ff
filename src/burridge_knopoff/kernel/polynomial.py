"""One polynomial over one piece of the motion."""

import cython
import numpy as np


def evaluate(coefficient, column, degree, t):
    """Return the value at t of the polynomial whose coefficients are one column of a table, lowest power first."""
    k: cython.Py_ssize_t
    total: cython.double = coefficient[degree, column]
    for k in range(degree - 1, -1, -1):
        total = total * t + coefficient[k, column]
    return total


def evaluate_slope(coefficient, column, degree, t):
    """Return the derivative at t of the polynomial in one column of a table."""
    k: cython.Py_ssize_t
    total: cython.double = 0.0
    for k in range(degree, 0, -1):
        total = total * t + k * coefficient[k, column]
    return total


class Polynomial:
    """A polynomial Σ c_k t^k that callers fill and then search; `coefficient` has shape (capacity + 1,)."""

    def __init__(self, capacity: int) -> None:
        self.capacity = capacity
        self.degree = 0
        self.coefficient = np.zeros(capacity + 1)

    def value(self, t):
        """Return the value at t."""
        k: cython.Py_ssize_t
        total: cython.double = self.coefficient[self.degree]
        for k in range(self.degree - 1, -1, -1):
            total = total * t + self.coefficient[k]
        return total

    def slope(self, t):
        """Return the derivative at t."""
        k: cython.Py_ssize_t
        total: cython.double = 0.0
        for k in range(self.degree, 0, -1):
            total = total * t + k * self.coefficient[k]
        return total

    def deflate(self):
        """Divide out the roots at t = 0 (leading coefficients that are exactly 0); return how many there were.

        A polynomial that is identically zero keeps one coefficient, 0.
        """
        k: cython.Py_ssize_t
        zeros: cython.Py_ssize_t = 0
        while zeros < self.degree and self.coefficient[zeros] == 0.0:
            zeros += 1
        if zeros > 0:
            for k in range(self.degree - zeros + 1):
                self.coefficient[k] = self.coefficient[k + zeros]
            self.degree -= zeros
        return zeros

    def shift(self, t):
        """Move the origin to t: the polynomial p(t + ·)."""
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for j in range(self.degree):
            for k in range(self.degree - 1, j - 1, -1):
                self.coefficient[k] += t * self.coefficient[k + 1]

    def negate(self):
        """Change the sign of the polynomial."""
        k: cython.Py_ssize_t
        for k in range(self.degree + 1):
            self.coefficient[k] = -self.coefficient[k]
