"""The first event of each lane: guessed, found, and proven to be the first.

The gaps (see `lane_series`) are sampled, the earliest fall below 0 is refined to a root t*, and `lane_proof` tells
whether any gap has an earlier one. Where that cannot be excluded a lane goes only as far as it can, without an event,
and takes up its search from there; where that is not far, all its gaps are searched by `bernstein`, which decides.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.bernstein import SearchedPolynomial
from cython.cimports.burridge_knopoff.kernel.lane_proof import LOW, LaneProof
from cython.cimports.burridge_knopoff.kernel.lane_series import LaneSeries
from cython.cimports.burridge_knopoff.kernel.lanes import Lanes
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    at_most,
    bits,
    equal,
    from_bits,
    gather,
    lane_of,
    less,
    magnitude,
    mask,
    put,
    select,
    splat,
    vec,
)

ITERATIONS = 6

# Relative change by a step of Halley's method after which no other is needed, with the condition in `_solve`.
LAST_CHANGE = 2e-6

# Share of the way to a guess below which a proof that fails is left to `bernstein`.
SHORTEST = 0.1


class LaneEvents:
    """Finds for each lane the `time` of its first event and its `block`, −1 where there is none by that time.

    searches : how often a lane had to be searched by `bernstein`
    """

    order: cython.Py_ssize_t
    searches: cython.longlong
    proof: LaneProof
    time: Vectors
    block: Vectors
    candidate: Vectors
    offset: cython.Py_ssize_t[::1]
    doubtful: mask
    polynomial: SearchedPolynomial

    def __init__(self, order: int) -> None:
        self.order = order
        self.searches = 0
        self.time = Vectors(1)
        self.block = Vectors(1)
        self.candidate = Vectors(order + 1)
        self.offset = np.zeros(LANES, dtype=np.intp)
        self.doubtful = from_bits(0)
        self.proof = LaneProof(order)
        self.polynomial = SearchedPolynomial(order)

    def find(self, lanes: Lanes, series: LaneSeries, where: mask) -> None:
        """Find the first events within the reach of the series, in some lanes; `series.power` is that of `time`."""
        lane: cython.int
        searched: cython.int
        self.doubtful = from_bits(0)
        self._deflate(lanes, series, where)
        self._guess(series)
        self._solve(series, where)
        series.raise_powers(self.time.at[0])
        self.proof.prove(lanes, series, self.block.at[0], self.candidate.at, where & ~self.doubtful)
        if bits(where & (self.doubtful | self.proof.failed | less(self.proof.cut.at[0], splat(1.0)))):
            self._shorten(where)
            searched = bits(self.doubtful & where)
            for lane in range(LANES):
                if searched >> lane & 1:
                    self._search(lanes, series, lane)
            series.raise_powers(self.time.at[0])

    def begin_events(self, lanes: Lanes, series: LaneSeries) -> None:
        """Make ready for `due`, when the events have been found."""
        lane: cython.int
        k: cython.Py_ssize_t
        for lane in range(LANES):
            k = cython.cast(cython.Py_ssize_t, lane_of(self.block.at[0], lane))
            self.offset[lane] = k + 1 if k >= 0 else 1
        self.candidate.at[0] = gather(series.gap.at, cython.address(self.offset[0]))

    def due(self, lanes: Lanes, series: LaneSeries, i: cython.Py_ssize_t, event: mask) -> mask:
        """Return the lanes whose event is that of block i, or of one whose gap is the same to the bit, as of its image.

        Then their events are one, whatever rounding leaves of both gaps at its time.
        """
        k: cython.Py_ssize_t
        lane: cython.int
        own: mask = event & equal(self.block.at[0], splat(cython.cast(cython.double, i)))
        alike: mask = event & ~own & equal(series.gap.at[i + 1], self.candidate.at[0])
        for k in range(1, self.order + 1):
            if not bits(alike):
                return own
            alike = alike & equal(
                series.gap.at[k * series.width + i + 1],
                gather(series.gap.at + k * series.width, cython.address(self.offset[0])),
            )
        for lane in range(LANES):
            if lanes.threshold[i] != lanes.threshold[self.offset[lane] - 1]:
                alike = alike & ~from_bits(1 << lane)
        return own | alike

    def _deflate(self, lanes: Lanes, series: LaneSeries, where: mask) -> None:
        """Divide known roots at t = 0 out of the gaps: a block that has just started has U' = U'' = 0."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        _zeros: cython.Py_ssize_t
        gap: cython.pointer[vec]
        zero: vec = splat(0.0)
        stuck: mask
        roots: mask
        for i in range(series.blocks):
            gap = series.gap.at + i + 1
            roots = equal(gap[0], zero) & where
            stuck = less(zero, series.stuck.at[i])
            self.doubtful = self.doubtful | less(gap[0], zero)
            self.doubtful = self.doubtful | (stuck & (roots | less(zero, lanes.touching.at[i])))
            roots = roots & ~stuck
            for _zeros in range(self.order):
                if not bits(roots):
                    break
                for k in range(self.order):
                    gap[k * series.width] = select(roots, gap[(k + 1) * series.width], gap[k * series.width])
                gap[self.order * series.width] = select(roots, zero, gap[self.order * series.width])
                roots = roots & equal(gap[0], zero)

    def _guess(self, series: LaneSeries) -> None:
        """Set `time` and `block` to the earliest fall below 0 that samples of the gaps show, or to the reach and −1."""
        i: cython.Py_ssize_t
        k: cython.int
        width: cython.Py_ssize_t = series.width
        c: cython.pointer[vec]
        time: vec = series.reach.at[0]
        block: vec = splat(-1.0)
        first_t: vec = splat(0.25) * time
        second_t: vec = splat(0.5) * time
        third_t: vec = splat(0.75) * time
        fourth_t: vec = time
        zero: vec = splat(0.0)
        lowest: vec = zero
        t: vec
        before: vec
        after: vec
        first: vec
        second: vec
        third: vec
        fourth: vec
        falls: mask
        for i in range(series.blocks):
            c = series.gap.at + i + 1
            first = second = third = fourth = c[LOW * width]
            for k in range(LOW - 1, -1, -1):
                first = first * first_t + c[k * width]
                second = second * second_t + c[k * width]
                third = third * third_t + c[k * width]
                fourth = fourth * fourth_t + c[k * width]
            t = fourth_t
            before = third
            after = fourth
            falls = less(third, zero)
            t = select(falls, third_t, t)
            before = select(falls, second, before)
            after = select(falls, third, after)
            falls = less(second, zero)
            t = select(falls, second_t, t)
            before = select(falls, first, before)
            after = select(falls, second, after)
            falls = less(first, zero)
            t = select(falls, first_t, t)
            before = select(falls, c[0], before)
            after = select(falls, first, after)
            # A line between the two samples.
            t = t - first_t * (after / (after - before))
            # Where guesses are the same the lower sample decides, not the order of the blocks.
            falls = less(after, zero) & (less(t, time) | (equal(t, time) & less(after, lowest)))
            time = select(falls, t, time)
            lowest = select(falls, after, lowest)
            block = select(falls, splat(cython.cast(cython.double, i)), block)
        self.time.at[0] = time
        self.block.at[0] = block

    def _improve(self, reach: vec) -> None:
        """Refine the guesses by Halley's method on the first terms."""
        k: cython.int
        _iteration: cython.int
        q: cython.pointer[vec] = self.candidate.at
        t: vec = self.time.at[0]
        value: vec
        slope: vec
        curvature: vec
        for _iteration in range(2):
            value = q[LOW]
            slope = splat(0.0)
            curvature = slope
            for k in range(LOW - 1, -1, -1):
                curvature = curvature * t + slope
                slope = slope * t + value
                value = value * t + q[k]
            value = t - value * slope / (slope * slope - value * curvature)
            t = select(less(splat(0.0), value) & at_most(value, reach), value, t)
        self.time.at[0] = t

    def _solve(self, series: LaneSeries, where: mask) -> None:
        """Set `time` to the root near the guess, the reach and −1 if it lies beyond."""
        k: cython.Py_ssize_t
        _iteration: cython.int
        lane: cython.int
        q: cython.pointer[vec] = self.candidate.at
        zero: vec = splat(0.0)
        reach: vec = series.reach.at[0]
        t: vec
        term: vec
        value: vec
        slope: vec
        curvature: vec
        change: vec
        open: mask = where & at_most(zero, self.block.at[0]) & ~self.doubtful
        converged: mask
        if not bits(open):
            return
        for lane in range(LANES):
            k = cython.cast(cython.Py_ssize_t, lane_of(self.block.at[0], lane))
            self.offset[lane] = k + 1 if k >= 0 else 1
        for k in range(self.order + 1):
            q[k] = gather(series.gap.at + k * series.width, cython.address(self.offset[0]))
        t = self.time.at[0]
        self._improve(reach)
        self.time.at[0] = select(open, self.time.at[0], t)
        for _iteration in range(ITERATIONS):
            t = self.time.at[0]
            series.raise_powers(t)
            value = slope = curvature = zero
            for k in range(self.order, 0, -1):
                term = q[k] * series.power.at[k]
                value = value + term
                term = cython.cast(cython.double, k) * term
                slope = slope + term
                curvature = curvature + (0.5 * (k - 1)) * term
            value = value + q[0]
            change = value * slope / (slope * slope - value * curvature)
            self.time.at[0] = select(open, t - t * change, t)
            term = magnitude(change) * (change * curvature) * (change * curvature)
            converged = less(magnitude(change), splat(LAST_CHANGE)) & at_most(term, 1e-17 * (slope * slope))
            open = open & ~converged
            if not bits(open):
                break
        t = self.time.at[0]
        self.doubtful = self.doubtful | (where & (open | ~less(zero, t)))
        converged = less(reach, t)
        self.time.at[0] = select(converged, reach, t)
        self.block.at[0] = select(converged, splat(-1.0), self.block.at[0])

    def _shorten(self, where: mask) -> None:
        """Let lanes without a proof go as far as it holds, without an event, or be doubtful if that is not far."""
        cut: vec = self.proof.cut.at[0]
        short: mask = where & less(cut, splat(1.0)) & ~self.doubtful
        self.doubtful = self.doubtful | (short & less(cut, splat(SHORTEST))) | (where & self.proof.failed)
        self.time.at[0] = select(short, cut * self.time.at[0], self.time.at[0])
        self.block.at[0] = select(short, splat(-1.0), self.block.at[0])

    def _search(self, lanes: Lanes, series: LaneSeries, lane: cython.int) -> None:
        """Search all gaps of one lane over the whole reach."""
        i: cython.Py_ssize_t
        side: cython.int
        t: cython.double
        block: cython.double = -1.0
        time: cython.double = lane_of(series.reach.at[0], lane)
        self.searches += 1
        for i in range(series.blocks):
            for side in range(1, -2 * lanes.symmetric, -2):
                self._load(lanes, series, lane, i, side)
                t = self.polynomial.first_root(time)
                if t >= 0.0 and (t < time or block < 0.0):
                    time = t
                    block = i
                if lane_of(lanes.slip.at[i], lane) != 0.0:
                    break
        put(self.time.at, lane, time)
        put(self.block.at, lane, block)

    def _load(self, lanes: Lanes, series: LaneSeries, lane: cython.int, i: cython.Py_ssize_t, side: cython.int) -> None:
        """Load the gap of a block of one lane, for a stuck block that to a threshold ahead (1) or behind (−1)."""
        k: cython.Py_ssize_t
        near: cython.bint
        self.polynomial.degree = self.order
        for k in range(self.order + 1):
            self.polynomial.coefficient[k] = side * lane_of(series.gap.at[k * series.width + i + 1], lane)
        if lane_of(lanes.slip.at[i], lane) == 0.0:
            if side < 0:
                self.polynomial.coefficient[0] += 2.0 * lanes.threshold[i]
            # At its threshold by construction: what rounding leaves of the gap must not start the block a second time.
            near = abs(self.polynomial.coefficient[0]) < 0.5 * lanes.threshold[i]
            if near and lane_of(lanes.touching.at[i], lane) != 0.0:
                self.polynomial.coefficient[0] = 0.0
        self.polynomial.deflate()
