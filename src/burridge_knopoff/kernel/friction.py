"""Friction as the kernel computes it: the operations of a law's tape, on numbers and on Taylor series in lanes.

An operation makes one register of earlier ones, register 0 being the slip speed; see `laws.tape`. A coefficient of a
register follows from coefficients of the same and of lower order, by the recurrences of the reference (in the .pxd).

Reference: A. Griewank and A. Walther, "Evaluating Derivatives" (SIAM 2008), Chapter 13.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import (
    EXP,
    LINEAR,
    MULTIPLY,
    POWER,
    RECIPROCAL,
    fill,
    row,
    slopes,
    squares,
)
from cython.cimports.burridge_knopoff.kernel.vector import Vectors, bits, lane_of, less, magnitude, splat, vec
from cython.cimports.libc.math import exp, log
from cython.cimports.libc.math import pow as power

# Rounding of friction at rest.
ROUNDING = 1e-12

# How far the argument of an exponential may change in a series, per order. Its coefficients y_n follow from p_n, those
# of the argument, by n y_n = Σ k p_k y_(n−k). Where Σ k |p_k| t^k is at most n/2, terms from n on are at most half of
# the largest before. Else they grow unseen from next to nothing, as exp(−U'/w) does where a block brakes.
FOLLOWED = 0.5

# Modulus of the argument beyond which an exponential, or its reciprocal, is less than what rounding leaves of friction.
SPENT = 50.0

# Codes and registers of a multiple of the reciprocal of a straight line.
HYPERBOLIC = [(LINEAR, 0, -1), (RECIPROCAL, 1, -1), (LINEAR, 2, -1)]


class Friction:
    """One law for `columns` vectors of blocks.

    operations, constants : the tape, shape (n, 3) each; value, slope : registers of Φ and of its slope
    linear : whether Φ is the straight line Φ(0) − rate·U'; it then needs no series
    exponential : whether an operation is EXP, see `shorten`
    rate : −dΦ/dU' at rest; steepest : largest modulus of threshold times slope that occurs
    """

    value: cython.int
    slope: cython.int
    linear: cython.bint
    exponential: cython.bint
    hyperbolic: cython.bint
    scale: cython.double
    rate: cython.double
    steepest: cython.double
    at_rest: cython.double
    columns: cython.Py_ssize_t
    length: cython.Py_ssize_t
    operation: cython.int[:, ::1]
    constant: cython.double[:, ::1]
    reciprocal: cython.double[::1]
    register: Vectors
    inverse: Vectors
    slopes: Vectors
    number: cython.double[::1]

    def __init__(
        self,
        operations: np.ndarray,
        constants: np.ndarray,
        value: int,
        slope: int,
        linear: bool,
        rate: float,
        steepest: float,
        columns: int,
        order: int,
    ) -> None:
        self.operation = np.array(operations, dtype=np.intc)
        self.constant = np.array(constants, dtype=float)
        self.value = value
        self.slope = slope
        self.linear = linear
        self.exponential = any(operation[0] == EXP for operation in operations[:value])
        # Whether Φ is a multiple of the reciprocal of a straight line, the most usual law, which has a loop of its own.
        shape = [tuple(operation) for operation in operations[:value]]
        self.hyperbolic = shape in (HYPERBOLIC, HYPERBOLIC[:2])
        self.scale = constants[value - 1][0] if len(shape) == 3 else 1.0
        self.rate = rate
        self.steepest = steepest
        self.columns = columns
        self.length = order + 1
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 2, dtype=float), 1.0)
        self.register = Vectors((len(operations) + 1) * columns * self.length)
        # One over the leading coefficient of the register that a power or a logarithm reads.
        self.inverse = Vectors((len(operations) + 1) * columns)
        self.slopes = Vectors((value + 1) * columns)
        self.number = np.zeros(len(operations) + 1)
        self.at_rest = self.at(0.0)
        if abs(self.at_rest - 1.0) < ROUNDING:
            # Exactly 1: rounding must not give a block an acceleration at its start.
            self.at_rest = 1.0

    def at(self, speed: cython.double) -> cython.double:
        """Return Φ at a speed."""
        r: cython.Py_ssize_t
        code: cython.int
        p: cython.double
        made: cython.double
        second: cython.Py_ssize_t
        self.number[0] = speed
        for r in range(self.value):
            code = self.operation[r, 0]
            p = self.number[self.operation[r, 1]]
            second = self.operation[r, 2]
            if code == LINEAR:
                made = self.constant[r, 0] * p + self.constant[r, 2]
                if second >= 0:
                    made += self.constant[r, 1] * self.number[second]
            elif code == MULTIPLY:
                made = p * self.number[second]
            elif code == RECIPROCAL:
                made = 1.0 / p
            elif code == POWER:
                made = power(p, self.constant[r, 0])
            elif code == EXP:
                made = exp(p)
            else:
                made = log(p)
            self.number[r + 1] = made
        return self.number[self.value]

    def shorten(self, t: cython.double) -> cython.double:
        """Return a time, t or a part of it, over which every exponential is followed or spent."""
        while not self._is_followed(t):
            t *= 0.5
        return t

    def _is_followed(self, t: cython.double) -> cython.bint:
        """Tell whether every exponential is followed or spent up to t.

        All coefficients but the last have been filled.
        """
        r: cython.int
        c: cython.Py_ssize_t
        k: cython.Py_ssize_t
        total: vec
        limit: vec = splat(FOLLOWED * (self.length - 1))
        argument: cython.pointer[vec]
        for r in range(self.value):
            if self.operation[r, 0] == EXP:
                for c in range(self.columns):
                    argument = row(self, self.operation[r, 1], c)
                    total = splat(0.0)
                    for k in range(self.length - 2, 0, -1):
                        total = (total + cython.cast(cython.double, k) * magnitude(argument[k])) * t
                    if bits(less(limit, total) & less(magnitude(argument[0]) - splat(SPENT), total)):
                        return False
        return True

    def start(self, column: cython.Py_ssize_t, speed: vec) -> None:
        """Fill coefficient 0 of all registers from a speed, and their derivatives by it."""
        r: cython.int
        line: vec
        inverse: vec
        if self.hyperbolic:
            line = self.constant[0, 0] * speed + self.constant[0, 2]
            inverse = splat(1.0) / line
            row(self, 1, column)[0] = line
            row(self, 2, column)[0] = inverse
            slopes(self, column)[1] = splat(self.constant[0, 0])
            slopes(self, column)[2] = -((self.constant[0, 0] * inverse) * inverse)
            if self.value == 3:
                row(self, 3, column)[0] = self.constant[2, 0] * inverse + self.constant[2, 2]
                slopes(self, column)[3] = self.constant[2, 0] * slopes(self, column)[2]
            return
        row(self, 0, column)[0] = speed
        self.extend(column, 0, 0, self.value)
        # In a series whose speed is linear in time, with slope 1, coefficients of first order are the derivatives.
        row(self, 0, column)[1] = splat(1.0)
        self.extend(column, 1, 0, self.value)
        for r in range(self.value + 1):
            slopes(self, column)[r] = row(self, r, column)[1]

    def extend(self, column: cython.Py_ssize_t, n: cython.Py_ssize_t, first: cython.int, last: cython.int) -> None:
        """Do the work of `fill` where it need not be inline."""
        fill(self, column, n, first, last)

    def complete(self, column: cython.Py_ssize_t, first: cython.Py_ssize_t, count: cython.Py_ssize_t) -> None:
        """Fill coefficients first … count − 1 of the registers of the slope, when those of Φ are complete."""
        r: cython.int
        n: cython.Py_ssize_t
        alpha: cython.double
        p: cython.pointer[vec]
        out: cython.pointer[vec]
        for r in range(self.value, self.slope):
            alpha = self.constant[r, 0]
            p = row(self, self.operation[r, 1], column)
            out = row(self, r + 1, column)
            if self.operation[r, 0] == MULTIPLY and self.operation[r, 1] == self.operation[r, 2]:
                squares(p, out, first, count)
            elif self.operation[r, 0] == LINEAR and self.operation[r, 2] < 0:
                for n in range(first, count):
                    out[n] = alpha * p[n]
                if first == 0:
                    out[0] = out[0] + self.constant[r, 2]
            else:
                for n in range(first, count):
                    fill(self, column, n, r, r + 1)

    def series(self, speed: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the Taylor coefficients of Φ and of its slope along a motion, each of the shape of those of the speed.

        speed : coefficients of the speed, lowest power first, shape (n,), n at most order + 1
        """
        n: cython.Py_ssize_t
        value = np.zeros(len(speed))
        slope = np.zeros(len(speed))
        for n in range(len(speed)):
            row(self, 0, 0)[n] = splat(speed[n])
            self.extend(0, n, 0, max(self.value, self.slope))
            value[n] = lane_of(row(self, self.value, 0)[n], 0)
            slope[n] = lane_of(row(self, self.slope, 0)[n], 0)
        return value, slope
