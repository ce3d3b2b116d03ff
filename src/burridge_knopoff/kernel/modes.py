"""Normal modes of the slipping blocks: the paper's mapping between events, in closed form.

The friction is a straight line, threshold Φ = f − a U' with one threshold for all blocks, and the chain has two ends
and one strength of the springs between blocks, c. Stuck blocks cut it into runs of slipping blocks that do not feel
each other. In a run

    x'' = −K x + a x' + b − g v τ,        b_i = c Σ x_j(0) over stuck neighbours j (+ 2f where i slips backward),
                                          g_i = c times the number of stuck neighbours

and with K = Q diag(λ) Qᵀ each mode q = Qᵀx is a particular solution p + r τ plus

    z(τ) = exp(aτ/2) [z0 cos ωτ + (z0' − a z0/2)/ω sin ωτ],     ω² = λ − a²/4,

    r = −v Qᵀg / λ,     p = (a r + Qᵀb) / λ.

No λ is less than the weakest spring to the driver, because K is that of the springs between blocks plus diag(D): all
modes oscillate if a < 2 √min D, a < 2 in the paper's chain. The matrix of a run depends only
on its length and on the ends of the chain that it contains: there are at most 4N of them for any set of slipping
blocks, each solved once, when it is first met.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.state import YOUNG, State
from cython.cimports.libc.math import cos, exp, sin, sqrt

# Longest run whose modes are refined: long double has no fast matrix product, and beyond this the solution of the
# modes would take longer than the simulation.
REFINED = 32


def _refined(matrix, eigenvalue, vector):
    """Return eigenvalues and eigenvectors (columns) correct to the last bit or so: one Newton step in long double.

    An error in the modes is the same at every event and adds up, where rounding averages out.
    Reference: T. Ogita and K. Aishima, Jpn. J. Ind. Appl. Math. 35 (2018) 1007-1035.
    """
    long_matrix = matrix.astype(np.longdouble)
    long_vector = vector.astype(np.longdouble)
    size = len(eigenvalue)
    defect = np.eye(size) - long_vector.T @ long_vector
    projected = long_vector.T @ long_matrix @ long_vector
    values = np.diag(projected) / (1 - np.diag(defect))
    gap = values[None, :] - values[:, None] + np.eye(size)
    correction = (projected + values[None, :] * defect) / gap
    correction[np.arange(size), np.arange(size)] = np.diag(defect) / 2
    return values.astype(float), (long_vector + long_vector @ correction).astype(float)


class Modes:
    """Closed-form motion of a chain of `blocks` blocks from the last call of `start`."""

    blocks: cython.Py_ssize_t
    eigenvalue: cython.double[::1]
    vector: cython.double[:, ::1]
    vector_row: cython.Py_ssize_t[:, ::1]
    rows: cython.Py_ssize_t
    first: cython.Py_ssize_t[::1]
    last: cython.Py_ssize_t[::1]
    row: cython.Py_ssize_t[::1]
    runs: cython.Py_ssize_t
    rate: cython.double
    origin: cython.double[::1]
    origin_velocity: cython.double[::1]
    drift: cython.double[::1]
    amplitude: cython.double[::1]
    amplitude_rate: cython.double[::1]

    def __init__(self, blocks: int) -> None:
        self.blocks = blocks
        # vector_row[4 (length - 1) + 2 (left end) + (right end)]: first row of that run's block in `vector`, or -1.
        self.vector_row = np.full((blocks, 4), -1, dtype=np.intp)
        self.eigenvalue = np.zeros(blocks)
        self.vector = np.zeros((blocks, blocks))
        self.rows = 0
        self.first = np.zeros(blocks, dtype=np.intp)
        self.last = np.zeros(blocks, dtype=np.intp)
        self.row = np.zeros(blocks, dtype=np.intp)
        self.runs = 0
        self.origin = np.zeros(blocks)
        self.origin_velocity = np.zeros(blocks)
        self.drift = np.zeros(blocks)
        self.amplitude = np.zeros(blocks)
        self.amplitude_rate = np.zeros(blocks)

    def start(self, state: State) -> None:
        """Take the state as the origin of the motion: find the runs and their mode amplitudes."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        m: cython.Py_ssize_t
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t
        last: cython.Py_ssize_t
        q: cython.double
        rate: cython.double
        push: cython.double
        stuck: cython.double
        left: cython.double
        right: cython.double
        q_left: cython.double
        q_right: cython.double
        factor: cython.double
        other: cython.double
        mirror: cython.Py_ssize_t
        coupling: cython.double = state.springs.after[0]
        turned: cython.double = 2.0 * (state.springs.threshold[0] * state.friction.at_rest)
        self.rate = state.springs.threshold[0] * state.friction.rate
        for i in range(self.blocks):
            self.origin[i] = state.position[i]
            self.origin_velocity[i] = state.velocity[i]
        self.runs = 0
        i = 0
        while i < self.blocks:
            if state.slip[i] == 0:
                i += 1
                continue
            first = i
            while i < self.blocks and state.slip[i] != 0:
                i += 1
            last = i - 1
            row = self._row(first, last, state)
            self.first[self.runs] = first
            self.last[self.runs] = last
            self.row[self.runs] = row
            self.runs += 1
            for k in range(first, last + 1):
                q = 0.0
                rate = 0.0
                push = 0.0
                left = 0.0
                right = 0.0
                # From both ends inward, each block added to its mirror image first: a mirrored state gives the same
                # sums to the bit, and a symmetric one exactly 0 for every antisymmetric mode.
                m = first
                while m <= last - (m - first):
                    mirror = last - (m - first)
                    factor = self.vector[row + k - first, m - first]
                    other = self.vector[row + k - first, mirror - first] if mirror != m else 0.0
                    q += factor * state.position[m] + other * state.position[mirror]
                    rate += factor * (state.velocity[m] - state.v) + other * (state.velocity[mirror] - state.v)
                    push += factor * (turned * (state.slip[m] < 0)) + other * (turned * (state.slip[mirror] < 0))
                    m += 1
                if first > 0:
                    left = coupling * self.vector[row + k - first, 0]
                if last < self.blocks - 1:
                    right = coupling * self.vector[row + k - first, last - first]
                stuck = left + right
                q_left = state.position[first - 1] if first > 0 else 0.0
                q_right = state.position[last + 1] if last < self.blocks - 1 else 0.0
                push += left * q_left + right * q_right
                self.drift[k] = -state.v * stuck / self.eigenvalue[row + k - first]
                self.amplitude[k] = q - (self.rate * self.drift[k] + push) / self.eigenvalue[row + k - first]
                self.amplitude_rate[k] = rate - self.drift[k]

    def advance(self, state: State, t: cython.double) -> None:
        """Set the state's positions and velocities to those at time t after the origin.

        A block that has only just started keeps its velocity: it is about s' t²/2, less than what rounding leaves of
        the sum over modes, whose sign would stop the block.
        """
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        n: cython.Py_ssize_t
        row: cython.Py_ssize_t
        first: cython.Py_ssize_t
        last: cython.Py_ssize_t
        eigenvalue: cython.double
        omega: cython.double
        cosine: cython.double
        sine: cython.double
        q: cython.double
        rate: cython.double
        half: cython.double = 0.5 * self.rate
        growth: cython.double = exp(half * t)
        for i in range(self.blocks):
            if state.slip[i] == 0:
                state.position[i] = self.origin[i] - state.v * t
            else:
                state.position[i] = self.origin[i]
                if state.age[i] >= YOUNG:
                    state.velocity[i] = self.origin_velocity[i]
        for n in range(self.runs):
            first = self.first[n]
            last = self.last[n]
            for k in range(first, last + 1):
                row = self.row[n] + k - first
                eigenvalue = self.eigenvalue[row]
                omega = sqrt(eigenvalue - half * half)
                cosine = growth * cos(omega * t)
                sine = growth * sin(omega * t) / omega
                # Changes since the origin, so that rounding in the modes touches the change only.
                q = self.amplitude[k] * (cosine - 1.0) + (self.amplitude_rate[k] - half * self.amplitude[k]) * sine
                q += self.drift[k] * t
                rate = self.amplitude_rate[k] * (cosine - 1.0)
                rate += (half * self.amplitude_rate[k] - eigenvalue * self.amplitude[k]) * sine
                for i in range(first, last + 1):
                    state.position[i] += self.vector[row, i - first] * q
                    if state.age[i] >= YOUNG:
                        state.velocity[i] += self.vector[row, i - first] * rate

    def _row(self, first: cython.Py_ssize_t, last: cython.Py_ssize_t, state: State) -> cython.Py_ssize_t:
        """Return where the modes of the run first … last begin in the tables, solving them if they are new."""
        row: cython.Py_ssize_t = self.vector_row[last - first, 2 * (first == 0) + (last == self.blocks - 1)]
        if row < 0:
            with cython.gil:
                row = self._solve(first, last, state)
        return row

    def _solve(self, first: cython.Py_ssize_t, last: cython.Py_ssize_t, state: State) -> cython.Py_ssize_t:
        """Diagonalise the run's matrix, append eigenvalues and eigenvectors (as rows), and return their first row."""
        length = last - first + 1
        ends = (first == 0, last == self.blocks - 1)
        diagonal = np.asarray(state.springs.diagonal)[first : last + 1]
        coupling = state.springs.after[0]
        # A run that only the right end closes is the mirror image of one that only the left end closes.
        mirrored = ends[1] and not ends[0]
        if mirrored:
            diagonal = diagonal[::-1]
        matrix = np.diag(diagonal) - coupling * (np.eye(length, k=1) + np.eye(length, k=-1))
        eigenvalue, vector = np.linalg.eigh(matrix)
        if length <= REFINED:
            eigenvalue, vector = _refined(matrix, eigenvalue, vector)
        if mirrored:
            vector = vector[::-1]
        elif ends[0] == ends[1]:
            # Modes of a symmetric run are even or odd; made so to the bit.
            parity = np.sign((vector * vector[::-1]).sum(axis=0))
            vector = 0.5 * (vector + parity * vector[::-1])
        row = self.rows
        if row + length > self.vector.shape[0]:
            grown = np.zeros((2 * (row + length), self.blocks))
            grown[:row] = np.asarray(self.vector)[:row]
            self.vector = grown
            more = np.zeros(2 * (row + length))
            more[:row] = np.asarray(self.eigenvalue)[:row]
            self.eigenvalue = more
        np.asarray(self.vector)[row : row + length, :length] = vector.T
        np.asarray(self.eigenvalue)[row : row + length] = eigenvalue
        self.vector_row[last - first, 2 * (first == 0) + (last == self.blocks - 1)] = row
        self.rows = row + length
        return row
