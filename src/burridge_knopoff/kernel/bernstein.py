"""One polynomial over one piece of the motion: its first root and its maximum, neither of which can be missed.

A polynomial of degree n over [0, h] is a convex combination of its n + 1 Bernstein coefficients. Hence

- no negative coefficient: no root, however close to zero the polynomial comes between its ends;
- exactly one change of sign, and neither end coefficient 0: exactly one root, and it is simple (Descartes' rule);
- otherwise the interval is halved (de Casteljau) and the left half is searched first.

Every interval that is passed over is passed over by the first statement, so a grazing touch is found at any
distance from the ends of the piece. What remains undecided are dips that rounding alone can fill: the halving ends at
intervals of 4e-15 of their distance from the start of the piece. The conversion has positive weights of at most 1, so
its error is a few ulp of the largest scaled coefficient.

Reference: R. T. Farouki, "The Bernstein polynomial basis: a centennial retrospective", Comput. Aided Geom. Des. 29
(2012) 379-419.
"""

import math
from functools import cache

import cython
import numpy as np

# Tests run this file and `polynomial` uncompiled, since their methods cannot be called from Python when compiled.
if cython.compiled:
    from cython.cimports.burridge_knopoff.kernel.polynomial import Polynomial
else:
    from burridge_knopoff.kernel.polynomial import Polynomial

MAXIMUM_DEPTH = 48
NEWTON_ITERATIONS = 80

# Scaled coefficients below this share of the largest one cannot change a double-precision value of the polynomial.
NEGLIGIBLE = 1e-19

# A root is found when Newton's method moves it by no more than half an ulp.
RESOLUTION = 1.2e-16

# Degree of the first, cheap test of an interval.
LOW_DEGREE = 8


