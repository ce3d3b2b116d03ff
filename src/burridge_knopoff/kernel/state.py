"""The state of a chain as a solver moves it on, and the stick-slip rules that change it.

It is set from a `ChainState` and read out as one. Besides positions, velocities and which blocks stick it holds what
the next event depends on, and it is changed in place. (An `InitialState` gives U(0) and U'(0), as the paper does.)

Coordinates are co-moving: position is x_i = U_i − vτ − e_i with K e = −threshold Φ(v), velocity is U_i' itself, so
that a stuck block has velocity exactly 0. Because K·1 = D the spring force on block i is

    s_i = D_i vτ − (K U)_i = threshold_i Φ(v) − (K x)_i

and nothing in the system depends on τ. A block slips against friction threshold_i Φ, and starts where the spring force
on it passes threshold_i.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import Friction
from cython.cimports.burridge_knopoff.kernel.springs import Springs
from cython.cimports.burridge_knopoff.kernel.vector import Vectors

# Times closer than this are one instant, whatever the springs: the clock does not resolve them. Blocks whose motion is
# the same to the bit change together, however far from their threshold rounding leaves them: see `search.coincide`.
COINCIDENCE = 1e-14

# A block that has slipped for less than this keeps the acceleration that was carried along since its start, which
# began at exactly 0: 1 − s recomputed from positions would be rounding (1e-16), and its sign could stop the block.
YOUNG = 1e-6
LONG = 1e300

# Rounding of a spring force at its threshold, as a share of the terms that make it up.
AT_THRESHOLD = 1e-13


class State:
    """Positions x_i, velocities U_i' and slip directions (0 stuck, 1 forward, −1 backward) of N blocks.

    Positions and velocities also lie in the lanes of vectors, as in `Springs`.

    `touching` marks a block whose spring force is at its threshold exactly, because it has started (or started and
    stopped again) at this very instant. `age` is the time since the start of the present slip.
    """

    blocks: cython.Py_ssize_t
    springs: Springs
    friction: Friction
    symmetric: cython.int
    drops: cython.bint
    v: cython.double
    positions: Vectors
    velocities: Vectors
    position: cython.double[::1]
    velocity: cython.double[::1]
    acceleration: cython.double[::1]
    age: cython.double[::1]
    slip: cython.int[::1]
    touching: cython.int[::1]

    def __init__(self, springs: Springs, friction: Friction, v: float, symmetric: bool) -> None:
        n = springs.blocks
        self.blocks = n
        self.springs = springs
        self.friction = friction
        self.v = v
        self.symmetric = symmetric
        self.drops = friction.at_rest < 1.0
        self.positions = Vectors(springs.columns)
        self.velocities = Vectors(springs.columns)
        self.position = self.positions.table(1)[0]
        self.velocity = self.velocities.table(1)[0]
        self.acceleration = np.zeros(n)
        self.age = np.full(n, LONG)
        self.slip = np.zeros(n, dtype=np.intc)
        self.touching = np.zeros(n, dtype=np.intc)

    def begin(self, position: np.ndarray, velocity: np.ndarray, stuck: np.ndarray) -> None:
        """Set the state at τ = 0: positions x_i, velocities U_i', and which blocks are stuck with velocity 0."""
        self.place(
            np.array(position, dtype=float),
            np.array(velocity, dtype=float),
            np.array(stuck, dtype=bool).astype(np.intc),
        )

    def place(self, position: cython.double[::1], velocity: cython.double[::1], stuck: cython.int[::1]) -> None:
        """Do the work of `begin` in compiled code."""
        i: cython.Py_ssize_t
        for i in range(self.blocks):
            self.position[i] = position[i]
            self.velocity[i] = 0.0 if stuck[i] else velocity[i]
            self.slip[i] = 0 if stuck[i] else (-1 if velocity[i] < 0.0 else 1)
            self.acceleration[i] = 0.0
            self.age[i] = LONG
            self.touching[i] = 0

    def values(self) -> tuple:
        """Return copies of positions x_i, velocities U_i' and slip directions, each of shape (blocks,)."""
        return np.array(self.position[: self.blocks]), np.array(self.velocity[: self.blocks]), np.array(self.slip)

    def spring_force(self, i: cython.Py_ssize_t) -> cython.double:
        """Return s_i."""
        return self.springs.sliding_force[i] + self.springs.pull(cython.address(self.position[0]), i)

    def force_rate(self, i: cython.Py_ssize_t) -> cython.double:
        """Return ds_i/dτ."""
        pull: cython.double = self.springs.before[i] * (self.velocity[self.springs.previous[i]] - self.v)
        # The neighbours are added first, as in `Springs.pull`.
        pull += self.springs.after[i] * (self.velocity[self.springs.next[i]] - self.v)
        return pull - self.springs.diagonal[i] * (self.velocity[i] - self.v)

    def start_acceleration(self, i: cython.Py_ssize_t) -> cython.double:
        """Return |U_i''| of a block that starts at its threshold: 0, exactly, unless friction drops at the start."""
        return self.springs.threshold[i] * (1.0 - self.friction.at_rest)

    def slip_acceleration(self, i: cython.Py_ssize_t) -> cython.double:
        """Return U_i'' of a slipping block."""
        if self.touching[i]:
            return self.slip[i] * self.start_acceleration(i)
        if self.age[i] < YOUNG:
            return self.acceleration[i]
        return self.spring_force(i) - self.slip[i] * (
            self.springs.threshold[i] * self.friction.at(self.slip[i] * self.velocity[i])
        )

    def transition(self, i: cython.Py_ssize_t) -> cython.int:
        """Let block i stop if it slips and start if it is stuck; return the kind of event: 0 stop, 1 start."""
        self.velocity[i] = 0.0
        self.acceleration[i] = 0.0
        if self.slip[i] != 0:
            self.slip[i] = 0
            self.age[i] = LONG
            return 0
        force: cython.double = self.spring_force(i)
        self.slip[i] = 1 if force > 0.0 else -1
        # A block that stopped beyond its threshold starts again with the acceleration that the excess gives it.
        if self.at_threshold(i, force):
            self.touching[i] = 1
            self.age[i] = 0.0
        return 1

    def at_threshold(self, i: cython.Py_ssize_t, force: cython.double) -> cython.bint:
        """Tell whether a spring force that starts a block is its threshold, within rounding."""
        size: cython.double = max(self.springs.threshold[i], self.springs.diagonal[i] * abs(self.position[i]))
        return abs(force) - self.springs.threshold[i] <= AT_THRESHOLD * size

    def pending(self, i: cython.Py_ssize_t) -> cython.int:
        """Tell whether block i changes at this very instant: it is past its threshold, or within COINCIDENCE of it."""
        gap: cython.double
        side: cython.int
        direction: cython.int = self.slip[i]
        if direction != 0:
            if self.touching[i]:
                return not self.drops and direction * self.force_rate(i) < 0.0
            gap = direction * self.velocity[i]
            if gap < 0.0:
                return True
            return gap <= COINCIDENCE and gap < -COINCIDENCE * direction * self.slip_acceleration(i)
        if self.touching[i]:
            return False
        for side in range(1, -2 * self.symmetric, -2):
            gap = self.springs.threshold[i] - side * self.spring_force(i)
            if gap < 0.0:
                return True
            if gap <= COINCIDENCE * self.springs.diagonal[i] and gap < COINCIDENCE * side * self.force_rate(i):
                return True
        return False
