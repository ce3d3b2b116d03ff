"""Tangent dynamics: how small perturbations δx_i, δU_i' of a run grow, through stops and starts.

Between events a perturbation obeys the linearized equations of the slipping blocks,

    δx' = δU',    δU_i'' = −(K δx)_i − threshold_i (dΦ/dU') δU_i',    stuck blocks: δU_i' = 0.

At a stop of block i, whose acceleration is A before and 0 after it, the saltation matrix 1 + (f⁺ − f⁻)nᵀ/(nᵀf⁻) with n
along U_i' sets δU_i' to 0 and leaves all else. At a start n is along the spring force s_i and f⁺ − f⁻ is the
acceleration A⁺ of a block that starts: δU_i' becomes A⁺ δs_i/s_i'. Where friction does not drop at the start, A⁺ = 0
and the matrix is the identity. A block that turns round at once, beyond the threshold of a symmetric contact, has A⁺
after the stop and its perturbation is multiplied by A⁺/A.

Reference: R. I. Leine and H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems" (Springer 2004).
"""

from functools import cache
from math import factorial

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import row
from cython.cimports.burridge_knopoff.kernel.modes import Modes
from cython.cimports.burridge_knopoff.kernel.piece import Piece
from cython.cimports.burridge_knopoff.kernel.springs import AFTER, BEFORE, DIAGONAL, Springs, neighbours, thresholds
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.tangent import follow_together, spread
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, bits, largest, less, magnitude, splat, vec
from cython.cimports.libc.math import cos, exp, sin, sqrt

# What may be left out of a perturbation over one piece of the motion, as a share of it. Rates and perturbations each
# leave out that much by the bounds below, about 1e-12 at worst together; as a rule it is less than 1e-13.
NEGLIGIBLE = 5e-13

# Over x/(ω + a), ω² a bound on the eigenvalues of K, the terms of the series fall at least like x^n/n! if the rates are
# constant: with this x the first neglected one is rounding. The pieces of the motion may be longer: they are made for
# terms that are small beside 1, however small the motion itself is.
STRIDE = 2.4

# Rates fall like the terms of the motion, which come down to 2^-53 in 22 steps at the end of a piece: each to this
# share of the one before, as a rule.
FALL = 0.19

# Slower than x^n/n!, rates that vary make the terms of a perturbation fall like FALL^n in the end. For them x is taken
# larger by this factor.
SLOWER = 1.25


@cache
def enough(longest: int) -> np.ndarray:
    """Return for each degree n up to the longest the x with x^(n+1)/(n+1)! = NEGLIGIBLE.

    They are rounded to fewer digits than C libraries agree on.
    """
    return np.array([round((NEGLIGIBLE * factorial(n + 1)) ** (1.0 / (n + 1)), 9) for n in range(longest + 1)])


