"""Perturbations along a piece of the motion, as Taylor series of their own, for `series`."""

from functools import cache
from math import factorial

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import row
from cython.cimports.burridge_knopoff.kernel.piece import Piece
from cython.cimports.burridge_knopoff.kernel.springs import AFTER, BEFORE, DIAGONAL, Springs, neighbours, thresholds
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
from cython.cimports.burridge_knopoff.kernel.tangent_series import LENGTH, follow_together, spread
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, bits, largest, less, magnitude, splat, vec

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


class TangentSeries:
    """Moves the perturbations of a Tangent along pieces of the motion, part by part."""

    vectors: cython.Py_ssize_t
    columns: cython.Py_ssize_t
    packs: cython.Py_ssize_t
    positions: Vectors
    velocities: Vectors
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

    def __init__(self, tangent: Tangent) -> None:
        columns = tangent.columns
        self.vectors = tangent.vectors
        self.columns = columns
        self.packs = tangent.packs
        self.positions = tangent.positions
        self.velocities = tangent.velocities
        # Series of δU', one column after the other or three vectors side by side, and the present row of δx.
        self.series = Vectors(max(columns, 3) * LENGTH)
        self.row = Vectors(columns)
        # Which blocks slip, and the springs to them times the length of a part: rows as in `springs.lanes`.
        self.moving = Vectors(columns)
        self.weights = Vectors(3 * columns)
        self.rates = Vectors(columns * LENGTH)
        self.rate_terms = 0
        self.degree = 0
        self.reciprocal = 1.0 / np.maximum(np.arange(LENGTH, dtype=float), 1.0)
        self.enough = enough(LENGTH - 1)
        # Where a lane finds the block that it stands for, and the neighbours of that block beside it.
        width = LANES // tangent.side
        lane = np.arange(LANES)
        own = lane % width
        beside = lane - own
        lanes = own, (own - 1) % tangent.blocks + beside, (own + 1) % tangent.blocks + beside
        self.lookup = Vectors(3)
        self.lookup.set(np.concatenate(lanes).astype(np.int64).view(float))

    def load(self, state: State, piece: Piece, length: cython.double) -> cython.Py_ssize_t:
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
        self.degree = LENGTH - 1
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
                self.rates.at[c * LENGTH] = (t * slips) * (
                    spread(self, thresholds(state.springs, c)) * state.friction.rate
                )
        if state.friction.linear:
            return parts
        # Fewer rates than terms: one that is left out does harm by itself only, but in a term all rates add up.
        self.rate_terms = self.degree - self.degree // 5
        if parts > 1:
            self.degree = LENGTH - 1
            self.rate_terms = piece.order
        while True:
            for c in range(self.columns):
                self._expand_rates(state, c, first, t)
            if self.rate_terms == piece.order or self._is_enough():
                return parts
            first = self.rate_terms
            self.rate_terms = min(first + 2, piece.order)
            self.degree = min(self.degree + 2, LENGTH - 1)

    def _expand_rates(self, state: State, c: cython.Py_ssize_t, first: cython.Py_ssize_t, t: cython.double) -> None:
        """Fill the rates in one column; of the series of the slope, coefficients below `first` are there."""
        n: cython.Py_ssize_t
        square: cython.double = t * t
        factor: vec = -t * (spread(self, thresholds(state.springs, c)) * self.moving.at[c])
        slope: cython.pointer[vec] = row(state.friction, state.friction.slope, c)
        rate: cython.pointer[vec] = self.rates.at + c * LENGTH
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
            last = self.rates.at + c * LENGTH + self.rate_terms - 2
            if bits(less(limit, FALL * largest(magnitude(last[1]), FALL * magnitude(last[0])))) != 0:
                return False
        return True

    def move_on(self) -> None:
        """Take the rates as series about the end of a part (Horner's scheme, repeated)."""
        c: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        rate: cython.pointer[vec]
        for c in range(self.columns):
            rate = self.rates.at + c * LENGTH
            for n in range(self.rate_terms - 1):
                for j in range(self.rate_terms - 2, n - 1, -1):
                    rate[j] = rate[j] + rate[j + 1]

    def follow(self, springs: Springs, t: cython.double) -> None:
        """Propagate over one part of a piece, of length t, with what `load` has made ready for it.

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
            self.series.at[c * LENGTH] = velocity[c] * self.moving.at[c]
            x[c] = position[c]
        for n in range(self.degree):
            for c in range(columns):
                u = self.series.at + c * LENGTH
                rate = self.rates.at + c * LENGTH
                change = splat(0.0)
                if self.rate_terms > 1:
                    for j in range(n):
                        change = change + rate[n - j] * u[j]
                change = change - diagonal[c] * x[c]
                change = change + neighbours(springs, before, after, x, c)
                u[n + 1] = (change + rate[0] * u[n]) * self.reciprocal[n + 1]
                velocity[c] = velocity[c] + u[n + 1]
            for c in range(columns):
                x[c] = self.series.at[c * LENGTH + n] * (t * self.reciprocal[n + 1])
                position[c] = position[c] + x[c]
