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
from cython.cimports.burridge_knopoff.kernel.springs import AFTER, BEFORE, DIAGONAL, pulls, thresholds
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, index, shuffle, splat, vec
from cython.cimports.libc.math import cos, exp, sin, sqrt

# Terms of the series below this share of a perturbation are left out.
NEGLIGIBLE = 1e-17

# Over x/(ω + a), ω² the bound of Gershgorin on the eigenvalues of K, the terms of the series fall at least like x^n/n!:
# with this x the first neglected one is rounding (2e-16 of the perturbation). The pieces of the motion may be longer:
# they are made for terms that are small beside 1, however small the motion itself is.
STRIDE = 2.4


@cache
def enough(order: int) -> np.ndarray:
    """Return for each n up to the order the x with x^n/n! = NEGLIGIBLE, to fewer digits than C libraries agree on."""
    return np.array([0.0, *(round((NEGLIGIBLE * factorial(n)) ** (1.0 / n), 9) for n in range(1, order + 1))])


class Tangent:
    """`vectors` perturbations of a chain, blocks in lanes; as tables δx and δU' have shape (vectors, lanes).

    `lost` and `deceleration` keep what a stop takes away, for a block that turns round at the same instant.
    """

    def __init__(self, blocks, vectors, order) -> None:
        columns = (blocks + LANES - 1) // LANES
        self.blocks = blocks
        self.vectors = vectors
        self.columns = columns
        self.length = order + 1
        self.positions = Vectors(vectors * columns)
        self.velocities = Vectors(vectors * columns)
        rows = max(vectors, 1)
        self.position = self.positions.table(rows) if vectors else np.zeros((1, columns * LANES))
        self.velocity = self.velocities.table(rows) if vectors else np.zeros((1, columns * LANES))
        self.lost = np.zeros((rows, blocks))
        self.deceleration = np.zeros(blocks)
        # Series of δU', one column or perturbation after the other, and the present row of δx.
        self.series = Vectors(max(columns, 3) * self.length)
        self.row = Vectors(columns)
        self.rates = Vectors(columns * self.length)
        self.rate_terms = 0
        self.pace = 0.0
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 2, dtype=float), 1.0)
        self.enough = enough(order)
        self.moved = np.zeros((rows, blocks))
        self.sped = np.zeros((rows, blocks))

    def load(self, matrix) -> None:
        """Set the perturbations to the columns of a matrix (2 blocks, vectors): rows δx_1 …, then δU_1' …"""
        n = self.blocks
        if self.vectors:
            np.asarray(self.position)[:, :n] = matrix[:n].T
            np.asarray(self.velocity)[:, :n] = matrix[n:].T
        self.forget_stops()

    def matrix(self) -> np.ndarray:
        """Return the perturbations as columns, shape (2 blocks, vectors)."""
        tables = np.asarray(self.position), np.asarray(self.velocity)
        return np.concatenate([table[: self.vectors, : self.blocks].T for table in tables])

    def forget_stops(self):
        """Time moves on, or begins again: what stops have taken away does not come back."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.deceleration[i] = 0.0

    def change(self, state, block):
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

    def follow_modes(self, state, modes, t):
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

    def load_rates(self, state, piece, length, reach):
        """Expand −threshold dΦ/dU' along a piece of the motion; return into how many parts to divide its length.

        reach : time for which the series of the motion was made to hold
        """
        c: cython.Py_ssize_t
        n: cython.Py_ssize_t
        slope: cython.int = state.friction.slope
        parts: cython.Py_ssize_t
        self.pace = sqrt(state.springs.stiffest) + state.friction.steepest
        parts = 1 + cython.cast(cython.Py_ssize_t, self.pace * length / STRIDE)
        self.rate_terms = 1
        if state.friction.linear:
            for c in range(self.columns):
                self.rates.at[c * self.length] = thresholds(state.springs, c) * state.friction.rate
            return parts
        self.rate_terms = piece.order if parts > 1 else self._degree(piece.order, length, reach)
        for c in range(self.columns):
            state.friction.complete(c, self.rate_terms)
            for n in range(self.rate_terms):
                self.rates.at[c * self.length + n] = -(thresholds(state.springs, c) * row(state.friction, slope, c)[n])
        return parts

    def move_rates(self, t):
        """Take the rates as series about the time t later (Horner's scheme, repeated)."""
        c: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        rate: cython.pointer[vec]
        for c in range(self.columns):
            rate = self.rates.at + c * self.length
            for n in range(self.rate_terms - 1):
                for j in range(self.rate_terms - 2, n - 1, -1):
                    rate[j] = rate[j] + t * rate[j + 1]

    def follow_series(self, state, piece, t, reach):
        """Propagate over a time t as a Taylor series, with the rates that are loaded."""
        v: cython.Py_ssize_t = 0
        degree: cython.Py_ssize_t = self._degree(piece.order, t, reach)
        if self.columns == 1:
            while v + 2 < self.vectors:
                self._follow_three(state.springs, piece.stuck.at[0], v, degree, t)
                v += 3
        while v < self.vectors:
            self._follow(state.springs, piece, v, degree, t)
            v += 1

    def _follow(self, springs, piece, v, degree, t):
        """Propagate one perturbation."""
        n: cython.Py_ssize_t
        k: cython.Py_ssize_t
        c: cython.Py_ssize_t
        columns: cython.Py_ssize_t = self.columns
        power: cython.double = 1.0
        x: cython.pointer[vec] = self.row.at
        u: cython.pointer[vec]
        rate: cython.pointer[vec]
        moving: vec
        change: vec
        odd: vec
        for c in range(columns):
            x[c] = self.positions.at[v * columns + c]
            self.series.at[c * self.length] = self.velocities.at[v * columns + c]
        for n in range(degree):
            power = power * t
            for c in range(columns):
                u = self.series.at + c * self.length
                rate = self.rates.at + c * self.length
                moving = (splat(1.0) - piece.stuck.at[c]) * self.reciprocal[n + 1]
                # As in `_follow_three`, to the bit.
                change = odd = splat(0.0)
                k = min(n, self.rate_terms - 1)
                while k >= 2:
                    change += rate[k] * u[n - k]
                    odd += rate[k - 1] * u[n - k + 1]
                    k -= 2
                if k == 1:
                    change += rate[1] * u[n - 1]
                change = (change + odd) + rate[0] * u[n]
                u[n + 1] = moving * (change + pulls(springs, x, c))
                self.velocities.at[v * columns + c] = self.velocities.at[v * columns + c] + power * u[n + 1]
            for c in range(columns):
                moving = (splat(1.0) - piece.stuck.at[c]) * self.reciprocal[n + 1]
                x[c] = moving * self.series.at[c * self.length + n]
                self.positions.at[v * columns + c] = self.positions.at[v * columns + c] + power * x[c]

    def _follow_three(self, springs, stuck, v, degree, t):
        """Propagate three perturbations of blocks that lie in one vector, which need not wait for memory."""
        n: cython.Py_ssize_t
        k: cython.Py_ssize_t
        power: cython.double = 1.0
        rate: cython.pointer[vec] = self.rates.at
        u: cython.pointer[vec] = self.series.at
        u_b: cython.pointer[vec] = u + self.length
        u_c: cython.pointer[vec] = u_b + self.length
        diagonal: vec = springs.lanes.at[DIAGONAL]
        before: vec = springs.lanes.at[BEFORE]
        after: vec = springs.lanes.at[AFTER]
        previous: index = cython.cast(cython.pointer[index], springs.from_previous.at)[0]
        following: index = cython.cast(cython.pointer[index], springs.from_next.at)[0]
        moving: vec
        change: vec
        change_b: vec
        change_c: vec
        odd: vec
        odd_b: vec
        odd_c: vec
        x: vec = self.positions.at[v]
        x_b: vec = self.positions.at[v + 1]
        x_c: vec = self.positions.at[v + 2]
        speed: vec = self.velocities.at[v]
        speed_b: vec = self.velocities.at[v + 1]
        speed_c: vec = self.velocities.at[v + 2]
        position: vec = x
        position_b: vec = x_b
        position_c: vec = x_c
        velocity: vec = speed
        velocity_b: vec = speed_b
        velocity_c: vec = speed_c
        for n in range(degree):
            power = power * t
            u[n] = speed
            u_b[n] = speed_b
            u_c[n] = speed_c
            moving = (splat(1.0) - stuck) * self.reciprocal[n + 1]
            # Two sums each, which a processor forms at the same time.
            change = change_b = change_c = splat(0.0)
            odd = odd_b = odd_c = change
            k = min(n, self.rate_terms - 1)
            while k >= 2:
                change += rate[k] * u[n - k]
                change_b += rate[k] * u_b[n - k]
                change_c += rate[k] * u_c[n - k]
                odd += rate[k - 1] * u[n - k + 1]
                odd_b += rate[k - 1] * u_b[n - k + 1]
                odd_c += rate[k - 1] * u_c[n - k + 1]
                k -= 2
            if k == 1:
                change += rate[1] * u[n - 1]
                change_b += rate[1] * u_b[n - 1]
                change_c += rate[1] * u_c[n - 1]
            change = (change + odd) + rate[0] * speed
            change_b = (change_b + odd_b) + rate[0] * speed_b
            change_c = (change_c + odd_c) + rate[0] * speed_c
            change += (before * shuffle(x, x, previous) + after * shuffle(x, x, following)) - diagonal * x
            change_b += (before * shuffle(x_b, x_b, previous) + after * shuffle(x_b, x_b, following)) - diagonal * x_b
            change_c += (before * shuffle(x_c, x_c, previous) + after * shuffle(x_c, x_c, following)) - diagonal * x_c
            x = moving * speed
            x_b = moving * speed_b
            x_c = moving * speed_c
            speed = moving * change
            speed_b = moving * change_b
            speed_c = moving * change_c
            position += power * x
            position_b += power * x_b
            position_c += power * x_c
            velocity += power * speed
            velocity_b += power * speed_b
            velocity_c += power * speed_c
        self.positions.at[v] = position
        self.positions.at[v + 1] = position_b
        self.positions.at[v + 2] = position_c
        self.velocities.at[v] = velocity
        self.velocities.at[v + 1] = velocity_b
        self.velocities.at[v + 2] = velocity_c

    def _degree(self, order, t, reach):
        """Return how many terms a time t needs, at most `order`.

        They fall like x^n/n!. Those of the motion, and with them the rates, have x about 1.75 over its reach: so fall
        `order` terms of an exponential function to what the reach was made for. For the perturbations see STRIDE.
        """
        n: cython.Py_ssize_t = 1
        x: cython.double = max(1.75 * t / reach, self.pace * t)
        while n < order and x > self.enough[n]:
            n += 1
        return n
