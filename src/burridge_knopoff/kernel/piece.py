"""One piece of the motion: positions, velocities and spring forces as polynomials of the time since its start.

Whatever a solver does, it hands its motion on in this form; events and observables read nothing else.
"""

import cython
import numpy as np

UNKNOWN = 1e300


class Piece:
    """Coefficient tables of x_i, U_i' and s_i, of shape (order + 1, blocks + 2); `degree` ≤ order.

    Row k holds the coefficients of t^k, column i + 1 those of block i. The first and the last column stay 0: they are
    the neighbours that the end blocks do not have.

    `highest` holds, for each block, a bound on what `load_speed` or `load_gap` loads, over the time the piece is used.
    """

    def __init__(self, blocks: int, order: int) -> None:
        self.blocks = blocks
        self.order = order
        self.degree = order
        self.position = np.zeros((order + 1, blocks + 2))
        self.velocity = np.zeros((order + 1, blocks + 2))
        self.force = np.zeros((order + 1, blocks + 2))
        self.highest = np.full(blocks, UNKNOWN)

    def fill_force(self, state, n):
        """Fill row n of the spring forces from row n of the positions."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.force[n, i + 1] = (self.position[n, i] + self.position[n, i + 2]) - state.stiffness[i] * self.position[
                n, i + 1
            ]
        if n == 0:
            for i in range(self.blocks):
                self.force[0, i + 1] += state.sliding_friction

    def move(self, state, t):
        """Set positions and velocities of the state to those at time t."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        for i in range(self.blocks):
            state.position[i] = self.position[self.degree, i + 1]
            state.velocity[i] = self.velocity[self.degree, i + 1]
        for k in range(self.degree - 1, -1, -1):
            for i in range(self.blocks):
                state.position[i] = state.position[i] * t + self.position[k, i + 1]
                state.velocity[i] = state.velocity[i] * t + self.velocity[k, i + 1]

    def load_speed(self, state, i, polynomial):
        """Load the speed |U_i'| of a slipping block: the block stops where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        if state.slip[i] < 0:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = -self.velocity[k, i + 1]
        else:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = self.velocity[k, i + 1]

    def load_gap(self, state, i, side, polynomial):
        """Load 1 − side·s_i of a stuck block: the block starts where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        for k in range(self.degree + 1):
            polynomial.coefficient[k] = -side * self.force[k, i + 1]
        polynomial.coefficient[0] += 1.0
        # At its threshold by construction: what rounding leaves of 1 - s must not start the block a second time.
        if state.touching[i] and abs(polynomial.coefficient[0]) < 0.5:
            polynomial.coefficient[0] = 0.0
