"""The distance J(τ) between the two end blocks in phase space, over one piece: its values and its integral.

J = sqrt(d² + d'²) with d = x_N − x_1 is analytic wherever it is not 0. Gauss-Legendre quadrature with m nodes errs by
about the Legendre coefficient of degree 2m; those fall geometrically, so the last two that the nodes still resolve,
squared over the first, tell the error. A panel that fails is halved: near a close approach J is |z| of a complex
polynomial with a root near the real axis, and the halving closes in on it.

Reference: L. N. Trefethen, "Is Gauss quadrature better than Clenshaw-Curtis?", SIAM Rev. 50 (2008) 67-87.
"""

import cython
import numpy as np
from cython.cimports.libc.math import sqrt

NODES = 16
MAXIMUM_DEPTH = 40
RELATIVE_ERROR = 1e-15
ABSOLUTE_ERROR = 1e-17
NEGLIGIBLE = 1e-20

# The three-point rule, enough for the cubic pieces of a time-stepping solver, whose own error is larger.
THREE_POINT = 0.7745966692414834


def _legendre(degree, x):
    """Return the Legendre polynomials of this degree and of the two below it at x."""
    before, below, here = np.zeros_like(x), np.ones_like(x), x
    for n in range(2, degree + 1):
        before, below, here = below, here, ((2 * n - 1) * x * here - (n - 1) * below) / n
    return here, below, before


def _gauss_legendre(nodes):
    """Return nodes and weights on [-1, 1], and P_(nodes-1) and P_(nodes-2) at the nodes, all in long double.

    By Newton's method, not from LAPACK's eigenvalues, whose last bit depends on where in memory their arguments lie.
    """
    x = -np.cos(np.pi * (np.arange(nodes, dtype=np.longdouble) + 0.75) / (nodes + 0.5))
    for _iteration in range(6):
        here, below, _ = _legendre(nodes, x)
        slope = nodes * (below - x * here) / (1 - x * x)
        x = x - here / slope
    x = (x - x[::-1]) / 2
    here, below, before = _legendre(nodes, x)
    slope = nodes * (below - x * here) / (1 - x * x)
    return x, 2 / ((1 - x * x) * slope * slope), below, before


class Distance:
    """Polynomials of d and d' on the current piece and the quadrature rule for J."""

    def __init__(self, order: int) -> None:
        self.degree = 0
        self.position = np.zeros(order + 1)
        self.velocity = np.zeros(order + 1)
        node, weight, last, previous = _gauss_legendre(NODES)
        self.node = node.astype(float)
        self.weight = (weight / 2).astype(float)
        self.last = ((NODES - 0.5) * weight * last).astype(float)
        self.previous = ((NODES - 1.5) * weight * previous).astype(float)
        self.position_at = np.zeros(NODES)
        self.velocity_at = np.zeros(NODES)
        self.time_at = np.zeros(NODES)
        self.resting = False
        self.short = order <= 3

    def load(self, piece, length):
        """Take d and d' from a piece that is used up to `length`, leaving out terms that cannot matter there."""
        k: cython.Py_ssize_t
        end: cython.Py_ssize_t = piece.blocks
        power: cython.double = 1.0
        largest: cython.double = 0.0
        scaled: cython.double
        self.degree = 0
        self.resting = True
        for k in range(piece.degree + 1):
            self.position[k] = piece.position[k, end] - piece.position[k, 1]
            self.velocity[k] = piece.velocity[k, end] - piece.velocity[k, 1]
            scaled = max(abs(self.position[k]), abs(self.velocity[k])) * power
            largest = max(largest, scaled)
            if scaled > NEGLIGIBLE * largest:
                self.degree = k
            if k > 0 and scaled > 0.0:
                self.resting = False
            power *= length

    def value(self, t):
        """Return J at time t of the piece."""
        k: cython.Py_ssize_t
        d: cython.double = self.position[self.degree]
        rate: cython.double = self.velocity[self.degree]
        for k in range(self.degree - 1, -1, -1):
            d = d * t + self.position[k]
            rate = rate * t + self.velocity[k]
        return sqrt(d * d + rate * rate)

    def integral(self, start, stop):
        """Return the integral of J from start to stop, times of the piece."""
        middle: cython.double = 0.5 * (start + stop)
        half: cython.double = 0.5 * (stop - start)
        if self.resting:
            return (stop - start) * self.value(0.0)
        if self.short:
            return half * (
                5.0 * self.value(middle - half * THREE_POINT) / 9.0
                + 8.0 * self.value(middle) / 9.0
                + 5.0 * self.value(middle + half * THREE_POINT) / 9.0
            )
        return self._panel(start, stop, 0)

    def _panel(self, start, stop, depth):
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        middle: cython.double = 0.5 * (start + stop)
        half: cython.double = 0.5 * (stop - start)
        mean: cython.double = 0.0
        last: cython.double = 0.0
        previous: cython.double = 0.0
        error: cython.double
        value: cython.double
        for j in range(NODES):
            self.time_at[j] = middle + half * self.node[j]
            self.position_at[j] = self.position[self.degree]
            self.velocity_at[j] = self.velocity[self.degree]
        for k in range(self.degree - 1, -1, -1):
            value = self.position[k]
            for j in range(NODES):
                self.position_at[j] = self.position_at[j] * self.time_at[j] + value
            value = self.velocity[k]
            for j in range(NODES):
                self.velocity_at[j] = self.velocity_at[j] * self.time_at[j] + value
        for j in range(NODES):
            value = sqrt(self.position_at[j] * self.position_at[j] + self.velocity_at[j] * self.velocity_at[j])
            mean += self.weight[j] * value
            last += self.last[j] * value
            previous += self.previous[j] * value
        error = last * last + previous * previous
        if error <= (RELATIVE_ERROR * mean + ABSOLUTE_ERROR) * mean or depth >= MAXIMUM_DEPTH:
            return 2.0 * half * mean
        return self._panel(start, middle, depth + 1) + self._panel(middle, stop, depth + 1)
