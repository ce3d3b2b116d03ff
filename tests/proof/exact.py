"""The synchronized orbit at 50 digits, computed independently: all three blocks, matrix exponentials, Newton."""

from dataclasses import dataclass

import mpmath
from mpmath import mp, mpf

from burridge_knopoff import Chain

DIGITS = 50
#: Which blocks slip on each arc, and the block whose event ends it; block 3 moves like block 1.
ARCS = (((0, 1, 0), 0), ((1, 1, 1), 0), ((0, 1, 0), 1), ((0, 0, 0), 1))


def matrix(slips, a):
    """Return the matrix of the motion of (x, x', 1), in units of v."""
    stiffness = Chain(3).stiffness
    rates = mp.zeros(7)
    for i, slip in enumerate(slips):
        rates[i, 3 + i] = 1
        if slip:
            rates[3 + i, 3 + i] = a
            for k in range(3):
                rates[3 + i, k] = -mpf(float(stiffness[i, k]))
    return rates


def force(state, block, a):
    """Return (s − 1)/v of a block at rest."""
    return -sum(mpf(float(Chain(3).stiffness[block, k])) * state[k] for k in range(3)) - a


def follow(unknown, a):
    """Return the event functions, the final state, and its derivatives with respect to the first state."""
    x, y, *times = unknown
    state = mp.matrix([x, y, x, -1, -1, -1, 1])
    tangent = mp.eye(7)
    margins = []
    for (slips, block), time in zip(ARCS, times, strict=True):
        step = mp.expm(matrix(slips, a) * time, method="taylor")
        state, tangent = step * state, step * tangent
        margins.append(state[3 + block] + 1 if slips[block] else force(state, block, a))
        if slips[block]:
            for i in (block, 2 - block):
                state[3 + i] = -1
                for k in range(7):
                    tangent[3 + i, k] = 0
    return margins, state, tangent


@dataclass
class Exact:
    """The orbit: the unknowns of the proof, and its multipliers."""

    a: mpf
    unknown: list
    transverse: mpf
    symmetric: mpf


def exact_orbit(guess, a):
    """Return the orbit at one a or, if there is none, at the a at which the transverse multiplier is 1.

    guess : the unknowns, and a if that is to be found
    """
    with mpmath.workdps(DIGITS):

        def equations(*unknown):
            a_value = mpf(a) if a is not None else unknown[6]
            margins, state, tangent = follow(unknown[:6], a_value)
            values = [*margins, state[0] - unknown[0], state[1] - unknown[1]]
            return values if a is not None else [*values, transverse(tangent) - 1]

        solution = list(mpmath.findroot(equations, [mpf(value) for value in guess], tol=mpf(10) ** (8 - 2 * DIGITS)))
        a_value = mpf(a) if a is not None else solution[6]
        tangent = follow(solution[:6], a_value)[2]
        # The derivative of x_1 − x_2 with respect to x_1 = x_3.
        symmetric = tangent[0, 0] + tangent[0, 2] - tangent[1, 0] - tangent[1, 2]
        return Exact(a_value, solution[:6], transverse(tangent), symmetric)


def transverse(tangent):
    """Return the factor by which x_1 − x_3 changes in a period."""
    return (tangent[0, 0] - tangent[0, 2] - tangent[2, 0] + tangent[2, 2]) / 2
