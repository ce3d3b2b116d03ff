"""Taylor series of the motion between two events, with a step that leaves no remainder.

Coefficients follow from x' = U' − v and U'' = s − threshold Φ by recursion, those of Φ from the operations of the law.
Blocks lie in the lanes of vectors. The step comes from the last two coefficients (Jorba and Zou): the last terms that
are kept stay below TRUNCATION, and those that are left out are smaller still. For the linearized law that is safe by a
bound: all derivatives of the motion obey the same linear equation, whose energy, with pairs of successive derivatives
of all blocks in it, grows at most like exp(2aτ) within a step.

Reference: A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
methods", Exp. Math. 14 (2005) 99-117.
"""

import cython
import numpy as np
from cython.cimports.burridge_knopoff.kernel.friction import inner, prepare, row, settle, slopes
from cython.cimports.burridge_knopoff.kernel.piece import ORDER, Piece
from cython.cimports.burridge_knopoff.kernel.springs import AFTER, BEFORE, DIAGONAL, SLIDING, pulls, thresholds
from cython.cimports.burridge_knopoff.kernel.state import YOUNG, State
from cython.cimports.burridge_knopoff.kernel.vector import (
    Vectors,
    convolution,
    exponent,
    index,
    scale,
    shuffle,
    splat,
    vec,
)

#: Order of the series: enough for a piece of about one time unit, the usual gap between two events.
SERIES_ORDER = ORDER

# Binary digits below 1 at which terms are left out.
TRUNCATION = 53

# Longest piece, while nothing slips: high powers of it are still numbers.
LONGEST = 1e9


