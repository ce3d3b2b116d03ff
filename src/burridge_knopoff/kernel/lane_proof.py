"""Proof in lanes that no gap has a root before a given time, and how far it holds where there may be one.

Bernstein coefficients over [0, t*] bound a gap from below (see `bernstein`): those of its first terms, with all others
taken off the last one, since they add at most Σ|c_k| t*^k u^LOW at u = t/t*, which has no other coefficient. A gap that
falls to 0 at t* itself is divided by 1 − u first.
"""

import math

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.lane_proof import LOW, to_bernstein
from cython.cimports.burridge_knopoff.kernel.lane_series import LaneSeries
from cython.cimports.burridge_knopoff.kernel.lanes import Lanes
from cython.cimports.burridge_knopoff.kernel.vector import (
    Vectors,
    at_most,
    bits,
    equal,
    from_bits,
    largest,
    least,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)

# Gaps that are so small at an event, and fall, are divided by 1 − u.
CLOSE = 1e-3

# A gap that is below minus this share of its highest Bernstein coefficient has its event before: rounding leaves less.
SIMULTANEOUS = 1e-14


class LaneProof:
    """The work space of a proof for series of the given order.

    `cut` is the share of the way on which no gap has a root, 1 if that is all of it; `failed` marks where a stuck block
    may start backward on the way.
    """

    order: cython.Py_ssize_t
    bernstein: Vectors
    weight: Vectors
    cut: Vectors
    failed: mask
    inverse_binomial: cython.double[::1]

    def __init__(self, order: int) -> None:
        self.order = order
        self.bernstein = Vectors(LOW + 1)
        self.weight = Vectors(LOW + 1)
        self.cut = Vectors(1)
        self.failed = from_bits(0)
        self.inverse_binomial = np.array([1.0 / math.comb(LOW, k) for k in range(LOW + 1)])

    def prove(self, lanes: Lanes, series: LaneSeries, block: vec, candidate: cython.pointer[vec], where: mask) -> None:
        """Set `cut` and `failed`: no gap may have a root before t*, whose powers are in `series.power`.

        block : the block whose gap has a root at t*, −1 for none; candidate : the terms of that gap
        """
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        width: cython.Py_ssize_t = series.width
        c: cython.pointer[vec]
        b: cython.pointer[vec] = self.bernstein.at
        zero: vec = splat(0.0)
        one: vec = splat(1.0)
        rest: vec
        end: vec
        smallest: vec
        highest: vec
        failing: mask
        close: mask
        event: mask = at_most(zero, block)
        self.cut.at[0] = one
        self.failed = from_bits(0)
        for k in range(LOW + 1):
            self.weight.at[k] = self.inverse_binomial[k] * series.power.at[k]
        failing = where & event
        if bits(failing):
            failing = failing & ~self._falls(candidate, 1, series)
            if bits(failing):
                rest = self._bound(candidate, 1, series)
                to_bernstein(b)
                self._shorten(rest, failing)
        for i in range(series.blocks):
            c = series.gap.at + i + 1
            rest = self._bound(c, width, series)
            smallest = to_bernstein(b)
            failing = where & ~(event & equal(block, splat(cython.cast(cython.double, i))))
            if lanes.symmetric:
                end = largest(b[0], b[LOW] + rest)
                for k in range(1, LOW):
                    end = largest(b[k], end)
                close = failing & less(zero, series.stuck.at[i])
                self.failed = self.failed | (close & ~less(end, splat(2.0 * lanes.threshold[i])))
            failing = failing & ~at_most(zero, least(smallest, b[LOW] - rest))
            if not bits(failing):
                continue
            end = b[LOW]
            for k in range(LOW + 1, self.order + 1):
                end = end + c[k * width] * series.power.at[k]
            highest = b[0]
            for k in range(1, LOW + 1):
                highest = largest(b[k], highest)
            close = failing & less(-SIMULTANEOUS * highest, end) & less(end, splat(CLOSE))
            if bits(close):
                failing = failing & ~(close & self._falls(c, width, series))
                if not bits(failing):
                    continue
                rest = self._bound(c, width, series)
                to_bernstein(b)
            self._shorten(rest, failing)

    def _bound(self, c: cython.pointer[vec], stride: cython.Py_ssize_t, series: LaneSeries) -> vec:
        """Load the first terms of a gap for `to_bernstein`, and return the sum of what the others amount to."""
        k: cython.Py_ssize_t
        rest: vec = splat(0.0)
        for k in range(LOW + 1):
            self.bernstein.at[k] = c[k * stride] * self.weight.at[k]
        for k in range(self.order, LOW, -1):
            rest = rest + magnitude(c[k * stride] * series.power.at[k])
        return rest

    def _falls(self, c: cython.pointer[vec], stride: cython.Py_ssize_t, series: LaneSeries) -> mask:
        """Tell where (p(u) − p(1)) / (1 − u) is positive on the whole way, for the terms of one gap p."""
        k: cython.Py_ssize_t
        total: vec = splat(0.0)
        rest: vec = total
        b: cython.pointer[vec] = self.bernstein.at
        # Its coefficients are the sums of the terms of p beyond, negative.
        for k in range(self.order, LOW + 1, -1):
            total = total - c[k * stride] * series.power.at[k]
            rest = rest + magnitude(total)
        for k in range(LOW + 1, 0, -1):
            total = total - c[k * stride] * series.power.at[k]
            b[k - 1] = self.inverse_binomial[k - 1] * total
        total = to_bernstein(b)
        return at_most(splat(0.0), least(total, b[LOW] - rest))

    def _shorten(self, rest: vec, failing: mask) -> None:
        """Let `cut` be no more than the share of the way on which a line below the coefficients is positive."""
        k: cython.int
        b: cython.pointer[vec] = self.bernstein.at
        share: cython.double
        fall: vec = b[LOW] - rest - b[0]
        for k in range(1, LOW):
            share = LOW / cython.cast(cython.double, k)
            fall = least(share * (b[k] - b[0]), fall)
        # A little less: the line is as exact as its rounding.
        fall = 0.99 * (b[0] / -fall)
        fall = select(at_most(splat(0.0), fall), fall, splat(0.0))
        self.cut.at[0] = select(failing, least(fall, self.cut.at[0]), self.cut.at[0])
