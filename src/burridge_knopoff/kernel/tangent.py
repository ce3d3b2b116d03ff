"""Tangent dynamics: how small perturbations δx_i, δU_i' of a run grow, through stops and starts.

Between events a perturbation obeys the linearized equations of the slipping blocks,

    δx' = δU',    δU_i'' = −(K δx)_i + a Φ_i² δU_i'   (Φ² = 1 for the linearized law),    stuck blocks: δU_i' = 0.

At a stop of block i, whose acceleration is A before and 0 after it, the saltation matrix 1 + (f⁺ − f⁻)nᵀ/(nᵀf⁻) with n
along U_i' sets δU_i' to 0 and leaves all else. At a start the motion is smooth (U'' = 0 on both sides): the matrix is
the identity. A block that turns round at once, beyond the threshold of a symmetric contact, has A⁺ after the stop and
its perturbation is multiplied by A⁺/A.

Reference: R. I. Leine and H. Nijmeijer, "Dynamics and Bifurcations of Non-Smooth Mechanical Systems" (Springer 2004).
"""

import cython
import numpy as np
from cython.cimports.libc.math import cos, exp, sin, sqrt

# Vectors are stored in groups of four, which a processor handles at once.
GROUP = 4

# Terms of the series below this share of a perturbation are left out.
NEGLIGIBLE = 1e-17

# Over x/(ω + a), ω² the bound of Gershgorin on the eigenvalues of K, the terms of the series fall at least like x^n/n!:
# with this x the first neglected one is rounding (2e-16 of the perturbation). The pieces of the motion may be longer:
# they are made for terms that are small beside 1, however small the motion itself is.
STRIDE = 2.4


