"""Taylor series of the motion between two events, for either friction law, with a step that leaves no remainder.

Coefficients follow from x' = U' − v and U'' = s − Φ(aU') by recursion; Φ = 1/(1 + aU') by division of series. The step
comes from the last two coefficients (Jorba and Zou): the first neglected term stays below TRUNCATION. For the
linearized law this is a bound and not an estimate: all derivatives of the motion obey the same linear equation, whose
energy E grows at most like exp(2aτ), so the neglected derivative at any time in the step is at most exp(aτ) times its
value at the start.

Reference: A. Jorba and M. Zou, "A software package for the numerical integration of ODEs by means of high-order Taylor
methods", Exp. Math. 14 (2005) 99-117.
"""

import cython
import numpy as np
from cython.cimports.libc.math import pow as power

if cython.compiled:
    pass
else:
    pass

ORDER = 24
TRUNCATION = 1e-18


class Series:
    """Work space of the recursion for chains of `blocks` blocks at the given order.

    `friction` holds the series of Φ highest power first, so that products of series run through memory one way.
    """

    def __init__(self, blocks: int, order: int) -> None:
        self.friction = np.zeros((blocks, order + 1))
        self.reciprocal = 1.0 / np.maximum(np.arange(order + 2, dtype=float), 1.0)
        self.step_power_last = 1.0 / order
        self.step_power_previous = 1.0 / (order - 1)

    def expand(self, state, piece):
        """Fill the piece with the motion that starts from the state; return the time for which it is valid."""
        i: cython.Py_ssize_t
        j: cython.Py_ssize_t
        n: cython.Py_ssize_t
        blocks: cython.Py_ssize_t = state.blocks
        pull: cython.double
        start: cython.Py_ssize_t
        first: cython.double
        second: cython.double
        third: cython.double
        fourth: cython.double
        total: cython.double
        factor: cython.double
        direction: cython.double
        for i in range(blocks):
            piece.position[i, 0] = state.position[i]
            piece.velocity[i, 0] = state.velocity[i]
        for n in range(piece.order):
            for i in range(blocks):
                piece.position[i, n + 1] = piece.velocity[i, n] * self.reciprocal[n + 1]
            if n == 0:
                for i in range(blocks):
                    piece.position[i, 1] -= state.v
            for i in range(blocks):
                pull = state.stiffness[i] * piece.position[i, n]
                if i > 0:
                    pull -= piece.position[i - 1, n]
                if i < blocks - 1:
                    pull -= piece.position[i + 1, n]
                piece.force[i, n] = -pull
            if n == 0:
                for i in range(blocks):
                    piece.force[i, 0] += state.sliding_friction
                    piece.velocity[i, 1] = 0.0 if state.slip[i] == 0 else state.slip_acceleration(i)
                    if state.nonlinear and state.slip[i] != 0:
                        self.friction[i, piece.order] = 1.0 / (1.0 + state.a * abs(state.velocity[i]))
                continue
            for i in range(blocks):
                if state.slip[i] == 0:
                    piece.velocity[i, n + 1] = 0.0
                    continue
                if state.nonlinear:
                    direction = state.slip[i]
                    # Four sums, which a processor forms at the same time; one would wait for each addition.
                    first = second = third = fourth = 0.0
                    start = piece.order - n
                    j = 1
                    while j + 3 <= n:
                        first += piece.velocity[i, j] * self.friction[i, start + j]
                        second += piece.velocity[i, j + 1] * self.friction[i, start + j + 1]
                        third += piece.velocity[i, j + 2] * self.friction[i, start + j + 2]
                        fourth += piece.velocity[i, j + 3] * self.friction[i, start + j + 3]
                        j += 4
                    while j <= n:
                        first += piece.velocity[i, j] * self.friction[i, start + j]
                        j += 1
                    total = (first + third) + (second + fourth)
                    # direction · Φ_n, from (1 + a direction U') Φ = 1.
                    factor = -state.a * total * self.friction[i, piece.order]
                    self.friction[i, start] = direction * factor
                    piece.velocity[i, n + 1] = (piece.force[i, n] - factor) * self.reciprocal[n + 1]
                else:
                    piece.velocity[i, n + 1] = (piece.force[i, n] + state.a * piece.velocity[i, n]) * self.reciprocal[
                        n + 1
                    ]
        for i in range(blocks):
            n = piece.order
            pull = state.stiffness[i] * piece.position[i, n]
            if i > 0:
                pull -= piece.position[i - 1, n]
            if i < blocks - 1:
                pull -= piece.position[i + 1, n]
            piece.force[i, n] = -pull
        return self._step(piece)

    def _step(self, piece):
        """Return the time over which the first neglected terms stay below TRUNCATION (infinite if nothing slips)."""
        i: cython.Py_ssize_t
        last: cython.double = 0.0
        previous: cython.double = 0.0
        for i in range(piece.blocks):
            last = max(last, abs(piece.velocity[i, piece.order]))
            previous = max(previous, abs(piece.velocity[i, piece.order - 1]))
        if last == 0.0 and previous == 0.0:
            return 1e300
        if not (last + previous < 1e300):
            return 0.0
        return min(
            1e300 if last == 0.0 else power(TRUNCATION / last, self.step_power_last),
            1e300 if previous == 0.0 else power(TRUNCATION / previous, self.step_power_previous),
        )
