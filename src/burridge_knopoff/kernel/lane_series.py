"""Taylor series of the motion in lanes, with a step that leaves no remainder: `series` for many trajectories at once.

Order and truncation are lower than there, since all lanes pay for each coefficient.
"""

import math

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.lanes import Lanes
from cython.cimports.burridge_knopoff.kernel.state import YOUNG
from cython.cimports.burridge_knopoff.kernel.vector import (
    LANES,
    Vectors,
    bits,
    exponent,
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

# Bound of the last term that is kept; the one before it, which may be larger, bounds the step where the last is small
# by chance. The first that is left out is smaller by RATIO or more.
TRUNCATION = 4e-16
RATIO = 5.0

# The longest step, and that of lanes in which nothing slips: its powers are finite.
LONGEST = 1e12


def steps(order: int, term: float) -> np.ndarray:
    """Return, for each exponent of a coefficient of this order, the step with which its term is at most `term`."""
    step = np.full(2048, LONGEST)
    for e in range(1, 2047):
        step[e] = min(LONGEST, 2.0 ** ((math.log2(term) - (e - 1022)) / order))
    step[2047] = 0.0
    # Rounded to 26 bits: the C libraries' powers differ in their last bit.
    scaled = 134217729.0 * step
    return scaled - (scaled - step)


class LaneSeries:
    """The coefficients of x_i, U_i' and the gaps g_i, from t = 0, for all lanes.

    g_i is the speed |U_i'| of a slipping block and θ_i − s_i of a stuck one: where it falls below 0 the block changes.
    Coefficient k of block i is in at[k·width + i + 1], with columns for the neighbours of the first and the last block;
    `reach` is the time for which a series is valid.

    order : even
    """

    blocks: cython.Py_ssize_t
    order: cython.Py_ssize_t
    width: cython.Py_ssize_t
    position: Vectors
    velocity: Vectors
    gap: Vectors
    slipping: Vectors
    stuck: Vectors
    grip: Vectors
    power: Vectors
    reach: Vectors
    reciprocal: cython.double[::1]
    step_of_last: cython.double[::1]
    step_of_previous: cython.double[::1]

    def __init__(self, blocks: int, order: int) -> None:
        self.blocks = blocks
        self.order = order
        self.width = blocks + 2
        self.position = Vectors((order + 1) * self.width)
        self.velocity = Vectors((order + 1) * self.width)
        self.gap = Vectors((order + 1) * self.width)
        self.slipping = Vectors(blocks)
        self.stuck = Vectors(blocks)
        self.grip = Vectors(blocks)
        self.power = Vectors(order + 4)
        self.power.at[0] = splat(1.0)
        self.reach = Vectors(1)
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 2, dtype=float), 1.0)
        self.step_of_last = steps(order, TRUNCATION)
        self.step_of_previous = steps(order - 1, RATIO * TRUNCATION)

    def expand(self, lanes: Lanes) -> None:
        """Fill the series with the motion that starts from the states, and `reach`: 0 where a state has no motion."""
        n: cython.Py_ssize_t
        self._begin(lanes)
        for n in range(1, self.order):
            self._close_ring(lanes, n)
            if lanes.friction.affine:
                self._affine_row(lanes, n)
            else:
                self._row(lanes, n)
        self._last_row(lanes)
        self._bound()
        if lanes.friction.exponential:
            self.reach.at[0] = lanes.friction.shorten(self.reach.at[0])

    def _begin(self, lanes: Lanes) -> None:
        """Fill the rows 0 and 1 that follow from the states."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        v: cython.double = lanes.v
        force: vec
        slip: vec
        for i in range(self.blocks):
            k = i + 1
            slip = lanes.slip.at[i]
            force = lanes.spring_force(i)
            self.slipping.at[i] = slip * slip
            self.stuck.at[i] = splat(1.0) - slip * slip
            self.grip.at[i] = lanes.threshold[i] * slip
            self.position.at[k] = lanes.position.at[i]
            self.velocity.at[k] = lanes.velocity.at[i]
            self.gap.at[k] = slip * lanes.velocity.at[i] + self.stuck.at[i] * (lanes.threshold[i] - force)
            self.velocity.at[k + self.width] = self.slipping.at[i] * lanes.slip_acceleration(i, force)
            self.position.at[k + self.width] = lanes.velocity.at[i] - v

    def _close_ring(self, lanes: Lanes, n: cython.Py_ssize_t) -> None:
        """Put the positions of the last and the first block beside those of their neighbours round a ring."""
        x: cython.pointer[vec] = self.position.at + n * self.width
        if lanes.ring:
            x[0] = x[self.blocks]
            x[self.blocks + 1] = x[1]

    def _affine_row(self, lanes: Lanes, n: cython.Py_ssize_t) -> None:
        """Fill row n of the gaps and row n + 1 of positions and velocities from row n of them, for an affine law."""
        i: cython.Py_ssize_t
        width: cython.Py_ssize_t = self.width
        x: cython.pointer[vec] = self.position.at + n * width + 1
        w: cython.pointer[vec] = self.velocity.at + n * width + 1
        gap: cython.pointer[vec] = self.gap.at + n * width + 1
        factor: cython.double = self.reciprocal[n + 1]
        force: vec
        speed: vec
        scale: vec
        for i in range(self.blocks):
            speed = w[i]
            force = (lanes.left[i] * x[i - 1] + lanes.right[i] * x[i + 1]) - lanes.diagonal[i] * x[i]
            gap[i] = lanes.slip.at[i] * speed - self.stuck.at[i] * force
            x[width + i] = factor * speed
            # What waits for the speed comes last.
            scale = factor * self.slipping.at[i]
            w[width + i] = scale * force - (scale * lanes.slope[i]) * speed

    def _row(self, lanes: Lanes, n: cython.Py_ssize_t) -> None:
        """Do the same for any other law."""
        i: cython.Py_ssize_t
        width: cython.Py_ssize_t = self.width
        length: cython.Py_ssize_t = self.order + 1
        x: cython.pointer[vec] = self.position.at + n * width + 1
        w: cython.pointer[vec] = self.velocity.at + n * width + 1
        gap: cython.pointer[vec] = self.gap.at + n * width + 1
        speed: cython.pointer[vec] = lanes.friction.register.at + n
        friction: cython.pointer[vec] = lanes.friction.register.at + lanes.friction.result + n
        factor: cython.double = self.reciprocal[n + 1]
        force: vec
        for i in range(self.blocks):
            speed[i * length] = lanes.slip.at[i] * w[i]
        lanes.friction.extend(n)
        for i in range(self.blocks):
            force = (lanes.left[i] * x[i - 1] + lanes.right[i] * x[i + 1]) - lanes.diagonal[i] * x[i]
            gap[i] = speed[i * length] - self.stuck.at[i] * force
            x[width + i] = factor * w[i]
            w[width + i] = (force - self.grip.at[i] * friction[i * length]) * (factor * self.slipping.at[i])

    def _last_row(self, lanes: Lanes) -> None:
        """Fill the last row of the gaps."""
        i: cython.Py_ssize_t
        x: cython.pointer[vec] = self.position.at + self.order * self.width + 1
        w: cython.pointer[vec] = self.velocity.at + self.order * self.width + 1
        gap: cython.pointer[vec] = self.gap.at + self.order * self.width + 1
        force: vec
        self._close_ring(lanes, self.order)
        for i in range(self.blocks):
            force = (lanes.left[i] * x[i - 1] + lanes.right[i] * x[i + 1]) - lanes.diagonal[i] * x[i]
            gap[i] = lanes.slip.at[i] * w[i] - self.stuck.at[i] * force

    def _bound(self) -> None:
        """Set the time over which the first neglected terms stay below TRUNCATION.

        0 where a term is no number: the larger of that and a number may be the number, but no sum is one.
        """
        i: cython.Py_ssize_t
        lane: cython.int
        end: cython.Py_ssize_t = self.order * self.width + 1
        last: vec = splat(0.0)
        previous: vec = splat(0.0)
        total: vec = splat(0.0)
        for i in range(self.blocks):
            last = largest(magnitude(self.velocity.at[end + i]), last)
            previous = largest(magnitude(self.velocity.at[end - self.width + i]), previous)
            total = total + (self.velocity.at[end + i] + self.velocity.at[end - self.width + i])
        last = last + splat(0.0) * total
        for lane in range(LANES):
            put(
                self.reach.at,
                lane,
                min(
                    self.step_of_last[exponent(lane_of(last, lane))],
                    self.step_of_previous[exponent(lane_of(previous, lane))],
                ),
            )

    def raise_powers(self, t: vec) -> None:
        """Set `power` to those of t."""
        k: cython.Py_ssize_t
        power: cython.pointer[vec] = self.power.at
        second: vec = t * t
        # Four products, which a processor forms at the same time.
        fourth: vec = second * second
        one: vec = t
        two: vec = second
        three: vec = second * t
        four: vec = fourth
        for k in range(1, self.order + 1, 4):
            power[k] = one
            power[k + 1] = two
            power[k + 2] = three
            power[k + 3] = four
            one = one * fourth
            two = two * fourth
            three = three * fourth
            four = four * fourth

    def move(self, lanes: Lanes, t: vec, where: mask) -> None:
        """Move the states of some lanes on by t, whose powers are in `power`."""
        i: cython.Py_ssize_t
        k: cython.Py_ssize_t
        at: cython.Py_ssize_t
        width: cython.Py_ssize_t = self.width
        power: cython.pointer[vec] = self.power.at
        zero: vec = splat(0.0)
        x: vec
        other_x: vec
        w: vec
        other_w: vec
        moved: mask = where & less(zero, t)
        young: mask
        for i in range(self.blocks):
            at = i + 1
            x = other_x = w = other_w = zero
            # From the smallest terms on, even and odd ones apart.
            for k in range(self.order, 1, -2):
                x = x + self.position.at[at + k * width] * power[k]
                other_x = other_x + self.position.at[at + (k - 1) * width] * power[k - 1]
                w = w + self.velocity.at[at + k * width] * power[k]
                other_w = other_w + self.velocity.at[at + (k - 1) * width] * power[k - 1]
            lanes.position.at[i] = select(moved, self.position.at[at] + (other_x + x), lanes.position.at[i])
            lanes.velocity.at[i] = select(moved, self.velocity.at[at] + (other_w + w), lanes.velocity.at[i])
            lanes.touching.at[i] = select(moved, zero, lanes.touching.at[i])
            lanes.age.at[i] = select(moved, lanes.age.at[i] + t, lanes.age.at[i])
            young = moved & less(lanes.age.at[i], splat(YOUNG))
            if bits(young):
                w = zero
                for k in range(self.order, 0, -1):
                    w = w * t + cython.cast(cython.double, k) * self.velocity.at[at + k * width]
                lanes.acceleration.at[i] = select(young, w, lanes.acceleration.at[i])

    def at_time(self, series: Vectors, i: cython.Py_ssize_t, t: vec) -> vec:
        """Return block i's value of a series at t."""
        k: cython.Py_ssize_t
        total: vec = series.at[self.order * self.width + i + 1]
        for k in range(self.order - 1, -1, -1):
            total = total * t + series.at[k * self.width + i + 1]
        return total
