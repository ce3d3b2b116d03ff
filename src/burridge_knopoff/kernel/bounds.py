"""Bounds of polynomials over an interval, one in each lane: from their first Bernstein coefficients.

The first LOW + 1 terms have Bernstein coefficients of degree LOW, between whose extremes they stay; the others are at
most their sum times t^LOW, which is the last Bernstein polynomial, and so only widen the last coefficient.
"""

import math

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.bounds import LOW
from cython.cimports.burridge_knopoff.kernel.piece import ORDER, UNKNOWN
from cython.cimports.burridge_knopoff.kernel.vector import (
    Vectors,
    at_most,
    largest,
    least,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)


class Bounds:
    """Terms of polynomials of order ORDER, in `columns` vectors, and what is known about them over an interval.

    scaled, quotient : the terms of a polynomial at the end of the interval, and those of one that may take its place
    lowest, highest : bounds; fall : the least rate at which the polynomials of one column fall, anywhere
    """

    scaled: Vectors
    quotient: Vectors
    corner: Vectors
    lowest: Vectors
    highest: Vectors
    fall: Vectors
    lowest_table: cython.double[::1]
    highest_table: cython.double[::1]
    fall_table: cython.double[::1]
    power: cython.double[::1]
    inverse_binomial: cython.double[::1]

    def __init__(self, columns: int) -> None:
        self.scaled = Vectors(ORDER + 1)
        self.quotient = Vectors(ORDER + 1)
        self.corner = Vectors(LOW + 1)
        self.lowest = Vectors(columns)
        self.highest = Vectors(columns)
        self.fall = Vectors(1)
        self.lowest_table = self.lowest.table(1)[0]
        self.highest_table = self.highest.table(1)[0]
        self.fall_table = self.fall.table(1)[0]
        self.power = np.zeros(ORDER + 4)
        self.inverse_binomial = np.array([1.0 / math.comb(LOW, k) for k in range(LOW + 1)])

    def measure(self, length: cython.double) -> None:
        """Take the powers of an interval's length: four chains of products, as each waits for the last."""
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        square: cython.double = length * length
        power = cython.declare(cython.double[4])
        power[0] = 1.0
        power[1] = length
        power[2] = square
        power[3] = square * length
        square = square * square
        for k in range(0, ORDER + 1, 4):
            for j in range(4):
                self.power[k + j] = power[j]
                power[j] *= square

    def scale(self, terms: cython.pointer[cython.const[vec]], stride: cython.Py_ssize_t) -> None:
        """Take terms, one in `stride` vectors, at the end of the interval that was measured."""
        k: cython.Py_ssize_t
        for k in range(ORDER + 1):
            self.scaled.at[k] = terms[k * stride] * self.power[k]

    def bound(self, column: cython.Py_ssize_t, near: mask) -> None:
        """Bound the quotients where `near` says so, else the polynomials; their first coefficients go to `corner`."""
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        corner = cython.declare(vec[9])
        scaled: cython.pointer[vec] = self.scaled.at
        quotient: cython.pointer[vec] = self.quotient.at
        rest: vec = splat(0.0)
        other: vec = rest
        low: vec
        high: vec
        for k in range(LOW + 1):
            corner[k] = select(near, quotient[k], scaled[k]) * self.inverse_binomial[k]
        for k in range(LOW + 1, ORDER, 2):
            rest = rest + magnitude(select(near, quotient[k], scaled[k]))
            other = other + magnitude(select(near, quotient[k + 1], scaled[k + 1]))
        for j in range(1, LOW + 1):
            for k in range(LOW, j - 1, -1):
                corner[k] = corner[k] + corner[k - 1]
        rest = rest + other
        low = corner[LOW] - rest
        high = corner[LOW] + rest
        for k in range(LOW):
            low = least(low, corner[k])
            high = largest(high, corner[k])
        for k in range(LOW + 1):
            self.corner.at[k] = corner[k]
        self.lowest.at[column] = low
        self.highest.at[column] = high

    def guess(self, length: cython.double) -> vec:
        """Return where the control polygons of the last bounds first fall through 0; UNKNOWN where they do not."""
        k: cython.Py_ssize_t
        corner: cython.pointer[vec] = self.corner.at
        guess: vec = splat(UNKNOWN)
        zero: vec = splat(0.0)
        for k in range(LOW - 1, -1, -1):
            guess = select(
                less(zero, corner[k]) & at_most(corner[k + 1], zero),
                (length / LOW) * (cython.cast(cython.double, k) + corner[k] / (corner[k] - corner[k + 1])),
                guess,
            )
        return guess

    def steepness(self, length: cython.double) -> None:
        """Set `fall` for the polynomials that were bounded last, not for their quotients, in an interval this long."""
        k: cython.Py_ssize_t
        per_time: cython.double = 1.0 / length
        corner: cython.pointer[vec] = self.corner.at
        steepest: vec = corner[1] - corner[0]
        rest: vec = splat(0.0)
        for k in range(1, LOW):
            steepest = largest(steepest, corner[k + 1] - corner[k])
        for k in range(LOW + 1, ORDER + 1):
            rest = rest + cython.cast(cython.double, k) * magnitude(self.scaled.at[k])
        self.fall.at[0] = -(cython.cast(cython.double, LOW) * steepest + rest) * per_time
