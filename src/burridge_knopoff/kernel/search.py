"""The first stop or start on a piece of the motion, looked for in all blocks at once and proved to be the first.

What decides about an event is a polynomial g for each block, positive until the event: its speed while it slips, or
how far its spring force is from its threshold while it sticks. A root t* is guessed and refined by Halley's method, and
then it is proved that no g has one before: over [0, t*] each g, or the quotient q in g(t) = g(t*) + (1 − t/t*) q(t), is
bounded from below by the Bernstein coefficients of its first terms and the sum of the others. Where the proof fails the
exhaustive search of `bernstein` decides. So an event can be found late only by what rounding hides.
"""

import math

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.bernstein import SearchedPolynomial
from cython.cimports.burridge_knopoff.kernel.piece import UNKNOWN
from cython.cimports.burridge_knopoff.kernel.search import LOW
from cython.cimports.burridge_knopoff.kernel.springs import thresholds
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    at_most,
    bits,
    largest,
    least,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)

# Halley steps before a root is left to the exhaustive search.
ITERATIONS = 6

# A root has converged when the next step would be smaller than this share of the piece.
CONVERGED = 1e-17

# Values down to minus this at the event count as events of the same instant; see `state.COINCIDENCE`.
COMMON = 1e-14

# Value at the event of another block below which the quotient serves better.
NEAR = 1e-3


