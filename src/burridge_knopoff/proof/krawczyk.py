"""Krawczyk's operator: a box in which a system of equations has exactly one solution.

For equations F, a box X with midpoint m, and any matrix C, the operator is K = m − C F(m) + (1 − C F'(X)) (X − m). If K
lies in the interior of X, then F has exactly one zero in X, which lies in K (R. Krawczyk 1969; W. Tucker, Validated
Numerics, 2011). C is the inverse of F'(m), up to rounding. F' comes from Arb's power series: a number with the
coefficient 1 in first order carries a derivative through the code that computes the value.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any

from flint import arb, arb_mat, arb_series

from burridge_knopoff.proof.balls import ProofError, arithmetic

#: Equations: as many values as there are unknowns, as balls or as power series.
Equations = Callable[[Sequence[Any]], Sequence[Any]]

# Number of steps of Newton's method, each of which doubles the correct digits: from double precision to that of balls.
NEWTON_STEPS = 6
# After a step this small, the guess is more accurate than the remainders of the arcs.
SMALLEST_STEP = 2.0**-60
# Largest number of iterations, each of which squares the size of the box, down to rounding; the iteration ends when the
# box no longer halves.
MAX_SHRINKINGS = 12


@dataclass(frozen=True)
class Enclosure:
    """A proved solution.

    inner : balls that contain the solution, one for each unknown
    outer : balls in which the solution is unique
    """

    inner: tuple[arb, ...]
    outer: tuple[arb, ...]


def derivatives(function: Equations, at: Sequence[arb], chosen: Sequence[int] | None = None) -> arb_mat:
    """Return an enclosure of the derivatives of each value (rows) with respect to each unknown (columns).

    chosen : indices of the unknowns, if not all are needed
    """
    columns = []
    with arithmetic(2):
        for column in range(len(at)) if chosen is None else chosen:
            # Values that do not depend on the unknown are computed without series, in a third of the time.
            point = [arb_series([value, 1]) if k == column else value for k, value in enumerate(at)]
            columns.append([arb_series(value)[1] for value in function(point)])
    return arb_mat(columns).transpose()


def refine_guess(equations: Equations, guess: Sequence[Any], parameters: Sequence[arb] = ()) -> list[arb]:
    """Return a guess refined by Newton's method, as exact numbers; this proves nothing.

    parameters : arguments of the equations after the unknowns, exact numbers
    Raises ProofError if the derivatives cannot be inverted.
    """
    count = range(len(guess))
    with arithmetic():
        point = [arb(value).mid() for value in guess]
        for _ in range(NEWTON_STEPS):
            at = [*point, *parameters]
            step = solve_linear(submatrix(derivatives(equations, at, count), count, count), _column(equations(at)))
            point = [(value - step[k, 0]).mid() for k, value in enumerate(point)]
            if all(abs(step[k, 0].mid()) < SMALLEST_STEP for k in count):
                break
    return point


def enclose(
    equations: Equations, middle: Sequence[arb], radii: Sequence[Any], parameters: Sequence[arb] = ()
) -> Enclosure:
    """Return the proof that equations have exactly one solution in a box, and its enclosure.

    middle : of the box, exact numbers; radii : of the box, one for each unknown
    parameters : arguments of the equations after the unknowns, balls; the proof is for all values in them
    Raises ProofError if Krawczyk's operator does not map the box into its interior.
    """
    with arithmetic():
        outer = [value + arb(0, radius) for value, radius in zip(middle, radii, strict=True)]
        inverse = _inverse(equations, middle, parameters)
        inner = _krawczyk(equations, outer, parameters, inverse)
        for k, (box, mapped) in enumerate(zip(outer, inner, strict=True)):
            if not box.contains_interior(mapped):
                raise ProofError(f"unknown {k + 1}: got {mapped}, expected it in the interior of {box}")
        # The box is now much smaller, so that the derivatives at its midpoint are better than before.
        inverse = _inverse(equations, [ball.mid() for ball in inner], parameters)
        for _ in range(MAX_SHRINKINGS):
            before, image = inner, _krawczyk(equations, inner, parameters, inverse)
            # Both contain the solution, and so does their intersection.
            inner = [box.intersection(smaller) for box, smaller in zip(before, image, strict=True)]
            if all(2 * smaller.rad() > box.rad() for box, smaller in zip(before, inner, strict=True)):
                break
    return Enclosure(tuple(inner), tuple(outer))


def enclose_widest(
    equations: Equations, middle: Sequence[arb], radii: Sequence[float], parameters: Sequence[arb] = ()
) -> Enclosure:
    """Return the enclosure by `enclose` for the widest cube around a point for which the proof succeeds.

    radii : half-widths of the cubes, widest first
    Raises ProofError if all of them fail.
    """
    for radius in radii[:-1]:
        try:
            return enclose(equations, middle, [radius] * len(middle), parameters)
        except ProofError:
            continue
    return enclose(equations, middle, [radii[-1]] * len(middle), parameters)


def trial_radii(equations: Equations, middle: Sequence[arb], parameters: Sequence[arb]) -> list[arb]:
    """Return half-widths of a box that Krawczyk's operator may map into itself: twice the image of its midpoint."""
    with arithmetic():
        image = _krawczyk(equations, middle, parameters, _inverse(equations, middle, parameters))
        return [2 * abs(value - center).upper() for value, center in zip(image, middle, strict=True)]


def _krawczyk(equations: Equations, box: Sequence[arb], parameters: Sequence[arb], inverse: arb_mat) -> list[arb]:
    """Return Krawczyk's operator of a box, using the mean value theorem in the parameters too."""
    whole = [*box, *parameters]
    middle = [value.mid() for value in whole]
    unit = arb_mat([[int(i == k) for k in range(len(whole))] for i in range(len(box))])
    contraction = unit - inverse * derivatives(equations, whole)
    offset = _column([value - center for value, center in zip(whole, middle, strict=True)])
    step = contraction * offset - inverse * _column(equations(middle))
    return [middle[k] + step[k, 0] for k in range(len(box))]


def _inverse(equations: Equations, middle: Sequence[arb], parameters: Sequence[arb]) -> arb_mat:
    """Return an exact matrix that is approximately the inverse of the derivatives."""
    count = range(len(middle))
    derivative = derivatives(equations, [*middle, *(value.mid() for value in parameters)], count)
    exact = arb_mat([[derivative[i, k].mid() for k in count] for i in count])
    try:
        return arb_mat([[entry.mid() for entry in row] for row in exact.inv().tolist()])
    except ZeroDivisionError:
        raise ProofError("the derivatives of the equations cannot be inverted in the middle of the box") from None


def solve_linear(matrix: arb_mat, values: arb_mat) -> arb_mat:
    """Return an enclosure of the solutions of linear equations, for all matrices and values in their balls.

    Raises ProofError if some matrix in the balls may be singular.
    """
    with arithmetic():
        try:
            return matrix.solve(values, algorithm="precond")
        except ZeroDivisionError:
            raise ProofError("the derivatives of the equations cannot be inverted") from None


def submatrix(matrix: arb_mat, rows: Sequence[int], columns: Sequence[int]) -> arb_mat:
    """Return some rows and columns of a matrix."""
    return arb_mat([[matrix[i, k] for k in columns] for i in rows])


def _column(values: Sequence[Any]) -> arb_mat:
    return arb_mat([[value] for value in values])
