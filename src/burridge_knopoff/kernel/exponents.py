"""Lyapunov exponents from perturbations that are orthonormalised again and again.

While m blocks are stuck at once, their m velocity perturbations are 0, so that at least as many exponents are −∞ as
blocks are ever stuck at the same time. There are more where a stuck block divides the chain into parts that lose
perturbations one after the other. Vectors that are lost are dropped, and the growth of the others is collected batch by
batch; a batch begins and ends with the first orthonormalisation after its edge.

Reference: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30.
"""

from collections.abc import Sequence

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.events import WORK_UNTIL_CHECK, check_signals
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
from cython.cimports.libc.math import cos, log, sqrt

# Least time between two orthonormalisations, about that between two events: in a chain of three blocks a stop shortens
# a vector to 1e-4 of what the others leave of it at worst, in long chains to 1e-11.
INTERVAL = 1.0

# A vector that has been shortened to less than this is one that stops have taken away: the rest is rounding.
LOST = 1e-13
NEVER = 1e300


class Exponents:
    """Growth of the perturbations of a run.

    start_time : the perturbations start with the piece of the motion in which this time lies; until the first edge they
        only turn into the growing directions
    edge : boundaries of the batches, shape (batches + 1,)
    """

    tangent: Tangent
    start_time: cython.double
    edge: cython.double[::1]
    running: cython.bint
    alive: cython.Py_ssize_t
    most_stuck: cython.Py_ssize_t
    due: cython.double
    batch: cython.Py_ssize_t
    batches: cython.Py_ssize_t
    batch_start: cython.double
    whole: cython.double[::1]
    product: cython.double[::1]
    growth: cython.double[:, ::1]
    duration: cython.double[::1]

    def __init__(self, blocks: int, vectors: int, start_time: float, edge: Sequence[float] | np.ndarray) -> None:
        self.tangent = Tangent(blocks, vectors)
        self.start_time = start_time if vectors > 0 else NEVER
        self.edge = np.array(edge, dtype=float)
        self.running = False
        self.alive = 0
        self.most_stuck = 0
        self.due = 0.0
        self.batch = -1
        self.batches = len(edge) - 1
        self.batch_start = 0.0
        self.whole = np.zeros(vectors)
        # Lengths multiplied up, whose logarithm is taken at the end of a batch, or before it could overflow.
        self.product = np.ones(vectors)
        self.growth = np.zeros((self.batches, vectors))
        self.duration = np.zeros(self.batches)

    def carry(self, matrix: np.ndarray) -> None:
        """Carry the columns of a matrix (2 blocks, vectors) from now on as they are, never orthonormalised."""
        self.tangent.load(matrix)
        self.running = True
        self.due = NEVER
        self.most_stuck = self.tangent.blocks

    def begin_within(self, state: State, clock: cython.double, length: cython.double) -> cython.int:
        """Start the perturbations now if their time comes within a piece of this length."""
        if self.running or clock + length <= self.start_time:
            return 0
        self.running = True
        self._seed(state, 0)
        self.due = clock + INTERVAL
        if clock >= self.edge[0]:
            self.batch = 0
            self.batch_start = clock
        return 0

    def follow(self, state: State, clock: cython.double, completed: cython.bint) -> cython.int:
        """Orthonormalise the perturbations if it is time to, after all changes of this instant."""
        stuck: cython.Py_ssize_t = self.stuck(state)
        if stuck > self.most_stuck:
            self.most_stuck = stuck
            if self.alive > 2 * state.blocks - stuck:
                self.alive = 2 * state.blocks - stuck
                self._orthonormalise(True, self.batch >= 0 and self.batch < self.batches)
        if clock >= self.due or (completed and self.alive > 0):
            self._renew(state, clock, completed)
        return 0

    def stuck(self, state: State) -> cython.Py_ssize_t:
        """Return the number of stuck blocks."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = 0
        for i in range(state.blocks):
            count += state.slip[i] == 0
        return count

    def _seed(self, state: State, first: cython.Py_ssize_t) -> cython.int:
        """Give the vectors from `first` on directions of no special symmetry, as many as the stuck blocks allow."""
        i: cython.Py_ssize_t
        c: cython.Py_ssize_t
        self.most_stuck = self.stuck(state)
        self.alive = min(self.tangent.vectors, 2 * state.blocks - self.most_stuck)
        for i in range(state.blocks):
            for c in range(first, self.tangent.vectors):
                self.tangent.position[c, i] = cos(1.0 + 2.3 * i + 3.7 * c + 1.9 * i * c)
                self.tangent.velocity[c, i] = cos(2.0 + 1.7 * i + 2.9 * c + 2.3 * i * c) * (state.slip[i] != 0)
        self._orthonormalise(False, False)
        return 0

    def _square(self, c: cython.Py_ssize_t) -> cython.double:
        """Return the square of the length of vector c."""
        i: cython.Py_ssize_t
        moved: cython.double = 0.0
        sped: cython.double = 0.0
        for i in range(self.tangent.blocks):
            moved += self.tangent.position[c, i] * self.tangent.position[c, i]
            sped += self.tangent.velocity[c, i] * self.tangent.velocity[c, i]
        return moved + sped

    def _orthonormalise(self, kept: cython.bint, counted: cython.bint) -> cython.int:
        """Make the vectors orthonormal (modified Gram-Schmidt).

        kept : vectors that were orthonormal before are dropped from the first one on that is lost; else they are seeds
        counted : the lengths are collected
        """
        i: cython.Py_ssize_t
        c: cython.Py_ssize_t
        d: cython.Py_ssize_t
        factor: cython.double
        length: cython.double
        moved: cython.double
        sped: cython.double
        n: cython.Py_ssize_t = self.tangent.blocks
        work: cython.longlong = 0
        for c in range(self.alive):
            self.whole[c] = self._square(c)
        for c in range(self.tangent.vectors):
            work += n * max(self.alive - c, 0)
            if work >= WORK_UNTIL_CHECK:
                check_signals()
                work = 0
            factor = 0.0
            if c < self.alive:
                length = self.whole[0] if c == 0 else self._square(c)
                if kept and length <= LOST * LOST * self.whole[c]:
                    self.alive = c
                else:
                    length = sqrt(length)
                    factor = 1.0 / length
                    if counted:
                        self.product[c] *= length
                        if not 1e-100 < self.product[c] < 1e100:
                            self._collect(c)
            for i in range(n):
                self.tangent.position[c, i] *= factor
                self.tangent.velocity[c, i] *= factor
            for d in range(c + 1, self.alive):
                moved = sped = 0.0
                for i in range(n):
                    moved += self.tangent.position[c, i] * self.tangent.position[d, i]
                    sped += self.tangent.velocity[c, i] * self.tangent.velocity[d, i]
                for i in range(n):
                    self.tangent.position[d, i] -= (moved + sped) * self.tangent.position[c, i]
                    self.tangent.velocity[d, i] -= (moved + sped) * self.tangent.velocity[c, i]
        return 0

    def _collect(self, c: cython.Py_ssize_t) -> None:
        """Add the growth of vector c since the last call to its batch."""
        self.growth[self.batch, c] += log(self.product[c])
        self.product[c] = 1.0

    def _renew(self, state: State, clock: cython.double, completed: cython.bint) -> cython.int:
        """Orthonormalise, and go on to the batch in which the time now lies."""
        c: cython.Py_ssize_t
        self._orthonormalise(True, self.batch >= 0 and self.batch < self.batches)
        self.due = clock + INTERVAL
        while self.batch < self.batches and (
            clock >= self.edge[self.batch + 1] or (completed and self.batch == self.batches - 1)
        ):
            if self.batch >= 0:
                self.duration[self.batch] = clock - self.batch_start
                for c in range(self.alive):
                    self._collect(c)
            else:
                # Blocks that were stuck only in the transient cost no exponent of the window.
                self._seed(state, self.alive)
            self.batch += 1
            self.batch_start = clock
        return 0

    def results(self) -> dict:
        """Return `growth` (batches, vectors), −∞ for dropped vectors, `duration` (batches,) and how many are `lost`.

        lost : that many of the 2 blocks exponents are −∞, at least; exact if as many vectors were asked for
        """
        growth = np.asarray(self.growth).copy()
        growth[:, self.alive :] = -np.inf
        lost = 2 * self.tangent.blocks - self.alive if self.alive < self.tangent.vectors else 0
        return {"growth": growth, "duration": np.asarray(self.duration), "lost": max(self.most_stuck, lost)}
