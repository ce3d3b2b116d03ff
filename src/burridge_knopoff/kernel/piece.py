"""One piece of the motion: positions, velocities and spring forces as polynomials of the time since its start.

Whatever a solver does, it hands its motion on in this form; events and observables read nothing else.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, lane_of, value_at

UNKNOWN = 1e300


class Piece:
    """Coefficient tables of x_i, U_i' and s_i: row k holds those of t^k, block i stands in column i; `degree` ≤ order.

    The same memory is read block by block, as tables, and in lanes, as `columns` vectors a row.

    `direction` (0 where a block sticks) and `stuck` (1 there, and in lanes without a block) hold for the whole piece.
    `highest` holds, for each block, a bound on what `load_speed` or `load_gap` loads, over the time the piece is used.
    """

    def __init__(self, blocks: int, order: int) -> None:
        self.blocks = blocks
        self.order = order
        self.degree = order
        self.columns = (blocks + LANES - 1) // LANES
        self.positions = Vectors((order + 1) * self.columns)
        self.velocities = Vectors((order + 1) * self.columns)
        self.forces = Vectors((order + 1) * self.columns)
        self.position = self.positions.table(order + 1)
        self.velocity = self.velocities.table(order + 1)
        self.force = self.forces.table(order + 1)
        self.direction = Vectors(self.columns)
        self.direction_table = self.direction.table(1)[0]
        self.stuck = Vectors(self.columns)
        self.stuck.set(np.ones(self.columns * LANES))
        self.stuck_table = self.stuck.table(1)[0]
        self.moved = Vectors(2)
        self.highest = np.full(blocks, UNKNOWN)

    def fill_force(self, springs, n):
        """Fill row n of the spring forces from row n of the positions."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.force[n, i] = springs.pull(cython.address(self.position[n, 0]), i)
        if n == 0:
            for i in range(self.blocks):
                self.force[0, i] += springs.sliding_force[i]

    def move(self, state, t):
        """Set positions and velocities of the state to those at time t."""
        c: cython.Py_ssize_t
        i: cython.Py_ssize_t
        for c in range(self.columns):
            self.moved.at[0] = value_at(self.positions.at + c, self.columns, self.degree, t)
            self.moved.at[1] = value_at(self.velocities.at + c, self.columns, self.degree, t)
            for i in range(c * LANES, min(self.blocks, (c + 1) * LANES)):
                state.position[i] = lane_of(self.moved.at[0], i - c * LANES)
                state.velocity[i] = lane_of(self.moved.at[1], i - c * LANES)

    def load_speed(self, state, i, polynomial):
        """Load the speed |U_i'| of a slipping block: the block stops where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        if state.slip[i] < 0:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = -self.velocity[k, i]
        else:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = self.velocity[k, i]

    def load_gap(self, state, i, side, polynomial):
        """Load threshold_i − side·s_i of a stuck block: the block starts where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        for k in range(self.degree + 1):
            polynomial.coefficient[k] = -side * self.force[k, i]
        polynomial.coefficient[0] += state.springs.threshold[i]
        # At its threshold by construction: what rounding leaves there must not start the block a second time.
        if state.touching[i] and abs(polynomial.coefficient[0]) < 0.5 * state.springs.threshold[i]:
            polynomial.coefficient[0] = 0.0
