"""The distance J(τ) between the two end blocks in phase space, over one piece: its values and its integral.

J = sqrt(d² + d'²) with d = U_N − U_1 is analytic wherever it is not 0. Gauss-Legendre quadrature with m nodes errs by
about the Legendre coefficient of degree 2m; those fall geometrically, so the last two that the nodes still resolve,
squared over the first, estimate the error. A panel that fails is halved: near a close approach J is |z| of a complex
polynomial with a root near the real axis, and the halving closes in on it.

Reference: L. N. Trefethen, "Is Gauss quadrature better than Clenshaw-Curtis?", SIAM Rev. 50 (2008) 67-87.
"""

from functools import cache

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.piece import ORDER, Piece
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, root, splat, sum_of_eight, vec
from cython.cimports.libc.math import sqrt

NODES = 16
MAXIMUM_DEPTH = 40
RELATIVE_ERROR = 1e-15
ABSOLUTE_ERROR = 1e-17

# The three-point rule, enough for the cubic pieces of a time-stepping solver, whose own error is larger.
THREE_POINT = 0.7745966692414834


def _legendre(degree, x):
    """Return the Legendre polynomials of this degree and of the two below it at x."""
    before, below, here = np.zeros_like(x), np.ones_like(x), x
    for n in range(2, degree + 1):
        before, below, here = below, here, ((2 * n - 1) * x * here - (n - 1) * below) / n
    return here, below, before


@cache
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
    """Polynomials of d and d' on the current piece and the quadrature rule for J.

    apart : d in uniform sliding; positions are relative to it
    """

    degree: cython.Py_ssize_t
    apart: cython.double
    position: cython.double[::1]
    velocity: cython.double[::1]
    node: cython.double[::1]
    weight: cython.double[::1]
    last: cython.double[::1]
    previous: cython.double[::1]
    nodes: Vectors
    value_at_node: Vectors
    values: cython.double[::1]
    resting: cython.bint
    short: cython.bint

    def __init__(self, order: int, apart: float) -> None:
        self.degree = 0
        self.apart = apart
        self.position = np.zeros(order + 2)
        self.velocity = np.zeros(order + 2)
        node, weight, last, previous = _gauss_legendre(NODES)
        self.node = node.astype(float)
        self.weight = (weight / 2).astype(float)
        self.last = ((NODES - 0.5) * weight * last).astype(float)
        self.previous = ((NODES - 1.5) * weight * previous).astype(float)
        self.nodes = Vectors(NODES // LANES)
        self.nodes.set(self.node)
        self.value_at_node = Vectors(NODES // LANES)
        self.values = self.value_at_node.table(1)[0]
        self.resting = False
        self.short = order <= 3

    def load(self, piece: Piece) -> None:
        """Take d and d' from a piece."""
        k: cython.Py_ssize_t
        end: cython.Py_ssize_t = piece.blocks - 1
        self.degree = piece.degree
        for k in range(piece.degree + 1):
            self.position[k] = piece.position[k, end] - piece.position[k, 0]
            self.velocity[k] = piece.velocity[k, end] - piece.velocity[k, 0]
        self.position[0] += self.apart
        self.resting = self.velocity[0] == 0.0
        k = 1
        while self.resting and k <= piece.degree:
            self.resting = self.position[k] == 0.0 and self.velocity[k] == 0.0
            k += 1

    def value(self, t: cython.double) -> cython.double:
        """Return J at time t of the piece."""
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.degree // 2
        square: cython.double = t * t
        d: cython.double = self.position[2 * n]
        rate: cython.double = self.velocity[2 * n]
        odd_d: cython.double = self.position[2 * n + 1]
        odd_rate: cython.double = self.velocity[2 * n + 1]
        # Even and odd powers apart, since each sum waits for the last.
        for k in range(n - 1, -1, -1):
            d = d * square + self.position[2 * k]
            rate = rate * square + self.velocity[2 * k]
            odd_d = odd_d * square + self.position[2 * k + 1]
            odd_rate = odd_rate * square + self.velocity[2 * k + 1]
        d += t * odd_d
        rate += t * odd_rate
        return sqrt(d * d + rate * rate)

    def integral(self, start: cython.double, stop: cython.double) -> cython.double:
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

    def _panel(self, start: cython.double, stop: cython.double, depth: cython.int) -> cython.double:
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t
        middle: cython.double = 0.5 * (start + stop)
        half: cython.double = 0.5 * (stop - start)
        mean: cython.double
        last: cython.double
        previous: cython.double
        error: cython.double
        means = cython.declare(cython.double[8])
        lasts = cython.declare(cython.double[8])
        previouses = cython.declare(cython.double[8])
        t: vec
        square: vec
        position: vec
        velocity: vec
        odd_position: vec
        odd_velocity: vec
        n = ORDER // 2
        for j in range(NODES // LANES):
            t = middle + half * self.nodes.at[j]
            square = t * t
            position = splat(self.position[2 * n])
            velocity = splat(self.velocity[2 * n])
            odd_position = splat(self.position[2 * n + 1])
            odd_velocity = splat(self.velocity[2 * n + 1])
            for k in range(n - 1, -1, -1):
                position = position * square + self.position[2 * k]
                velocity = velocity * square + self.velocity[2 * k]
                odd_position = odd_position * square + self.position[2 * k + 1]
                odd_velocity = odd_velocity * square + self.velocity[2 * k + 1]
            position = position + t * odd_position
            velocity = velocity + t * odd_velocity
            self.value_at_node.at[j] = root(position * position + velocity * velocity)
        for j in range(8):
            means[j] = self.weight[j] * self.values[j] + self.weight[j + 8] * self.values[j + 8]
            lasts[j] = self.last[j] * self.values[j] + self.last[j + 8] * self.values[j + 8]
            previouses[j] = self.previous[j] * self.values[j] + self.previous[j + 8] * self.values[j + 8]
        mean = sum_of_eight(means)
        last = sum_of_eight(lasts)
        previous = sum_of_eight(previouses)
        error = last * last + previous * previous
        if error <= (RELATIVE_ERROR * mean + ABSOLUTE_ERROR) * mean or depth >= MAXIMUM_DEPTH:
            return 2.0 * half * mean
        return self._panel(start, middle, depth + 1) + self._panel(middle, stop, depth + 1)
