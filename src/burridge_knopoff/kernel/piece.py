"""One piece of the motion: positions, velocities and spring forces as polynomials of the time since its start.

Whatever a solver does, it hands its motion on in this form; events and observables read nothing else.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.piece import ORDER
from cython.cimports.burridge_knopoff.kernel.polynomial import Polynomial
from cython.cimports.burridge_knopoff.kernel.springs import Springs
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors, lane_of, splat, value_at, vec

UNKNOWN = 1e300
UNCERTAIN = -2.0


class Piece:
    """Coefficient tables of x_i, U_i' and s_i: row k holds those of t^k, block i stands in column i; `degree` ≤ order.

    The same memory is read block by block, as tables, and in lanes, as `columns` vectors a row.

    `direction` (0 where a block sticks) and `stuck` (1 there, and in lanes without a block) hold for the whole piece.
    `highest` holds, for each block, a bound on what `load_speed` or `load_gap` loads, over the time the piece is used;
    `crossing` when W changes its sign in that time, −1.0 if it does not, UNCERTAIN if it has to be looked for. W is the
    sum of x_i over the blocks from `section_begin` to `section_end` − 1: over all, or one block.

    section : number of that block, from 1 on, 0 for all
    """

    blocks: cython.Py_ssize_t
    order: cython.Py_ssize_t
    degree: cython.Py_ssize_t
    columns: cython.Py_ssize_t
    positions: Vectors
    velocities: Vectors
    forces: Vectors
    direction: Vectors
    stuck: Vectors
    direction_table: cython.double[::1]
    stuck_table: cython.double[::1]
    position: cython.double[:, ::1]
    velocity: cython.double[:, ::1]
    force: cython.double[:, ::1]
    highest: cython.double[::1]
    crossing: cython.double
    section_begin: cython.Py_ssize_t
    section_end: cython.Py_ssize_t

    def __init__(self, blocks: int, order: int, section: int) -> None:
        self.blocks = blocks
        self.section_begin = section - 1 if section else 0
        self.section_end = section if section else blocks
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
        self.highest = np.full(blocks, UNKNOWN)
        self.crossing = UNCERTAIN

    def fill_force(self, springs: Springs, n: cython.Py_ssize_t) -> None:
        """Fill row n of the spring forces from row n of the positions."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.force[n, i] = springs.pull(cython.address(self.position[n, 0]), i)
        if n == 0:
            for i in range(self.blocks):
                self.force[0, i] += springs.sliding_force[i]

    def move(self, state: State, t: cython.double) -> None:
        """Set positions and velocities of the state to those at time t of a series."""
        c: cython.Py_ssize_t
        for c in range(self.columns):
            state.positions.at[c] = value_at(self.positions.at + c, self.columns, ORDER, t)
            state.velocities.at[c] = value_at(self.velocities.at + c, self.columns, ORDER, t)

    def section_row(self, k: cython.Py_ssize_t) -> cython.double:
        """Return the coefficient of t^k of W."""
        i: cython.Py_ssize_t
        total: cython.double = 0.0
        for i in range(self.section_begin, self.section_end):
            total += self.position[k, i]
        return total

    def section_rate(self, v: cython.double, t: cython.double) -> cython.double:
        """Return the rate Σ (U_i' − v) of W at time t."""
        i: cython.Py_ssize_t
        speed: vec = splat(0.0)
        total: cython.double = 0.0
        for i in range(self.section_begin, self.section_end):
            if i % LANES == 0 or i == self.section_begin:
                speed = value_at(self.velocities.at + i // LANES, self.columns, self.degree, t)
            total += lane_of(speed, i % LANES) - v
        return total

    def load_speed(self, state: State, i: cython.Py_ssize_t, polynomial: Polynomial) -> None:
        """Load the speed |U_i'| of a slipping block: the block stops where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        if state.slip[i] < 0:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = -self.velocity[k, i]
        else:
            for k in range(self.degree + 1):
                polynomial.coefficient[k] = self.velocity[k, i]

    def load_gap(self, state: State, i: cython.Py_ssize_t, side: cython.int, polynomial: Polynomial) -> None:
        """Load threshold_i − side·s_i of a stuck block: the block starts where it becomes negative."""
        k: cython.Py_ssize_t
        polynomial.degree = self.degree
        for k in range(self.degree + 1):
            polynomial.coefficient[k] = -side * self.force[k, i]
        polynomial.coefficient[0] += state.springs.threshold[i]
        # At its threshold by construction: what rounding leaves there must not start the block a second time.
        if state.touching[i] and abs(polynomial.coefficient[0]) < 0.5 * state.springs.threshold[i]:
            polynomial.coefficient[0] = 0.0
