"""The first stop or start on a piece of the motion, looked for in all blocks at once and proved to be the first.

What decides about an event is a polynomial g for each block, positive until the event: its speed while it slips, or
how far its spring force is from its threshold while it sticks. A root t* is guessed and refined by Halley's method, and
then it is proved that no g has one before: over [0, t*] each g, or the quotient q in g(t) = g(t*) + (1 − t/t*) q(t), is
bounded from below (see `bounds`). Where the proof fails the exhaustive search of `bernstein` decides. So an event is
found late only by as much as rounding hides.

Where W, which makes the section, changes its sign is found on the way, in a lane behind those of the blocks: it moves
no event, and costs next to nothing.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.bernstein import SearchedPolynomial
from cython.cimports.burridge_knopoff.kernel.bounds import LOW, Bounds
from cython.cimports.burridge_knopoff.kernel.piece import ORDER, UNCERTAIN, UNKNOWN, Piece
from cython.cimports.burridge_knopoff.kernel.springs import thresholds
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    at_most,
    bits,
    equal,
    from_bits,
    less,
    magnitude,
    mask,
    select,
    splat,
    vec,
)

# Halley steps with the first terms, and with all before a root is left to the exhaustive search.
GUESSES = 1
ITERATIONS = 6

# A root has converged when the next step would be smaller than this share of the piece.
CONVERGED = 1e-17

# Values down to minus this share of the highest one count as 0 at the event: no less is left of them by rounding.
COMMON = 1e-14

# W at the end of one piece and at the start of the next differ by rounding, less than this.
SEAM = 1e-14

# Value at the event of another block below which the quotient serves better.
NEAR = 1e-3


class EventSearch:
    """Finds events of chains of `blocks` blocks on pieces of a series; `time` is that of the last one found."""

    time: cython.double
    columns: cython.Py_ssize_t
    polynomial: SearchedPolynomial
    bounds: Bounds
    gap: Vectors
    gap_table: cython.double[:, ::1]
    root: Vectors
    root_table: cython.double[::1]
    zeros: cython.Py_ssize_t[::1]
    section: cython.Py_ssize_t
    least_section: cython.double
    blocks_in: cython.int[::1]

    def __init__(self, blocks: int) -> None:
        columns = (blocks + LANES) // LANES
        self.time = 0.0
        self.columns = columns
        self.polynomial = SearchedPolynomial(ORDER)
        self.bounds = Bounds(columns)
        self.gap = Vectors((ORDER + 1) * columns)
        self.gap_table = self.gap.table(ORDER + 1)
        self.root = Vectors(columns)
        self.root_table = self.root.table(1)[0]
        self.zeros = np.zeros(blocks, dtype=np.intp)
        # The lane of W, and those of blocks, as bits, in each column.
        self.section = blocks
        self.least_section = 0.0
        self.blocks_in = np.array([(1 << min(LANES, blocks - c * LANES)) - 1 for c in range(columns)], dtype=np.intc)

    def first(self, state: State, piece: Piece, reach: cython.double, side: cython.int) -> cython.Py_ssize_t:
        """Return the block that stops or starts first within the reach, −1 if none does; its time is in `time`.

        side : the sign of W, if its crossings are looked for as well, else 0
        """
        i: cython.Py_ssize_t
        block: cython.Py_ssize_t = -1
        self._load(state, piece, side)
        if self._whole(state, piece, reach):
            self.time = reach
            return -1
        if state.symmetric:
            for i in range(state.blocks):
                if state.slip[i] == 0 and (
                    self.zeros[i] > 0 or self.bounds.highest_table[i] >= 2.0 * state.springs.threshold[i]
                ):
                    return self._exhaustive(state, piece, reach)
        self.time = reach
        for i in range(state.blocks):
            if self.root_table[i] <= reach and (block < 0 or self.root_table[i] < self.time):
                self.time = self.root_table[i]
                block = i
        if block >= 0 and self._proved(piece, self.time):
            return block
        return self._exhaustive(state, piece, reach)

    def coincide(self, state: State, block: cython.Py_ssize_t, other: cython.Py_ssize_t) -> cython.bint:
        """Tell whether what decides about the next event is the same of two blocks, to the bit, as of mirror images.

        Then their events are one, whatever rounding leaves of both at its time.
        """
        k: cython.Py_ssize_t
        for k in range(ORDER + 1):
            if self.gap_table[k, block] != self.gap_table[k, other]:
                return False
        return state.springs.threshold[block] == state.springs.threshold[other]

    def crossing(self, length: cython.double) -> cython.double:
        """Return when W changes its sign in the first `length` of the reach, −1.0 if it does not; else UNCERTAIN."""
        root: cython.double = self.root_table[self.section]
        fall: cython.double = self.bounds.fall_table[self.section % LANES]
        if self.least_section > SEAM:
            return -1.0
        if self.gap_table[0, self.section] > 0.0 and root < UNKNOWN and fall * abs(length - root) > SEAM:
            return root if root < length else -1.0
        return UNCERTAIN

    def _load(self, state: State, piece: Piece, side: cython.int) -> None:
        """Take g of every block, its known zeros at the start divided out: a block that has just started has U' = 0."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        direction: vec
        stuck: vec
        columns: cython.Py_ssize_t = self.columns
        last: cython.Py_ssize_t = columns - 1
        g: cython.pointer[vec] = self.gap.at
        section: mask = from_bits(1 << self.section % LANES)
        for c in range(piece.columns):
            direction = piece.direction.at[c]
            stuck = piece.stuck.at[c]
            for k in range(ORDER + 1):
                g[k * columns + c] = (
                    direction * piece.velocities.at[k * piece.columns + c]
                    - stuck * piece.forces.at[k * piece.columns + c]
                )
            g[c] = g[c] + stuck * thresholds(state.springs, c)
        if columns > piece.columns:
            for k in range(ORDER + 1):
                g[k * columns + last] = splat(1.0 if k == 0 else 0.0)
        if side != 0:
            for k in range(ORDER + 1):
                g[k * columns + last] = select(section, splat(side * piece.section_row(k)), g[k * columns + last])
        for i in range(state.blocks):
            self.zeros[i] = 0
            # At its threshold by construction: what rounding leaves there must not start the block a second time.
            if (
                state.touching[i]
                and state.slip[i] == 0
                and abs(self.gap_table[0, i]) < 0.5 * state.springs.threshold[i]
            ):
                self.gap_table[0, i] = 0.0
        for c in range(piece.columns):
            if bits(equal(g[c], splat(0.0))) & self.blocks_in[c]:
                self._divide(c)

    def _divide(self, column: cython.Py_ssize_t) -> None:
        """Divide the zeros at the start out of the polynomials of one column."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        _times: cython.Py_ssize_t
        found: cython.int
        where: mask
        zero: vec = splat(0.0)
        columns: cython.Py_ssize_t = self.columns
        g: cython.pointer[vec] = self.gap.at + column
        for _times in range(ORDER):
            found = bits(equal(g[0], zero)) & self.blocks_in[column]
            if not found:
                return
            where = from_bits(found)
            for k in range(ORDER):
                g[k * columns] = select(where, g[(k + 1) * columns], g[k * columns])
            g[ORDER * columns] = select(where, zero, g[ORDER * columns])
            for i in range(column * LANES, min(len(self.zeros), (column + 1) * LANES)):
                self.zeros[i] += found >> (i - column * LANES) & 1

    def _whole(self, state: State, piece: Piece, reach: cython.double) -> cython.bint:
        """Tell whether bounds show that nothing happens in the reach; else leave a root of each block, or UNKNOWN."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        wanted: mask
        nothing: cython.bint = True
        never: vec = splat(UNKNOWN)
        self.bounds.measure(reach)
        for c in range(self.columns):
            self.bounds.scale(self.gap.at + c, self.columns)
            self.bounds.bound(c, from_bits(0))
            wanted = at_most(self.bounds.lowest.at[c], splat(0.0))
            self.root.at[c] = never
            if bits(wanted):
                self.root.at[c] = self._refine(c, self.bounds.guess(reach), reach, wanted)
                if c == self.section // LANES:
                    self.bounds.steepness(reach)
                nothing = nothing and not bits(wanted) & self.blocks_in[c]
        for i in range(state.blocks):
            piece.highest[i] = max(0.0, self.bounds.highest_table[i]) * self.bounds.power[self.zeros[i]]
            if state.symmetric and state.slip[i] == 0:
                nothing = (
                    nothing and self.zeros[i] == 0 and self.bounds.highest_table[i] < 2.0 * state.springs.threshold[i]
                )
        self.least_section = self.bounds.lowest_table[self.section]
        return nothing

    def _refine(self, column: cython.Py_ssize_t, t: vec, reach: cython.double, wanted: mask) -> vec:
        """Return the roots near guesses, by Halley's method; UNKNOWN where it does not converge within the reach."""
        k: cython.Py_ssize_t
        top: cython.Py_ssize_t
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
        for _iteration in range(GUESSES + ITERATIONS):
            if not bits(open_lanes):
                break
            # Even and odd powers apart, in z = t², since each sum waits for the last: g = e + t o.
            square = t * t
            # The first terms show the way at a third of the cost.
            top = LOW if _iteration < GUESSES else ORDER
            even = g[top * columns]
            odd = g[(top - 1) * columns]
            even_slope = zero
            odd_slope = zero
            even_curvature = zero
            odd_curvature = zero
            for k in range(top - 2, -1, -2):
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
            wanted = (
                good
                & less(step, (1e-5 if top == ORDER else 0.0) * end)
                & at_most(curvature, (CONVERGED * reach) * (slope * slope))
            )
            done = done | wanted
            open_lanes = good & ~wanted
        return select(done, t, splat(UNKNOWN))

    def _proved(self, piece: Piece, t: cython.double) -> cython.bint:
        """Tell whether no block has an event before t, by bounds over [0, t]."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        zero: vec = splat(0.0)
        total: vec
        term: vec
        near: mask
        self.bounds.measure(t)
        for c in range(piece.columns):
            # Coefficients of q: minus the sums of the higher terms of g.
            total = zero
            for k in range(ORDER, -1, -1):
                term = self.gap.at[k * self.columns + c] * self.bounds.power[k]
                self.bounds.scaled.at[k] = term
                self.bounds.quotient.at[k] = -total
                total = total + term
            # A block that has come near to its own event is proved by q, the others as they are.
            near = at_most(total, splat(NEAR)) & less(total, self.bounds.scaled.at[0])
            if bits(near & less(total, -COMMON * self.bounds.highest.at[c])) & self.blocks_in[c]:
                return False
            self.bounds.bound(c, near)
            if ~bits(less(zero, self.bounds.lowest.at[c])) & self.blocks_in[c]:
                return False
            for i in range(c * LANES, min(piece.blocks, (c + 1) * LANES)):
                if not bits(near) >> (i - c * LANES) & 1:
                    piece.highest[i] = min(
                        piece.highest[i], self.bounds.highest_table[i] * self.bounds.power[self.zeros[i]]
                    )
        return True

    def _exhaustive(self, state: State, piece: Piece, reach: cython.double) -> cython.Py_ssize_t:
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
