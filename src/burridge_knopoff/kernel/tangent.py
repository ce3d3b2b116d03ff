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

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.state import State
from cython.cimports.burridge_knopoff.kernel.vector import LANES, Vectors


class Tangent:
    """`vectors` perturbations of a chain, blocks in lanes; as tables δx and δU' have one row each.

    Of a short chain as many perturbations lie side by side in a vector as there is room for; `packs` is the number of
    vectors of δx. `tangent_series` and `tangent_modes` move them between events.
    `lost` and `deceleration` keep what a stop takes away, for a block that turns round at the same instant.
    """

    blocks: cython.Py_ssize_t
    vectors: cython.Py_ssize_t
    columns: cython.Py_ssize_t
    side: cython.Py_ssize_t
    packs: cython.Py_ssize_t
    positions: Vectors
    velocities: Vectors
    position: cython.double[:, ::1]
    velocity: cython.double[:, ::1]
    lost: cython.double[:, ::1]
    deceleration: cython.double[::1]

    def __init__(self, blocks: int, vectors: int) -> None:
        self.blocks = blocks
        self.vectors = vectors
        self.columns = (blocks + LANES - 1) // LANES
        self.side = max(LANES // blocks, 1)
        self.packs = (vectors + self.side - 1) // self.side
        places = max(self.packs, 1)
        self.positions = Vectors(places * self.columns)
        self.velocities = Vectors(places * self.columns)
        self.position = self.positions.table(places * self.side)
        self.velocity = self.velocities.table(places * self.side)
        self.lost = np.zeros((vectors, blocks))
        self.deceleration = np.zeros(blocks)

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