class Tangent:
    """`vectors` perturbations of a chain; tables of shape (blocks + 2, lanes) with ghost rows for missing neighbours.

    `lost` and `deceleration` keep what a stop takes away, for a block that turns round at the same instant.
    """

    def __init__(self, blocks, vectors, order) -> None:
        self.blocks = blocks
        self.vectors = vectors
        self.lanes = (vectors + GROUP - 1) // GROUP * GROUP
        self.position = np.zeros((blocks + 2, self.lanes))
        self.velocity = np.zeros((blocks + 2, self.lanes))
        self.lost = np.zeros((blocks, self.lanes))
        self.deceleration = np.zeros(blocks)
        self.position_series = np.zeros((order + 1, blocks + 2, self.lanes))
        self.velocity_series = np.zeros((order + 1, blocks + 2, self.lanes))
        self.rate = np.zeros((blocks, order + 1))
        self.rate_terms = 0
        self.pace = 0.0
        self.amplitude = np.zeros(self.lanes)
        self.amplitude_rate = np.zeros(self.lanes)
        self.moved = np.zeros((blocks, self.lanes))
        self.sped = np.zeros((blocks, self.lanes))

    def load(self, matrix) -> None:
        """Set the perturbations to the columns of a matrix (2 blocks, vectors): rows δx_1 …, then δU_1' …"""
        n = self.blocks
        np.asarray(self.position)[1 : n + 1, : self.vectors] = matrix[:n]
        np.asarray(self.velocity)[1 : n + 1, : self.vectors] = matrix[n:]
        self.forget_stops()

    def matrix(self) -> np.ndarray:
        """Return the perturbations as columns, shape (2 blocks, vectors)."""
        n = self.blocks
        tables = np.asarray(self.position), np.asarray(self.velocity)
        return np.concatenate([table[1 : n + 1, : self.vectors] for table in tables])

    def forget_stops(self):
        """Time moves on, or begins again: what stops have taken away does not come back."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.deceleration[i] = 0.0

    def change(self, state, block):
        """Carry the perturbations through a stop or start that this block is about to make."""
        c: cython.Py_ssize_t
        force: cython.double
        factor: cython.double
        if state.slip[block] != 0:
            self.deceleration[block] = state.slip_acceleration(block)
            for c in range(self.lanes):
                self.lost[block, c] = self.velocity[block + 1, c]
                self.velocity[block + 1, c] = 0.0
        elif self.deceleration[block] != 0.0:
            force = state.spring_force(block)
            factor = (force - (1.0 if force > 0.0 else -1.0)) / self.deceleration[block]
            for c in range(self.lanes):
                self.velocity[block + 1, c] = factor * self.lost[block, c]

    def follow_modes(self, state, modes, t):
        """Propagate over a time t without events under the linearized law; `modes` holds the slipping blocks."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t
        last: cython.Py_ssize_t
        factor: cython.double
        omega: cython.double
        eigenvalue: cython.double
        cosine: cython.double
        sine: cython.double
        q: cython.double
        left: cython.double
        right: cython.double
        half: cython.double = 0.5 * state.a
        growth: cython.double = exp(half * t)
        for i in range(self.blocks):
            for c in range(self.lanes):
                self.moved[i, c] = 0.0
                self.sped[i, c] = 0.0
        for n in range(modes.runs):
            first = modes.first[n]
            last = modes.last[n]
            for k in range(first, last + 1):
                row = modes.row[n] + k - first
                eigenvalue = modes.eigenvalue[row]
                omega = sqrt(eigenvalue - half * half)
                cosine = growth * cos(omega * t) - 1.0
                sine = growth * sin(omega * t) / omega
                left = modes.vector[row, 0] / eigenvalue
                right = modes.vector[row, last - first] / eigenvalue
                for c in range(self.lanes):
                    self.amplitude[c] = -left * self.position[first, c] * (first > 0) - right * self.position[
                        last + 2, c
                    ] * (last < self.blocks - 1)
                    self.amplitude_rate[c] = 0.0
                for i in range(first, last + 1):
                    factor = modes.vector[row, i - first]
                    for c in range(self.lanes):
                        self.amplitude[c] += factor * self.position[i + 1, c]
                        self.amplitude_rate[c] += factor * self.velocity[i + 1, c]
                for c in range(self.lanes):
                    q = self.amplitude[c]
                    self.amplitude[c] = q * cosine + (self.amplitude_rate[c] - half * q) * sine
                    self.amplitude_rate[c] = (
                        self.amplitude_rate[c] * cosine + (half * self.amplitude_rate[c] - eigenvalue * q) * sine
                    )
                for i in range(first, last + 1):
                    factor = modes.vector[row, i - first]
                    for c in range(self.lanes):
                        self.moved[i, c] += factor * self.amplitude[c]
                        self.sped[i, c] += factor * self.amplitude_rate[c]
        for i in range(self.blocks):
            for c in range(self.lanes):
                self.position[i + 1, c] += self.moved[i, c]
                self.velocity[i + 1, c] += self.sped[i, c]

    def load_rates(self, state, piece, series, length, reach):
        """Expand aΦ² of a piece of the motion under the nonlinear law; return into how many parts to divide its length.

        reach : time for which the series of the motion was made to hold
        """
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        total: cython.double
        parts: cython.Py_ssize_t
        order: cython.Py_ssize_t = piece.order
        self.pace = 0.0
        for i in range(self.blocks):
            self.pace = max(self.pace, sqrt(1.5 * state.stiffness[i]) + state.a)
        parts = 1 + cython.cast(cython.Py_ssize_t, self.pace * length / STRIDE)
        self.rate_terms = order if parts > 1 else self._degree(order, length, reach)
        for i in range(self.blocks):
            for n in range(self.rate_terms):
                total = 0.0
                if state.slip[i] != 0:
                    for j in range(n + 1):
                        total += series.friction[i, order - j] * series.friction[i, order - n + j]
                self.rate[i, n] = state.a * total
        return parts

    def move_rates(self, t):
        """Take aΦ² as a series about the time t later (Horner's scheme, repeated)."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        for i in range(self.blocks):
            for n in range(self.rate_terms - 1):
                for j in range(self.rate_terms - 2, n - 1, -1):
                    self.rate[i, j] += t * self.rate[i, j + 1]

    def follow_series(self, state, t, reach):
        """Propagate over a time t under the nonlinear law, as a Taylor series, with the rates that are loaded."""
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        degree: cython.Py_ssize_t = self._degree(self.rate_terms, t, reach)
        for c in range(self.lanes // GROUP):
            self._expand(state, degree, c * GROUP)
        for i in range(1, self.blocks + 1):
            for c in range(self.lanes):
                self.position[i, c] = self.position_series[degree, i, c]
                self.velocity[i, c] = self.velocity_series[degree, i, c]
        for n in range(degree - 1, -1, -1):
            for i in range(1, self.blocks + 1):
                for c in range(self.lanes):
                    self.position[i, c] = self.position[i, c] * t + self.position_series[n, i, c]
                    self.velocity[i, c] = self.velocity[i, c] * t + self.velocity_series[n, i, c]

    def _degree(self, order, t, reach):
        """Return how many terms a time t needs, at most `order`.

        They fall like x^n/n!. Those of the motion, and with them the rates, have x about 1.75 over its reach: so fall
        `order` terms of an exponential function to what the reach was made for. For the perturbations see STRIDE.
        """
        n: cython.Py_ssize_t = 1
        x: cython.double = max(1.75 * t / reach, self.pace * t)
        term: cython.double = x
        while term > NEGLIGIBLE and n < order:
            n += 1
            term *= x / n
        return n

    def _expand(self, state, degree, group):
        """Fill the series of four vectors by the recursion of the linearized equations."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        factor: cython.double
        rate: cython.double
        first: cython.double
        second: cython.double
        third: cython.double
        fourth: cython.double
        for i in range(1, self.blocks + 1):
            for c in range(group, group + GROUP):
                self.position_series[0, i, c] = self.position[i, c]
                self.velocity_series[0, i, c] = self.velocity[i, c]
        for n in range(degree):
            factor = 1.0 / (n + 1)
            for i in range(1, self.blocks + 1):
                if state.slip[i - 1] == 0:
                    for c in range(group, group + GROUP):
                        self.position_series[n + 1, i, c] = 0.0
                        self.velocity_series[n + 1, i, c] = 0.0
                    continue
                first = second = third = fourth = 0.0
                for j in range(n + 1):
                    rate = self.rate[i - 1, j]
                    first += rate * self.velocity_series[n - j, i, group]
                    second += rate * self.velocity_series[n - j, i, group + 1]
                    third += rate * self.velocity_series[n - j, i, group + 2]
                    fourth += rate * self.velocity_series[n - j, i, group + 3]
                self.velocity_series[n + 1, i, group] = first
                self.velocity_series[n + 1, i, group + 1] = second
                self.velocity_series[n + 1, i, group + 2] = third
                self.velocity_series[n + 1, i, group + 3] = fourth
                for c in range(group, group + GROUP):
                    self.position_series[n + 1, i, c] = factor * self.velocity_series[n, i, c]
                    self.velocity_series[n + 1, i, c] = factor * (
                        self.velocity_series[n + 1, i, c]
                        + (self.position_series[n, i - 1, c] + self.position_series[n, i + 1, c])
                        - state.stiffness[i - 1] * self.position_series[n, i, c]
                    )
