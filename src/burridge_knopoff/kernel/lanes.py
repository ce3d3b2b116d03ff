"""The states of several trajectories of one chain, one a lane, and the stick-slip rules that change them.

The rules are those of `state`, for all lanes at once: what is true of some lanes is a mask. Block i feels the
spring force s_i = f_i + (l_i x_(i−1) + r_i x_(i+1)) − d_i x_i and sticks until that passes its threshold θ_i; when it
slips, its friction is θ_i Φ(|U_i'|). The pulls of the neighbours are added first, so that the mirror image of a state
moves as its mirror image, bit for bit.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import ROUNDING
from cython.cimports.burridge_knopoff.kernel.friction_series import FrictionSeries
from cython.cimports.burridge_knopoff.kernel.state import AT_THRESHOLD, COINCIDENCE, LONG, YOUNG
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    at_most,
    bits,
    equal,
    from_bits,
    lane_of,
    largest,
    less,
    magnitude,
    mask,
    put,
    select,
    splat,
    vec,
)


class Lanes:
    """Positions x_i, velocities U_i' and slip directions (0 stuck, 1 forward, −1 backward) of all lanes.

    diagonal, left, right : d, l, r, shape (blocks,); l_0 and r_(N−1) are 0, or the spring that closes a ring
    threshold, sliding_force : θ and f, shape (blocks,); f_i = θ_i Φ(v) is the spring force in uniform sliding
    symmetric : whether a block that is pulled below −θ_i slips backward
    friction : the law as FrictionSeries of `blocks` columns
    rate_limit : more events in one time unit than this count as an accumulation
    """

    blocks: cython.Py_ssize_t
    symmetric: cython.bint
    v: cython.double
    static_friction: cython.double
    friction: FrictionSeries
    diagonal: cython.double[::1]
    left: cython.double[::1]
    right: cython.double[::1]
    threshold: cython.double[::1]
    sliding_force: cython.double[::1]
    slope: cython.double[::1]
    ring: cython.bint
    lower: cython.Py_ssize_t[::1]
    upper: cython.Py_ssize_t[::1]
    position: Vectors
    velocity: Vectors
    acceleration: Vectors
    age: Vectors
    slip: Vectors
    touching: Vectors
    clock: Vectors
    clock_rest: Vectors
    count: Vectors
    unit_start: Vectors
    unit_count: Vectors
    rate_limit: cython.double
    accumulating: mask
    member: cython.Py_ssize_t[::1]
    due: cython.int[::1]
    kept: cython.Py_ssize_t
    event_time: cython.double[:, ::1]
    event_block: cython.int[:, ::1]
    event_kind: cython.int[:, ::1]

    def __init__(
        self,
        diagonal: np.ndarray,
        left: np.ndarray,
        right: np.ndarray,
        threshold: np.ndarray,
        sliding_force: np.ndarray,
        v: float,
        symmetric: bool,
        friction: FrictionSeries,
        rate_limit: int,
    ) -> None:
        n = len(diagonal)
        self.blocks = n
        self.v = v
        self.symmetric = symmetric
        self.friction = friction
        self.diagonal = np.array(diagonal, dtype=float)
        self.left = np.array(left, dtype=float)
        self.right = np.array(right, dtype=float)
        self.threshold = np.array(threshold, dtype=float)
        self.sliding_force = np.array(sliding_force, dtype=float)
        self.slope = friction.slope * np.asarray(self.threshold)
        self.ring = left[0] != 0.0
        self.lower = np.roll(np.arange(n, dtype=np.intp), 1)
        self.upper = np.roll(np.arange(n, dtype=np.intp), -1)
        self.position = Vectors(n)
        self.velocity = Vectors(n)
        self.acceleration = Vectors(n)
        self.age = Vectors(n)
        self.slip = Vectors(n)
        self.touching = Vectors(n)
        self.clock = Vectors(1)
        self.clock_rest = Vectors(1)
        self.count = Vectors(1)
        self.unit_start = Vectors(1)
        self.unit_count = Vectors(1)
        self.rate_limit = rate_limit
        self.accumulating = from_bits(0)
        self.member = np.full(LANES, -1, dtype=np.intp)
        self.due = np.zeros(n, dtype=np.intc)
        self.kept = 0
        self.event_time = np.zeros((1, 1))
        self.event_block = np.zeros((1, 1), dtype=np.intc)
        self.event_kind = np.zeros((1, 1), dtype=np.intc)
        self.static_friction = lane_of(self.friction_of(0, splat(0.0)), 0)
        if abs(self.static_friction - 1.0) < ROUNDING:
            self.static_friction = 1.0

    def place(
        self,
        lane: cython.int,
        member: cython.Py_ssize_t,
        position: cython.double[::1],
        velocity: cython.double[::1],
        stuck: cython.int[::1],
    ) -> None:
        """Start a trajectory in a lane at τ = 0, from positions x_i, velocities U_i' and which blocks are stuck."""
        i: cython.Py_ssize_t
        self.member[lane] = member
        for i in range(self.blocks):
            put(self.position.at + i, lane, position[i])
            put(self.velocity.at + i, lane, 0.0 if stuck[i] else velocity[i])
            put(self.slip.at + i, lane, 0.0 if stuck[i] else (-1.0 if velocity[i] < 0.0 else 1.0))
            put(self.acceleration.at + i, lane, 0.0)
            put(self.age.at + i, lane, LONG)
            put(self.touching.at + i, lane, 0.0)
        put(self.clock.at, lane, 0.0)
        put(self.clock_rest.at, lane, 0.0)
        put(self.count.at, lane, 0.0)
        put(self.unit_start.at, lane, 0.0)
        put(self.unit_count.at, lane, 0.0)
        self.accumulating = self.accumulating & ~from_bits(1 << lane)

    def spring_force(self, i: cython.Py_ssize_t) -> vec:
        """Return s_i."""
        x: cython.pointer[vec] = self.position.at
        pull: vec = self.left[i] * x[self.lower[i]] + self.right[i] * x[self.upper[i]]
        return self.sliding_force[i] + (pull - self.diagonal[i] * x[i])

    def force_rate(self, i: cython.Py_ssize_t) -> vec:
        """Return ds_i/dτ."""
        w: cython.pointer[vec] = self.velocity.at
        v: cython.double = self.v
        pull: vec = self.left[i] * (w[self.lower[i]] - v) + self.right[i] * (w[self.upper[i]] - v)
        return pull - self.diagonal[i] * (w[i] - v)

    def friction_of(self, i: cython.Py_ssize_t, speed: vec) -> vec:
        """Return Φ(|U_i'|); the first row of column i of the friction series is that of this speed."""
        if self.friction.affine:
            return self.friction.constant + self.friction.slope * speed
        self.friction.register.at[i * self.friction.length] = speed
        self.friction.begin(i)
        return self.friction.register.at[self.friction.result + i * self.friction.length]

    def slip_acceleration(self, i: cython.Py_ssize_t, force: vec) -> vec:
        """Return U_i'' where block i slips under this spring force."""
        slip: vec = self.slip.at[i]
        whole: vec = force - self.threshold[i] * slip * self.friction_of(i, magnitude(self.velocity.at[i]))
        return select(less(self.age.at[i], splat(YOUNG)), self.acceleration.at[i], whole)

    def pending(self, i: cython.Py_ssize_t) -> mask:
        """Tell where block i changes at this very instant: it is past its threshold, or within COINCIDENCE of it."""
        slip: vec = self.slip.at[i]
        zero: vec = splat(0.0)
        force: vec = self.spring_force(i)
        rate: vec = self.force_rate(i)
        touching: mask = less(zero, self.touching.at[i])
        stuck: mask = equal(slip, zero)
        gap: vec = slip * self.velocity.at[i]
        slipping: mask = less(gap, zero)
        close: mask = at_most(gap, splat(COINCIDENCE)) & ~stuck & ~slipping
        if bits(close):
            bound: vec = -COINCIDENCE * (slip * self.slip_acceleration(i, force))
            slipping = slipping | (close & less(gap, bound))
        # At a start with Φ(0) < 1 the block has an acceleration, whatever the rate of the force.
        if self.static_friction < 1.0:
            slipping = slipping & ~touching
        else:
            slipping = (slipping & ~touching) | (less(slip * rate, zero) & touching)
        gap = self.threshold[i] - force
        nearness: cython.double = COINCIDENCE * self.diagonal[i]
        starting: mask = less(gap, zero) | (at_most(gap, splat(nearness)) & less(gap, COINCIDENCE * rate))
        if self.symmetric:
            gap = self.threshold[i] + force
            starting = starting | less(gap, zero)
            starting = starting | (at_most(gap, splat(nearness)) & less(gap, -COINCIDENCE * rate))
        return (slipping & ~stuck) | (starting & ~touching & stuck)

    def transition(self, i: cython.Py_ssize_t, where: mask) -> None:
        """Let block i stop if it slips and start if it is stuck."""
        zero: vec = splat(0.0)
        one: vec = splat(1.0)
        starting: mask = where & equal(self.slip.at[i], zero)
        force: vec = self.spring_force(i)
        direction: vec = select(less(zero, force), one, -one)
        threshold: cython.double = self.threshold[i]
        self.velocity.at[i] = select(where, zero, self.velocity.at[i])
        self.slip.at[i] = select(where, select(starting, direction, zero), self.slip.at[i])
        self.acceleration.at[i] = select(where, zero, self.acceleration.at[i])
        self.age.at[i] = select(where, splat(LONG), self.age.at[i])
        # A block that stopped beyond its threshold starts again with the acceleration that the excess gives it.
        terms: vec = largest(splat(threshold), self.diagonal[i] * magnitude(self.position.at[i]))
        starting = starting & at_most(magnitude(force) - threshold, AT_THRESHOLD * terms)
        self.touching.at[i] = select(starting, one, self.touching.at[i])
        self.age.at[i] = select(starting, zero, self.age.at[i])
        excess: cython.double = threshold * (1.0 - self.static_friction)
        self.acceleration.at[i] = select(starting, excess * direction, self.acceleration.at[i])

    def change(self, i: cython.Py_ssize_t, where: mask) -> None:
        """Let block i stop or start now, and count the event."""
        lane: cython.int
        k: cython.Py_ssize_t
        member: cython.Py_ssize_t
        changing: cython.int = bits(where)
        one: vec = splat(1.0)
        new: mask = where & at_most(self.unit_start.at[0] + one, self.clock.at[0])
        self.transition(i, where)
        if self.kept > 0:
            for lane in range(LANES):
                k = cython.cast(cython.Py_ssize_t, lane_of(self.count.at[0], lane))
                if changing >> lane & 1 and k < self.kept:
                    member = self.member[lane]
                    self.event_time[member, k] = lane_of(self.clock.at[0], lane)
                    self.event_block[member, k] = i + 1
                    self.event_kind[member, k] = lane_of(self.slip.at[i], lane) != 0.0
        self.count.at[0] = select(where, self.count.at[0] + one, self.count.at[0])
        self.unit_start.at[0] = select(new, self.clock.at[0], self.unit_start.at[0])
        self.unit_count.at[0] = select(new, splat(0.0), self.unit_count.at[0])
        self.unit_count.at[0] = select(where, self.unit_count.at[0] + one, self.unit_count.at[0])
        self.accumulating = self.accumulating | less(splat(self.rate_limit), self.unit_count.at[0])

    def settle(self, where: mask) -> None:
        """Carry out every change that is due at this instant, to the last one, before time moves on."""
        i: cython.Py_ssize_t
        changing: cython.int
        where = where & ~self.accumulating
        while bits(where):
            # Who changes is decided before anyone does: then no order of the blocks is preferred.
            changing = 0
            for i in range(self.blocks):
                self.due[i] = bits(where & self.pending(i))
                changing |= self.due[i]
            if not changing:
                return
            for i in range(self.blocks):
                if self.due[i]:
                    self.change(i, from_bits(self.due[i]))
            where = from_bits(changing) & ~self.accumulating