class EventSearch:
    """Finds events of chains of `blocks` blocks on pieces of the given order; `time` is that of the last one found."""

    def __init__(self, blocks: int, order: int) -> None:
        columns = (blocks + LANES - 1) // LANES
        self.time = 0.0
        self.order = order
        self.columns = columns
        self.polynomial = SearchedPolynomial(order)
        self.gap = Vectors((order + 1) * columns)
        self.gap_table = self.gap.table(order + 1)
        self.scaled = Vectors(order + 1)
        self.quotient = Vectors(order + 1)
        self.corner = Vectors(LOW + 1)
        self.lowest = Vectors(columns)
        self.highest = Vectors(columns)
        self.root = Vectors(columns)
        self.lowest_table = self.lowest.table(1)[0]
        self.highest_table = self.highest.table(1)[0]
        self.root_table = self.root.table(1)[0]
        self.power = np.zeros(order + 2)
        self.inverse_binomial = np.array([1.0 / math.comb(LOW, k) for k in range(LOW + 1)])
        self.zeros = np.zeros(blocks, dtype=np.intp)

    def first(self, state, piece, reach):
        """Return the block that stops or starts first within the reach, −1 if none does; its time is in `time`."""
        i: cython.Py_ssize_t
        block: cython.Py_ssize_t = -1
        self._load(state, piece)
        if self._whole(state, piece, reach):
            self.time = reach
            return -1
        if state.symmetric:
            for i in range(state.blocks):
                if state.slip[i] == 0 and (
                    self.zeros[i] > 0 or self.highest_table[i] >= 2.0 * state.springs.threshold[i]
                ):
                    return self._exhaustive(state, piece, reach)
        self.time = reach
        for i in range(state.blocks):
            if self.root_table[i] <= reach and (block < 0 or self.root_table[i] < self.time):
                self.time = self.root_table[i]
                block = i
        if block >= 0 and self._proved(self.time):
            return block
        return self._exhaustive(state, piece, reach)

    def _load(self, state, piece):
        """Take g of every block, its known zeros at the start divided out: a block that has just started has U' = 0."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        zeros: cython.Py_ssize_t
        touching: cython.bint
        columns: cython.Py_ssize_t = self.columns
        g: cython.pointer[vec] = self.gap.at
        for c in range(columns):
            for k in range(self.order + 1):
                g[k * columns + c] = (
                    piece.direction.at[c] * piece.velocities.at[k * columns + c]
                    - piece.stuck.at[c] * piece.forces.at[k * columns + c]
                )
            g[c] = g[c] + piece.stuck.at[c] * thresholds(state.springs, c)
        for i in range(state.blocks):
            self.zeros[i] = 0
            # At its threshold by construction: what rounding leaves there must not start the block a second time.
            touching = state.slip[i] == 0 and state.touching[i]
            if touching and abs(self.gap_table[0, i]) < 0.5 * state.springs.threshold[i]:
                self.gap_table[0, i] = 0.0
            if self.gap_table[0, i] == 0.0:
                zeros = 1
                while zeros < self.order and self.gap_table[zeros, i] == 0.0:
                    zeros += 1
                self.zeros[i] = zeros
                for k in range(self.order + 1 - zeros):
                    self.gap_table[k, i] = self.gap_table[k + zeros, i]
                for k in range(self.order + 1 - zeros, self.order + 1):
                    self.gap_table[k, i] = 0.0

    def _whole(self, state, piece, reach):
        """Tell whether bounds show that nothing happens in the reach; else leave a root of each block, or UNKNOWN."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        wanted: mask
        nothing: cython.bint = True
        never: vec = splat(UNKNOWN)
        self._measure(reach)
        for c in range(self.columns):
            self._scale(c)
            self._bound(self.scaled.at, c)
            wanted = at_most(self.lowest.at[c], splat(0.0))
            self.root.at[c] = never
            if bits(wanted):
                nothing = False
                self.root.at[c] = self._refine(c, self._guess(reach), reach, wanted)
        for i in range(state.blocks):
            piece.highest[i] = UNKNOWN if self.zeros[i] > 0 else self.highest_table[i]
            if state.symmetric and state.slip[i] == 0:
                nothing = nothing and self.zeros[i] == 0 and self.highest_table[i] < 2.0 * state.springs.threshold[i]
        return nothing

    def _measure(self, length):
        """Take the powers of an interval's length."""
        k: cython.Py_ssize_t
        square: cython.double = length * length
        even: cython.double = 1.0
        odd: cython.double = length
        for k in range(0, self.order + 1, 2):
            self.power[k] = even
            self.power[k + 1] = odd
            even *= square
            odd *= square

    def _scale(self, column):
        """Take the terms of one column at the end of the interval that was measured."""
        k: cython.Py_ssize_t
        for k in range(self.order + 1):
            self.scaled.at[k] = self.gap.at[k * self.columns + column] * self.power[k]

    def _bound(self, terms, column):
        """Bound the polynomials with these terms over [0, 1]; their first Bernstein coefficients go to `corner`."""
        k: cython.Py_ssize_t
        j: cython.Py_ssize_t
        corner = cython.declare(vec[9])
        rest: vec = splat(0.0)
        other: vec = rest
        low: vec
        high: vec
        for k in range(LOW + 1):
            corner[k] = terms[k] * self.inverse_binomial[k]
        for k in range(LOW + 1, self.order, 2):
            rest = rest + magnitude(terms[k])
            other = other + magnitude(terms[k + 1])
        for j in range(1, LOW + 1):
            for k in range(LOW, j - 1, -1):
                corner[k] = corner[k] + corner[k - 1]
        rest = rest + other
        low = corner[0]
        high = low
        for k in range(1, LOW + 1):
            low = least(low, corner[k])
            high = largest(high, corner[k])
        for k in range(LOW + 1):
            self.corner.at[k] = corner[k]
        self.lowest.at[column] = low - rest
        self.highest.at[column] = high + rest

    def _guess(self, length):
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

    def _refine(self, column, t, reach, wanted):
        """Return the roots near guesses, by Halley's method; UNKNOWN where it does not converge within the reach."""
        k: cython.Py_ssize_t
        _iteration: cython.int
        g: cython.pointer[vec] = self.gap.at + column
        columns: cython.Py_ssize_t = self.columns
        square: vec
        even: vec
        odd: vec
        even_slope: vec
        odd_slope: vec
        even_curvature: vec
        odd_curvature: vec
        value: vec
        slope: vec
        curvature: vec
        step: vec
        zero: vec = splat(0.0)
        end: vec = splat(reach)
        open_lanes: mask = wanted & at_most(t, end)
        done: mask = open_lanes & ~open_lanes
        good: mask
        for _iteration in range(ITERATIONS):
            if not bits(open_lanes):
                break
            # Even and odd powers apart, in z = t², since each sum waits for the last: g = e + t o.
            square = t * t
            even = g[self.order * columns]
            odd = g[(self.order - 1) * columns]
            even_slope = zero
            odd_slope = zero
            even_curvature = zero
            odd_curvature = zero
            for k in range(self.order - 2, -1, -2):
                even_curvature = even_curvature * square + even_slope
                even_slope = even_slope * square + even
                even = even * square + g[k * columns]
                if k > 0:
                    odd_curvature = odd_curvature * square + odd_slope
                    odd_slope = odd_slope * square + odd
                    odd = odd * square + g[(k - 1) * columns]
            value = even + t * odd
            slope = odd + 2.0 * (t * even_slope + square * odd_slope)
            curvature = (even_slope + 3.0 * (t * odd_slope)) + 4.0 * (square * (even_curvature + t * odd_curvature))
            # Twice the product, since curvature is half the second derivative.
            step = -(value * slope) / (slope * slope - value * curvature)
            good = open_lanes & less(slope, zero)
            t = select(good, t + step, t)
            good = good & at_most(zero, t) & at_most(t, end)
            curvature = curvature * step
            step = magnitude(step)
            curvature = step * (curvature * curvature)
            wanted = good & less(step, 1e-5 * end) & at_most(curvature, (CONVERGED * reach) * (slope * slope))
            done = done | wanted
            open_lanes = good & ~wanted
        return select(done, t, splat(UNKNOWN))

    def _proved(self, t):
        """Tell whether no block has an event before t, by bounds over [0, t]."""
        c: cython.Py_ssize_t
        k: cython.Py_ssize_t
        zero: vec = splat(0.0)
        total: vec
        near: mask
        self._measure(t)
        for c in range(self.columns):
            self._scale(c)
            # Coefficients of q: minus the sums of the higher terms of g.
            total = zero
            for k in range(self.order, -1, -1):
                self.quotient.at[k] = -total
                total = total + self.scaled.at[k]
            # A block that is near its own event is proved by q, the others as they are.
            near = at_most(total, splat(NEAR))
            if bits(near & less(total, splat(-COMMON))):
                return False
            for k in range(self.order + 1):
                self.quotient.at[k] = select(near, self.quotient.at[k], self.scaled.at[k])
            self._bound(self.quotient.at, c)
            if bits(less(zero, self.lowest.at[c])) != (1 << LANES) - 1:
                return False
        return True

    def _exhaustive(self, state, piece, reach):
        """Do the work of `first` block by block, by halving."""
        i: cython.Py_ssize_t
        side: cython.int
        t: cython.double
        block: cython.Py_ssize_t = -1
        self.time = reach
        for i in range(state.blocks):
            for side in range(1, -2 * state.symmetric, -2):
                if state.slip[i] != 0:
                    piece.load_speed(state, i, self.polynomial)
                else:
                    piece.load_gap(state, i, side, self.polynomial)
                self.polynomial.deflate()
                # In the whole reach: what one block does must not move the event of another by a bit.
                t = self.polynomial.first_root(reach)
                if t >= 0.0 and (t < self.time or block < 0):
                    self.time = t
                    block = i
                if state.slip[i] != 0:
                    break
        return block