@cache
def _conversions(capacity: int) -> np.ndarray:
    """Return the weights of terms in Bernstein coefficients, [degree, term k, coefficient j]: (j over k)/(n over k)."""
    weight = np.zeros((capacity + 1, capacity + 1, (capacity // 8 + 1) * 8))
    for n in range(capacity + 1):
        for k in range(n + 1):
            for j in range(k, n + 1):
                weight[n, k, j] = math.comb(j, k) / math.comb(n, k)
    return weight


class SearchedPolynomial(Polynomial):
    """A polynomial with the work space to find its first root and its maximum over [0, length].

    After a search `lowest` and `highest` are bounds of the polynomial over that interval.
    """

    bernstein: cython.double[:, ::1]
    weight: cython.double[:, :, ::1]
    left: cython.double[::1]
    right: cython.double[::1]
    power: cython.double[::1]
    term: cython.double[::1]
    length: cython.double
    lowest: cython.double
    highest: cython.double

    def __init__(self, capacity: int) -> None:
        super().__init__(capacity)
        self.bernstein = np.zeros((MAXIMUM_DEPTH + 2, len(self.coefficient)))
        self.left = np.zeros(MAXIMUM_DEPTH + 2)
        self.right = np.zeros(MAXIMUM_DEPTH + 2)
        self.weight = _conversions(capacity)
        self.power = np.zeros(len(self.coefficient))
        self.term = np.zeros(len(self.coefficient))
        self.length = -1.0
        self.lowest = 0.0
        self.highest = 0.0

    def first_root(self, length: cython.double) -> cython.double:
        """Return the first t in [0, length] at which the polynomial becomes negative, or -1.0 if it never does.

        The value at 0 must not be negative by more than rounding: for a negative one 0 is returned.
        """
        n: cython.Py_ssize_t
        k: cython.Py_ssize_t
        top: cython.Py_ssize_t
        changes: cython.Py_ssize_t
        sign: cython.int
        first: cython.int
        n = self._scale(length)
        if self.lowest > 0.0:
            return -1.0
        if n > LOW_DEGREE:
            self._bound(n)
            if self.lowest > 0.0:
                return -1.0
        self._convert(0, n)
        top = 0
        self.left[0] = 0.0
        self.right[0] = length
        while top >= 0:
            changes = 0
            sign = 0
            first = 0
            for k in range(n + 1):
                if self.bernstein[top, k] > 0.0:
                    changes += sign < 0
                    sign = 1
                elif self.bernstein[top, k] < 0.0:
                    changes += sign > 0
                    sign = -1
                if first == 0:
                    first = sign
            if first < 0:
                return self.left[top]
            if changes == 0:
                top -= 1
            elif changes == 1 and self.bernstein[top, 0] > 0.0 and self.bernstein[top, n] < 0.0:
                return self._root_between(top, n)
            elif top >= MAXIMUM_DEPTH or self.right[top] - self.left[top] <= 4e-15 * self.right[top]:
                if sign < 0:
                    return self.right[top]
                top -= 1
            else:
                self._split(top, n)
                top += 1
        return -1.0

    def maximum(self, length: cython.double, floor: cython.double) -> cython.double:
        """Return the larger of floor and the maximum over [0, length]."""
        n: cython.Py_ssize_t
        k: cython.Py_ssize_t
        top: cython.Py_ssize_t
        changes: cython.Py_ssize_t
        sign: cython.int
        first: cython.int
        step: cython.double
        largest: cython.double
        n = self._scale(length)
        if self.highest <= floor:
            return floor
        if self._concave(n):
            return max(floor, self._peak_between(0.0, length))
        if n > LOW_DEGREE:
            self._bound(n)
            if self.highest <= floor:
                return floor
        self._convert(0, n)
        top = 0
        self.left[0] = 0.0
        self.right[0] = length
        while top >= 0:
            floor = max(floor, self.bernstein[top, 0], self.bernstein[top, n])
            largest = floor
            changes = 0
            sign = 0
            first = 0
            for k in range(n + 1):
                largest = max(largest, self.bernstein[top, k])
                if k < n:
                    step = self.bernstein[top, k + 1] - self.bernstein[top, k]
                    if step > 0.0:
                        changes += sign < 0
                        sign = 1
                    elif step < 0.0:
                        changes += sign > 0
                        sign = -1
                    if first == 0:
                        first = sign
            if largest <= floor:
                top -= 1
            elif changes == 1 and first > 0:
                floor = max(floor, self._peak_between(self.left[top], self.right[top]))
                top -= 1
            elif changes <= 1 or top >= MAXIMUM_DEPTH:
                top -= 1
            else:
                self._split(top, n)
                top += 1
        return floor

    def _measure(self, length: cython.double) -> None:
        """Take the powers of an interval's length: even and odd ones apart, as each waits for the last."""
        k: cython.Py_ssize_t
        square: cython.double = length * length
        even: cython.double = 1.0
        odd: cython.double = length
        if length == self.length:
            return
        self.length = length
        for k in range(0, self.capacity, 2):
            self.power[k] = even
            self.power[k + 1] = odd
            even *= square
            odd *= square
        if self.capacity % 2 == 0:
            self.power[self.capacity] = even

    def _scale(self, length: cython.double) -> cython.Py_ssize_t:
        """Put the terms at t = length into the first Bernstein row; return the degree that matters there.

        `lowest` and `highest` become bounds of the polynomial over [0, length]: the sums of its negative and of its
        positive terms.
        """
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t = self.degree
        scaled: cython.double
        negative: cython.double = 0.0
        positive: cython.double = 0.0
        self._measure(length)
        self.bernstein[0, 0] = self.coefficient[0]
        for k in range(1, n + 1):
            scaled = self.coefficient[k] * self.power[k]
            self.bernstein[0, k] = scaled
            negative += min(scaled, 0.0)
            positive += max(scaled, 0.0)
        self.lowest = self.coefficient[0] + negative
        self.highest = self.coefficient[0] + positive
        scaled = NEGLIGIBLE * (abs(self.coefficient[0]) + positive - negative)
        while n > 0 and abs(self.bernstein[0, n]) <= scaled:
            n -= 1
        return n

    def _concave(self, degree: cython.Py_ssize_t) -> cython.bint:
        """Tell whether the polynomial that was scaled is known to bend downward everywhere in the interval."""
        k: cython.Py_ssize_t
        bend: cython.double = 2.0 * self.bernstein[0, 2]
        for k in range(3, degree + 1):
            bend += max(0.0, k * (k - 1.0) * self.bernstein[0, k])
        return degree >= 2 and bend < 0.0

    def _bound(self, degree: cython.Py_ssize_t) -> None:
        """Tighten `lowest` and `highest` by the Bernstein coefficients of the first terms and the sum of the others.

        Far cheaper than all coefficients, and enough wherever the polynomial keeps clear of 0.
        """
        k: cython.Py_ssize_t
        rest: cython.double = 0.0
        least: cython.double
        largest: cython.double
        for k in range(LOW_DEGREE + 1, degree + 1):
            rest += abs(self.bernstein[0, k])
        for k in range(LOW_DEGREE + 1):
            self.bernstein[1, k] = self.bernstein[0, k]
        self._convert(1, LOW_DEGREE)
        least = self.bernstein[1, 0]
        largest = self.bernstein[1, 0]
        for k in range(1, LOW_DEGREE + 1):
            least = min(least, self.bernstein[1, k])
            largest = max(largest, self.bernstein[1, k])
        self.lowest = max(self.lowest, least - rest)
        self.highest = min(self.highest, largest + rest)

    def _convert(self, row: cython.Py_ssize_t, degree: cython.Py_ssize_t) -> None:
        """Turn the scaled terms in a row into Bernstein coefficients, eight at a time."""
        first: cython.Py_ssize_t
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        term: cython.double
        total = cython.declare(cython.double[8])
        for k in range(degree + 1):
            self.term[k] = self.bernstein[row, k]
        for first in range(0, degree + 1, 8):
            for j in range(8):
                total[j] = self.term[0]
            for k in range(1, min(degree, first + 7) + 1):
                term = self.term[k]
                for j in range(8):
                    total[j] += self.weight[degree, k, first + j] * term
            for j in range(8):
                self.bernstein[row, first + j] = total[j]

    def _split(self, top: cython.Py_ssize_t, degree: cython.Py_ssize_t) -> None:
        """Halve the interval in row top: its right half stays there, its left half goes to row top + 1."""
        j: cython.Py_ssize_t
        k: cython.Py_ssize_t
        middle: cython.double = 0.5 * (self.left[top] + self.right[top])
        self.left[top + 1] = self.left[top]
        self.right[top + 1] = middle
        self.left[top] = middle
        for j in range(degree + 1):
            self.bernstein[top + 1, j] = self.bernstein[top, 0]
            for k in range(degree - j):
                self.bernstein[top, k] = 0.5 * (self.bernstein[top, k] + self.bernstein[top, k + 1])

    def _root_between(self, top: cython.Py_ssize_t, degree: cython.Py_ssize_t) -> cython.double:
        """Return the only root in the interval of row top, where the sign falls: Halley's method kept in a bracket."""
        _iteration: cython.int
        t: cython.double
        change: cython.double
        value: cython.double
        slope: cython.double
        step: cython.double
        low: cython.double = self.left[top]
        high: cython.double = self.right[top]
        at_low: cython.double = self.bernstein[top, 0]
        at_high: cython.double = self.bernstein[top, degree]
        t = low + (high - low) * at_low / (at_low - at_high)
        self.derive(0)
        self.derive(1)
        for _iteration in range(NEWTON_ITERATIONS):
            value = self.at(0, t)
            slope = self.at(1, t)
            if value == 0.0:
                return t
            if value > 0.0:
                low = t
            else:
                high = t
            change = 0.5 * (low + high) - t
            if slope < 0.0:
                if abs(value) <= -RESOLUTION * slope * t:
                    return t
                step = -(value * slope) / (slope * slope - 0.5 * value * self.at(2, t))
                if low < t + step < high:
                    change = step
            t += change
            if abs(change) <= RESOLUTION * t:
                return t
        return t

    def _peak_between(self, low: cython.double, high: cython.double) -> cython.double:
        """Return the maximum in [low, high], where the derivative changes its sign from + to − at most once."""
        _iteration: cython.int
        t: cython.double = 0.5 * (low + high)
        slope: cython.double
        curvature: cython.double
        change: cython.double
        self.derive(0)
        self.derive(1)
        if self.at(1, low) <= 0.0:
            return self.value(low)
        if self.at(1, high) >= 0.0:
            return self.value(high)
        for _iteration in range(NEWTON_ITERATIONS):
            slope = self.at(1, t)
            curvature = self.at(2, t)
            if slope > 0.0:
                low = t
            else:
                high = t
            change = 0.5 * (low + high) - t
            if curvature < 0.0 and low < t - slope / curvature < high:
                change = -slope / curvature
            t += change
            # The maximum is flat: half of the digits of its place give all digits of its value.
            if abs(change) <= 1e-9 * high:
                break
        return self.value(t)