class Series:
    """The recursion for `columns` vectors of blocks."""

    reciprocal: cython.double[::1]
    moving: Vectors
    signed: Vectors
    damping: Vectors
    pressed: Vectors
    last_root: cython.double[::1]
    previous_root: cython.double[::1]

    def __init__(self, columns: int) -> None:
        self.reciprocal = 1.0 / np.maximum(np.arange(ORDER + 2, dtype=float), 1.0)
        # Slipping or not, threshold signed by the direction of slip, and friction per speed.
        self.moving = Vectors(columns)
        self.signed = Vectors(columns)
        self.damping = Vectors(columns)
        # The same threshold times what friction is per sum of its recurrence, if it is a multiple of a reciprocal.
        self.pressed = Vectors(columns)
        # Roots of 2, cut to 30 bits: C libraries differ in the last one.
        self.last_root = np.floor(2.0 ** (30.0 + np.arange(ORDER) / ORDER)) / 2.0**30
        self.previous_root = np.floor(2.0 ** (30.0 + np.arange(ORDER - 1) / (ORDER - 1))) / 2.0**30

    def expand(self, state: State, piece: Piece) -> cython.double:
        """Fill the piece with the motion that starts from the state; return the time for which it is valid."""
        i: cython.Py_ssize_t
        c: cython.Py_ssize_t
        young: cython.bint = False
        columns: cython.Py_ssize_t = piece.columns
        value: cython.int = state.friction.value
        linear: cython.bint = state.friction.linear
        rate: cython.double = state.friction.rate
        x: cython.pointer[vec] = piece.positions.at
        u: cython.pointer[vec] = piece.velocities.at
        s: cython.pointer[vec] = piece.forces.at
        speed: vec
        friction: vec
        slope: vec
        for i in range(state.blocks):
            # Only where it has changed: reading a vector must wait for what was written to its lanes.
            if piece.direction_table[i] != state.slip[i] or piece.stuck_table[i] != (state.slip[i] == 0):
                piece.stuck_table[i] = state.slip[i] == 0
                piece.direction_table[i] = state.slip[i]
            if state.slip[i] != 0 and (state.touching[i] or state.age[i] < YOUNG):
                young = True
        for c in range(columns):
            x[c] = state.positions.at[c]
            u[c] = state.velocities.at[c]
            x[columns + c] = u[c] - state.v
        for c in range(columns):
            s[c] = state.springs.lanes.at[SLIDING * columns + c] + pulls(state.springs, x, c)
            self.moving.at[c] = splat(1.0) - piece.stuck.at[c]
            # Signed by the direction of slip, as friction is.
            self.signed.at[c] = piece.direction.at[c] * thresholds(state.springs, c)
            speed = piece.direction.at[c] * u[c]
            if linear:
                friction = state.friction.at_rest - rate * speed
                slope = splat(-rate)
            else:
                state.friction.start(c, speed)
                friction = row(state.friction, value, c)[0]
                slope = slopes(state.friction, c)[value]
            self.damping.at[c] = self.signed.at[c] * (slope * piece.direction.at[c])
            if state.friction.hyperbolic:
                self.pressed.at[c] = -(self.signed.at[c] * (state.friction.scale * row(state.friction, 2, c)[0]))
            u[columns + c] = self.moving.at[c] * (s[c] - self.signed.at[c] * friction)
            s[columns + c] = pulls(state.springs, x + columns, c)
        if young:
            for i in range(state.blocks):
                if state.slip[i] != 0 and (state.touching[i] or state.age[i] < YOUNG):
                    piece.velocity[1, i] = state.slip_acceleration(i)
        if columns == 1:
            self._extend_one(state, piece)
        else:
            self._extend(state, piece)
        if state.friction.exponential:
            return state.friction.shorten(self._step(piece))
        return self._step(piece)

    def _extend(self, state: State, piece: Piece) -> None:
        """Fill the rows from 2 on.

        In row n friction is its slope at the start times U'_n, plus what follows from the rows before: that is ready
        before U'_n is.
        """
        n: cython.Py_ssize_t
        c: cython.Py_ssize_t
        columns: cython.Py_ssize_t = piece.columns
        value: cython.int = state.friction.value
        x: cython.pointer[vec] = piece.positions.at
        u: cython.pointer[vec] = piece.velocities.at
        s: cython.pointer[vec] = piece.forces.at
        line: cython.pointer[vec]
        inverse: cython.pointer[vec]
        factor: cython.double
        force: vec
        speed: vec
        total: vec
        for n in range(1, ORDER):
            factor = self.reciprocal[n + 1]
            for c in range(columns):
                speed = u[n * columns + c]
                force = (self.moving.at[c] * factor) * s[n * columns + c]
                if state.friction.hyperbolic:
                    line = row(state.friction, 1, c)
                    inverse = row(state.friction, 2, c)
                    total = inner(line, inverse, n)
                    force = force - (self.pressed.at[c] * factor) * total
                    line[n] = (slopes(state.friction, c)[1] * piece.direction.at[c]) * speed
                    inverse[n] = (slopes(state.friction, c)[2] * piece.direction.at[c]) * speed - inverse[0] * total
                elif not state.friction.linear:
                    prepare(state.friction, c, n)
                    force = force - (self.signed.at[c] * factor) * row(state.friction, value, c)[n]
                    settle(state.friction, c, n, piece.direction.at[c] * speed)
                u[(n + 1) * columns + c] = force - (self.damping.at[c] * factor) * speed
                x[(n + 1) * columns + c] = speed * factor
            for c in range(columns):
                s[(n + 1) * columns + c] = pulls(state.springs, x + (n + 1) * columns, c)

    def _extend_one(self, state: State, piece: Piece) -> None:
        """Do the same for blocks that lie in one vector, which need not wait for memory."""
        n: cython.Py_ssize_t
        value: cython.int = state.friction.value
        linear: cython.bint = state.friction.linear
        x: cython.pointer[vec] = piece.positions.at
        u: cython.pointer[vec] = piece.velocities.at
        s: cython.pointer[vec] = piece.forces.at
        lanes: cython.pointer[vec] = state.springs.lanes.at
        diagonal: vec = lanes[DIAGONAL]
        before: vec = lanes[BEFORE]
        after: vec = lanes[AFTER]
        previous: index = cython.cast(cython.pointer[index], state.springs.from_previous.at)[0]
        following: index = cython.cast(cython.pointer[index], state.springs.from_next.at)[0]
        moving: vec = self.moving.at[0]
        signed: vec = self.signed.at[0]
        damping: vec = self.damping.at[0]
        direction: vec = piece.direction.at[0]
        speed: vec = u[1]
        shift: vec
        force: vec = s[1]
        factor: cython.double
        hyperbolic: cython.bint = state.friction.hyperbolic
        line: cython.pointer[vec] = row(state.friction, 1, 0)
        inverse: cython.pointer[vec] = row(state.friction, 2, 0)
        line_slope: vec = splat(0.0)
        inverse_slope: vec = line_slope
        total: vec = line_slope
        first_line: vec = line_slope
        first_inverse: vec = line_slope
        last_line: vec = line_slope
        last_inverse: vec = line_slope
        start: vec = line_slope
        pressed: vec = self.pressed.at[0]
        if hyperbolic:
            line_slope = slopes(state.friction, 0)[1] * direction
            inverse_slope = slopes(state.friction, 0)[2] * direction
            start = inverse[0]
        for n in range(1, ORDER):
            factor = self.reciprocal[n + 1]
            shift = speed * factor
            force = (moving * factor) * force
            if hyperbolic:
                # As `inner` sums.
                if n == 2:
                    total = first_line * last_inverse
                elif n > 2:
                    total = (convolution(line + 1, inverse + 1, n - 2) + last_line * first_inverse) + (
                        first_line * last_inverse
                    )
                force = force - (pressed * factor) * total
                last_line = line_slope * speed
                last_inverse = inverse_slope * speed - start * total
                if n == 1:
                    first_line = last_line
                    first_inverse = last_inverse
                line[n] = last_line
                inverse[n] = last_inverse
            elif not linear:
                prepare(state.friction, 0, n)
                force = force - (signed * factor) * row(state.friction, value, 0)[n]
                settle(state.friction, 0, n, direction * speed)
            speed = force - (damping * factor) * speed
            force = (
                before * shuffle(shift, shift, previous) + after * shuffle(shift, shift, following)
            ) - diagonal * shift
            u[n + 1] = speed
            x[n + 1] = shift
            s[n + 1] = force

    def _step(self, piece: Piece) -> cython.double:
        """Return the time over which the last terms that are kept stay below TRUNCATION; LONGEST if nothing slips.

        0 where a term is no number: the larger of that and a number may be the number, but no sum is one.
        """
        i: cython.Py_ssize_t
        last: cython.double = 0.0
        previous: cython.double = 0.0
        total: cython.double = 0.0
        for i in range(piece.blocks):
            total += abs(piece.velocity[ORDER, i]) + abs(piece.velocity[ORDER - 1, i])
            last = max(last, abs(piece.velocity[ORDER, i]))
            previous = max(previous, abs(piece.velocity[ORDER - 1, i]))
        if not (total < 1e300):
            return 0.0
        return min(_length(last, self.last_root, ORDER), _length(previous, self.previous_root, ORDER - 1), LONGEST)


def _length(coefficient: cython.double, root: cython.double[::1], power: cython.int) -> cython.double:
    """Return about the time at which this power of it, with its coefficient, is as small as TRUNCATION says."""
    digits: cython.int
    if coefficient < 1e-300:
        return LONGEST
    digits = -TRUNCATION - (exponent(coefficient) - 1022)
    whole: cython.int = digits // power if digits >= 0 else -((power - 1 - digits) // power)
    return scale(root[digits - whole * power], whole)
