"""Taylor series of the motion between two events, for either friction law, with a step that leaves no remainder.

Coefficients follow from x' = U' − v and U'' = s − Φ(aU') by recursion; Φ = 1/(1 + aU') by division of series. The step
comes from the last two coefficients (Jorba and Zou): the last terms that are kept stay below TRUNCATION, and those that
are left out are smaller still. For the linearized law that is safe by a bound: all derivatives of the motion obey the
same linear equation, whose energy, with pairs of successive derivatives of all blocks in it, grows at most like
exp(2aτ) within a step.

Reference: A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
methods", Exp. Math. 14 (2005) 99-117.
"""

import cython
import numpy as np
from cython.cimports.libc.math import pow as power

TRUNCATION = 1e-18
SPLITTER = 134217729.0


class Series:
    """Work space of the recursion for chains of `blocks` blocks at the given order.

    `friction` holds the series of Φ highest power first and `speed` that of U' lowest power first, so that their
    product runs through memory one way.
    """

    def __init__(self, blocks: int, order: int) -> None:
        self.friction = np.zeros((blocks, order + 1))
        self.speed = np.zeros((blocks, order + 1))
        self.slipping = np.zeros(blocks)
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 2, dtype=float), 1.0)
        self.step_power_last = 1.0 / order
        self.step_power_previous = 1.0 / (order - 1)

    def expand(self, state, piece):
        """Fill the piece with the motion that starts from the state; return the time for which it is valid."""
        i: cython.Py_ssize_t
        n: cython.Py_ssize_t
        order: cython.Py_ssize_t = piece.order
        blocks: cython.Py_ssize_t = state.blocks
        a: cython.double = state.a
        factor: cython.double
        for i in range(blocks):
            piece.position[0, i + 1] = state.position[i]
            piece.velocity[0, i + 1] = state.velocity[i]
            piece.position[1, i + 1] = state.velocity[i] - state.v
            piece.velocity[1, i + 1] = 0.0
            self.slipping[i] = 0.0
            if state.slip[i] != 0:
                self.slipping[i] = 1.0
                piece.velocity[1, i + 1] = state.slip_acceleration(i)
        piece.fill_force(state, 0)
        if state.nonlinear:
            self._start_friction(state, piece)
        for n in range(1, order):
            factor = self.reciprocal[n + 1]
            for i in range(blocks):
                piece.position[n + 1, i + 1] = piece.velocity[n, i + 1] * factor
            piece.fill_force(state, n)
            if state.nonlinear:
                self._nonlinear(state, piece, n)
            else:
                for i in range(blocks):
                    piece.velocity[n + 1, i + 1] = (
                        self.slipping[i] * factor * (piece.force[n, i + 1] + a * piece.velocity[n, i + 1])
                    )
        piece.fill_force(state, order)
        return self._step(piece)

    def _start_friction(self, state, piece):
        """Set the constant and linear terms from which the series of the nonlinear friction grows."""
        i: cython.Py_ssize_t
        for i in range(state.blocks):
            if state.slip[i] != 0:
                self.friction[i, piece.order] = 1.0 / (1.0 + state.a * abs(state.velocity[i]))
                self.speed[i, 1] = piece.velocity[1, i + 1]

    def _nonlinear(self, state, piece, n):
        """Fill row n + 1 of the velocities: the term of Φ follows from (1 + a |U'|) Φ = 1."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        start: cython.Py_ssize_t = piece.order - n
        first: cython.double
        second: cython.double
        third: cython.double
        fourth: cython.double
        factor: cython.double
        for i in range(state.blocks):
            if state.slip[i] == 0:
                piece.velocity[n + 1, i + 1] = 0.0
                continue
            # Four sums, which a processor forms at the same time; one would wait for each addition.
            first = second = third = fourth = 0.0
            j = 1
            while j + 3 <= n:
                first += self.speed[i, j] * self.friction[i, start + j]
                second += self.speed[i, j + 1] * self.friction[i, start + j + 1]
                third += self.speed[i, j + 2] * self.friction[i, start + j + 2]
                fourth += self.speed[i, j + 3] * self.friction[i, start + j + 3]
                j += 4
            while j <= n:
                first += self.speed[i, j] * self.friction[i, start + j]
                j += 1
            # Signed by the direction of slip, as friction is.
            factor = -state.a * ((first + third) + (second + fourth)) * self.friction[i, piece.order]
            self.friction[i, start] = factor if state.slip[i] > 0 else -factor
            piece.velocity[n + 1, i + 1] = (piece.force[n, i + 1] - factor) * self.reciprocal[n + 1]
            self.speed[i, n + 1] = piece.velocity[n + 1, i + 1]

    def _step(self, piece):
        """Return the time over which the first neglected terms stay below TRUNCATION (infinite if nothing slips)."""
        i: cython.Py_ssize_t
        step: cython.double
        scaled: cython.double
        last: cython.double = 0.0
        previous: cython.double = 0.0
        for i in range(piece.blocks):
            last = max(last, abs(piece.velocity[piece.order, i + 1]))
            previous = max(previous, abs(piece.velocity[piece.order - 1, i + 1]))
        if last == 0.0 and previous == 0.0:
            return 1e300
        if not (last + previous < 1e300):
            return 0.0
        step = min(
            1e300 if last == 0.0 else power(TRUNCATION / last, self.step_power_last),
            1e300 if previous == 0.0 else power(TRUNCATION / previous, self.step_power_previous),
        )
        # Rounded to 26 bits (Veltkamp's splitting): the C libraries' powers differ in their last bit.
        scaled = SPLITTER * step
        return scaled - (scaled - step)
