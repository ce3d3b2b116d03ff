"""Lyapunov exponents from perturbations that are orthonormalised again and again.

While m blocks are stuck at once, their m velocity perturbations are 0: as many exponents are −∞ as blocks are ever
stuck at the same time, and the vectors beyond the other ones are dropped. The growth of the others is collected batch
by batch; a batch begins and ends with the first orthonormalisation after its edge.

Reference: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30.
"""

import cython
import numpy as np
from cython.cimports.libc.math import cos, log, sqrt

if cython.compiled:
    from cython.cimports.burridge_knopoff.kernel.tangent import Tangent
else:
    from burridge_knopoff.kernel.tangent import Tangent

# Time between two orthonormalisations: a few slips, in which no vector is lost against another.
INTERVAL = 4.0
NEVER = 1e300


class Exponents:
    """Growth of the perturbations of a run.

    begin : time at which the perturbations start; until the first edge they only turn into the growing directions
    edge : boundaries of the batches, shape (batches + 1,)
    """

    def __init__(self, blocks, vectors, order, begin, edge) -> None:
        self.tangent = Tangent(blocks, vectors, order)
        self.begin = begin if vectors > 0 else NEVER
        self.edge = np.array(edge, dtype=float)
        self.running = False
        self.alive = 0
        self.most_stuck = 0
        self.due = 0.0
        self.batch = -1
        self.batches = len(edge) - 1
        self.batch_begin = 0.0
        self.growth = np.zeros((self.batches, vectors))
        self.duration = np.zeros(self.batches)

    def carry(self, matrix) -> None:
        """Carry the columns of a matrix (2 blocks, vectors) from now on as they are, never orthonormalised."""
        self.tangent.load(matrix)
        self.running = True
        self.due = NEVER
        self.most_stuck = self.tangent.blocks

    def follow(self, state, clock, completed):
        """Look after the perturbations at the end of a piece, when all changes of this instant are done."""
        stuck: cython.Py_ssize_t
        if not self.running:
            if clock >= self.begin:
                self.running = True
                self._seed(state, 0)
                self.due = clock + INTERVAL
                if clock >= self.edge[0]:
                    self.batch = 0
                    self.batch_begin = clock
            return
        stuck = self._stuck(state)
        if stuck > self.most_stuck:
            self.most_stuck = stuck
            if self.alive > 2 * state.blocks - stuck:
                self.alive = 2 * state.blocks - stuck
                self._renew(state, clock, completed)
        if clock >= self.due or (completed and self.alive > 0):
            self._renew(state, clock, completed)

    def _stuck(self, state):
        """Return the number of stuck blocks."""
        i: cython.Py_ssize_t
        count: cython.Py_ssize_t = 0
        for i in range(state.blocks):
            count += state.slip[i] == 0
        return count

    def _seed(self, state, first):
        """Give the vectors from `first` on directions of no special symmetry, as many as the stuck blocks allow."""
        i: cython.Py_ssize_t
        c: cython.Py_ssize_t
        self.most_stuck = self._stuck(state)
        self.alive = min(self.tangent.vectors, 2 * state.blocks - self.most_stuck)
        for i in range(state.blocks):
            for c in range(first, self.tangent.vectors):
                self.tangent.position[i + 1, c] = cos(1.0 + 2.3 * i + 3.7 * c + 1.9 * i * c)
                self.tangent.velocity[i + 1, c] = cos(2.0 + 1.7 * i + 2.9 * c + 2.3 * i * c) * (state.slip[i] != 0)
        self._orthonormalise(False)

    def _orthonormalise(self, counted):
        """Make the vectors orthonormal (modified Gram-Schmidt) and collect the logarithms of their lengths."""
        i: cython.Py_ssize_t
        c: cython.Py_ssize_t
        d: cython.Py_ssize_t
        product: cython.double
        n: cython.Py_ssize_t = self.tangent.blocks
        for c in range(self.tangent.vectors):
            product = 0.0
            if c < self.alive:
                for i in range(1, n + 1):
                    product += self.tangent.position[i, c] * self.tangent.position[i, c]
                    product += self.tangent.velocity[i, c] * self.tangent.velocity[i, c]
                product = sqrt(product)
                if counted:
                    self.growth[self.batch, c] += log(product)
                product = 1.0 / product
            for i in range(1, n + 1):
                self.tangent.position[i, c] *= product
                self.tangent.velocity[i, c] *= product
            for d in range(c + 1, self.alive):
                product = 0.0
                for i in range(1, n + 1):
                    product += self.tangent.position[i, c] * self.tangent.position[i, d]
                    product += self.tangent.velocity[i, c] * self.tangent.velocity[i, d]
                for i in range(1, n + 1):
                    self.tangent.position[i, d] -= product * self.tangent.position[i, c]
                    self.tangent.velocity[i, d] -= product * self.tangent.velocity[i, c]

    def _renew(self, state, clock, completed):
        """Orthonormalise, and go on to the batch in which the time now lies."""
        self._orthonormalise(self.batch >= 0 and self.batch < self.batches)
        self.due = clock + INTERVAL
        while self.batch < self.batches and (
            clock >= self.edge[self.batch + 1] or (completed and self.batch == self.batches - 1)
        ):
            if self.batch >= 0:
                self.duration[self.batch] = clock - self.batch_begin
            else:
                # What was stuck in the transient only costs no exponent of the window.
                self._seed(state, self.alive)
            self.batch += 1
            self.batch_begin = clock

    def results(self) -> dict:
        """Return `growth` (batches, vectors), −∞ for dropped vectors, `duration` (batches,) and `most_stuck`."""
        growth = np.asarray(self.growth).copy()
        growth[:, self.alive :] = -np.inf
        return {"growth": growth, "duration": np.asarray(self.duration), "most_stuck": self.most_stuck}
