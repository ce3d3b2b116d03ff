"""Balls, which are real numbers with an error bound in Arb, and their conversion to doubles and text.

Every operation of Arb returns a ball that contains the results for all numbers in its operands; see
F. Johansson, Arb: efficient arbitrary-precision midpoint-radius interval arithmetic, IEEE Trans. Comput. 66 (2017).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

from flint import arb, ctx

#: Bits of the midpoints. About 20 of them are lost over a period of an orbit.
BITS = 192


class ProofError(ValueError):
    """A statement that could not be proved; the message, of one line, says which statement and where."""


@contextmanager
def arithmetic(terms: int = 2) -> Iterator[None]:
    """Compute with BITS bits, and truncate power series after a number of terms."""
    before = ctx.prec, ctx.cap
    ctx.prec, ctx.cap = BITS, terms
    try:
        yield
    finally:
        ctx.prec, ctx.cap = before


def ball_between(low: arb | float, high: arb | float) -> arb:
    """Return a ball that contains all numbers from low to high."""
    return arb(low).union(arb(high))


def decimal(numerator: int, denominator: int) -> arb:
    """Return a ball that contains a fraction and the nearest double: the number as written and as computed with."""
    return (arb(numerator) / denominator).union(arb(numerator / denominator))


def limits(ball: arb) -> tuple[float, float]:
    """Return the closest doubles that enclose a ball.

    Raises ProofError for a ball that is not finite.
    """
    if not ball.is_finite():
        raise ProofError(f"got {ball}, expected a finite ball")
    low, high = float(ball.lower()), float(ball.upper())
    while not arb(low) <= ball.lower():
        low = math.nextafter(low, -math.inf)
    while not arb(high) >= ball.upper():
        high = math.nextafter(high, math.inf)
    return low, high


def width(ball: arb) -> float:
    """Return a double that is not smaller than the width of a ball."""
    return limits(2 * ball.rad())[1]


def digits(ball: arb) -> str:
    """Return a ball as Arb prints it: a decimal of at most 40 digits and its error, «[0.0869 +/- 1.2e-50]»."""
    text: str = ball.str(40, more=False, radius=True)
    return text