class Tangent:
    """`vectors` perturbations of a chain, blocks in lanes; as tables δx and δU' have one row each.

    Of a short chain as many perturbations lie side by side in a vector as there is room for.
    `lost` and `deceleration` keep what a stop takes away, for a block that turns round at the same instant.
    """

    blocks: cython.Py_ssize_t
    vectors: cython.Py_ssize_t
    columns: cython.Py_ssize_t
    packs: cython.Py_ssize_t
    longest: cython.Py_ssize_t
    length: cython.Py_ssize_t
    positions: Vectors
    velocities: Vectors
    position: cython.double[:, ::1]
    velocity: cython.double[:, ::1]
    lost: cython.double[:, ::1]
    deceleration: cython.double[::1]
    series: Vectors
    row: Vectors
    moving: Vectors
    weights: Vectors
    lookup: Vectors
    rates: Vectors
    rate_terms: cython.Py_ssize_t
    degree: cython.Py_ssize_t
    reciprocal: cython.double[::1]
    enough: cython.double[::1]
    moved: cython.double[:, ::1]
    sped: cython.double[:, ::1]

    def __init__(self, blocks: int, vectors: int, order: int) -> None:
        columns = (blocks + LANES - 1) // LANES
        side = max(LANES // blocks, 1)
        packs = (vectors + side - 1) // side
        self.blocks = blocks
        self.vectors = vectors
        self.columns = columns
        self.packs = packs
        # Degrees are odd, as coefficients are found two at a time.
        self.longest = order | 1
        self.length = self.longest + 1
        self.positions = Vectors(max(packs, 1) * columns)
        self.velocities = Vectors(max(packs, 1) * columns)
        self.position = self.positions.table(max(packs, 1) * side)
        self.velocity = self.velocities.table(max(packs, 1) * side)
        self.lost = np.zeros((vectors, blocks))
        self.deceleration = np.zeros(blocks)
        # Series of δU', one column after the other or three vectors side by side, and the present row of δx.
        self.series = Vectors(max(columns, 3) * self.length)
        self.row = Vectors(columns)
        # Which blocks slip, and the springs to them times the length of a part: rows as in `springs.lanes`.
        self.moving = Vectors(columns)
        self.weights = Vectors(3 * columns)
        self.rates = Vectors(columns * self.length)
        self.rate_terms = 0
        self.degree = 0
        self.reciprocal = 1.0 / np.maximum(np.arange(self.length, dtype=float), 1.0)
        self.enough = enough(self.longest)
        self.moved = np.zeros((vectors, blocks))
        self.sped = np.zeros((vectors, blocks))
        # Where a lane finds the block that it stands for, and the neighbours of that block beside it.
        width = LANES // side
        lane = np.arange(LANES)
        own = lane % width
        neighbours = own, (own - 1) % blocks + (lane - own), (own + 1) % blocks + (lane - own)
        self.lookup = Vectors(3)
        self.lookup.set(np.concatenate(neighbours).astype(np.int64).view(float))

    def load(self, matrix: np.ndarray) -> None:
        """Set the perturbations to the columns of a matrix (2 blocks, vectors): rows δx_1 …, then δU_1' …"""
        n = self.blocks
        if self.vectors:
            np.asarray(self.position)[: self.vectors, :n] = matrix[:n].T
            np.asarray(self.velocity)[: self.vectors, :n] = matrix[n:].T
        self.forget_stops()

    def matrix(self) -> np.ndarray:
        """Return the perturbations as columns, shape (2 blocks, vectors)."""
        tables = np.asarray(self.position), np.asarray(self.velocity)
        return np.concatenate([table[: self.vectors, : self.blocks].T for table in tables])

    def forget_stops(self) -> None:
        """Forget what stops have taken away, as time moves on or begins again."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.deceleration[i] = 0.0

    def change(self, state: State, block: cython.Py_ssize_t) -> None:
        """Carry the perturbations through a stop or start that this block is about to make."""
        c: cython.Py_ssize_t
        force: cython.double
        sign: cython.double
        factor: cython.double
        if state.slip[block] != 0:
            self.deceleration[block] = state.slip_acceleration(block)
            for c in range(self.vectors):
                self.lost[c, block] = self.velocity[c, block]
                self.velocity[c, block] = 0.0
            return
        force = state.spring_force(block)
        sign = 1.0 if force > 0.0 else -1.0
        if self.deceleration[block] != 0.0:
            factor = force - sign * (state.springs.threshold[block] * state.friction.at_rest)
            factor /= self.deceleration[block]
            for c in range(self.vectors):
                self.velocity[c, block] = factor * self.lost[c, block]
        elif state.drops and state.at_threshold(block, force):
            factor = sign * state.start_acceleration(block) / state.force_rate(block)
            for c in range(self.vectors):
                self.velocity[c, block] = factor * state.springs.pull(cython.address(self.position[c, 0]), block)

    def follow_modes(self, state: State, modes: Modes, t: cython.double) -> None:
        """Propagate over a time t without events in closed form; `modes` holds the slipping blocks."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        line: cython.Py_ssize_t
        first: cython.Py_ssize_t
        last: cython.Py_ssize_t
        factor: cython.double
        omega: cython.double
        eigenvalue: cython.double
        cosine: cython.double
        sine: cython.double
        q: cython.double
        rate: cython.double
        moved: cython.double
        left: cython.double
        right: cython.double
        half: cython.double = 0.5 * modes.rate
        growth: cython.double = exp(half * t)
        for c in range(self.vectors):
            for i in range(self.blocks):
                self.moved[c, i] = 0.0
                self.sped[c, i] = 0.0
        for n in range(modes.runs):
            first = modes.first[n]
            last = modes.last[n]
            for k in range(first, last + 1):
                line = modes.row[n] + k - first
                eigenvalue = modes.eigenvalue[line]
                omega = sqrt(eigenvalue - half * half)
                cosine = growth * cos(omega * t) - 1.0
                sine = growth * sin(omega * t) / omega
                left = modes.vector[line, 0] * state.springs.before[first] / eigenvalue
                right = modes.vector[line, last - first] * state.springs.after[last] / eigenvalue
                for c in range(self.vectors):
                    q = (
                        -left * self.position[c, state.springs.previous[first]]
                        - right * self.position[c, state.springs.next[last]]
                    )
                    rate = 0.0
                    for i in range(first, last + 1):
                        factor = modes.vector[line, i - first]
                        q += factor * self.position[c, i]
                        rate += factor * self.velocity[c, i]
                    moved = q * cosine + (rate - half * q) * sine
                    rate = rate * cosine + (half * rate - eigenvalue * q) * sine
                    for i in range(first, last + 1):
                        factor = modes.vector[line, i - first]
                        self.moved[c, i] += factor * moved
                        self.sped[c, i] += factor * rate
        for c in range(self.vectors):
            for i in range(self.blocks):
                self.position[c, i] += self.moved[c, i]
                self.velocity[c, i] += self.sped[c, i]

    def load_rates(self, state: State, piece: Piece, length: cython.double) -> cython.Py_ssize_t:
        """Expand −threshold dΦ/dU' along a piece of the motion; return into how many parts to divide its length.

        Coefficient k is multiplied by t^(k+1), with t the length of a part, and is 0 where a block sticks.
        """
        c: cython.Py_ssize_t
        k: cython.Py_ssize_t
        first: cython.Py_ssize_t = 0
        pace: cython.double = state.springs.fastest + state.friction.steepest
        parts: cython.Py_ssize_t = 1 + cython.cast(cython.Py_ssize_t, pace * length / STRIDE)
        t: cython.double = length / parts if parts > 1 else length
        x: cython.double = pace * t if state.friction.linear else SLOWER * pace * t
        slips: vec
        self.rate_terms = 1
        self.degree = self.longest
        while self.degree > 3 and x <= self.enough[self.degree - 2]:
            self.degree -= 2
        for c in range(self.columns):
            slips = splat(1.0) - spread(self, piece.stuck.at[c])
            self.moving.at[c] = slips
            for k in range(3):
                self.weights.at[k * self.columns + c] = (t * slips) * spread(
                    self, state.springs.lanes.at[k * self.columns + c]
                )
            if state.friction.linear:
                self.rates.at[c * self.length] = (t * slips) * (
                    spread(self, thresholds(state.springs, c)) * state.friction.rate
                )
        if state.friction.linear:
            return parts
        # Fewer rates than terms: one that is left out does harm by itself only, but in a term all rates add up.
        self.rate_terms = self.degree - self.degree // 5
        if parts > 1:
            self.degree = self.longest
            self.rate_terms = piece.order
        while True:
            for c in range(self.columns):
                self._expand_rates(state, c, first, t)
            if self.rate_terms == piece.order or self._is_enough():
                return parts
            first = self.rate_terms
            self.rate_terms = min(first + 2, piece.order)
            self.degree = min(self.degree + 2, self.longest)

    def _expand_rates(self, state: State, c: cython.Py_ssize_t, first: cython.Py_ssize_t, t: cython.double) -> None:
        """Fill the rates in one column; of the series of the slope, coefficients below `first` are there."""
        n: cython.Py_ssize_t
        square: cython.double = t * t
        factor: vec = -t * (spread(self, thresholds(state.springs, c)) * self.moving.at[c])
        slope: cython.pointer[vec] = row(state.friction, state.friction.slope, c)
        rate: cython.pointer[vec] = self.rates.at + c * self.length
        state.friction.complete(c, first, self.rate_terms)
        # Two at a time, as each power waits for the last.
        for n in range(0, self.rate_terms, 2):
            rate[n] = factor * spread(self, slope[n])
            rate[n + 1] = (factor * t) * spread(self, slope[n + 1])
            factor = factor * square
        for n in range(self.rate_terms, self.degree):
            rate[n] = splat(0.0)

    def _is_enough(self) -> cython.bint:
        """Tell whether the rates that are left out are negligible, by the last two that are there."""
        c: cython.Py_ssize_t
        last: cython.pointer[vec]
        limit: vec = splat(NEGLIGIBLE * (self.rate_terms + 1))
        for c in range(self.columns):
            last = self.rates.at + c * self.length + self.rate_terms - 2
            if bits(less(limit, FALL * largest(magnitude(last[1]), FALL * magnitude(last[0])))) != 0:
                return False
        return True

    def move_rates(self) -> None:
        """Take the rates as series about the end of a part (Horner's scheme, repeated)."""
        c: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        rate: cython.pointer[vec]
        for c in range(self.columns):
            rate = self.rates.at + c * self.length
            for n in range(self.rate_terms - 1):
                for j in range(self.rate_terms - 2, n - 1, -1):
                    rate[j] = rate[j] + rate[j + 1]

    def follow_series(self, springs: Springs, t: cython.double) -> None:
        """Propagate over one part of a piece, of length t, with what `load_rates` has made ready for it.

        With all coefficients multiplied by the power of t that they belong to,

            u_(n+1) = (pulls(x_n) + sum of rate_k u_(n-k))/(n + 1),      x_(n+1) = t u_n/(n + 1).
        """
        v: cython.Py_ssize_t = 0
        if self.columns > 1:
            for v in range(self.vectors):
                self._follow(springs, v, t)
            return
        while v < self.packs:
            # Numbers that a compiler knows: what each of them needs is then kept in registers.
            if self.packs - v >= 3:
                follow_together(self, v, t, 3)
            elif self.packs - v == 2:
                follow_together(self, v, t, 2)
            else:
                follow_together(self, v, t, 1)
            v += 3

    def _follow(self, springs: Springs, v: cython.Py_ssize_t, t: cython.double) -> None:
        """Propagate one perturbation of a chain of several columns, to the bit as `follow_together` would."""
        n: cython.Py_ssize_t
        j: cython.Py_ssize_t
        c: cython.Py_ssize_t
        columns: cython.Py_ssize_t = self.columns
        diagonal: cython.pointer[vec] = self.weights.at + DIAGONAL * columns
        before: cython.pointer[vec] = self.weights.at + BEFORE * columns
        after: cython.pointer[vec] = self.weights.at + AFTER * columns
        x: cython.pointer[vec] = self.row.at
        position: cython.pointer[vec] = self.positions.at + v * columns
        velocity: cython.pointer[vec] = self.velocities.at + v * columns
        u: cython.pointer[vec]
        rate: cython.pointer[vec]
        change: vec
        for c in range(columns):
            self.series.at[c * self.length] = velocity[c] * self.moving.at[c]
            x[c] = position[c]
        for n in range(self.degree):
            for c in range(columns):
                u = self.series.at + c * self.length
                rate = self.rates.at + c * self.length
                change = splat(0.0)
                if self.rate_terms > 1:
                    for j in range(n):
                        change = change + rate[n - j] * u[j]
                change = change - diagonal[c] * x[c]
                change = change + neighbours(springs, before, after, x, c)
                u[n + 1] = (change + rate[0] * u[n]) * self.reciprocal[n + 1]
                velocity[c] = velocity[c] + u[n + 1]
            for c in range(columns):
                x[c] = self.series.at[c * self.length + n] * (t * self.reciprocal[n + 1])
                position[c] = position[c] + x[c]
