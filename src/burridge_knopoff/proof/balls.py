"""Balls: real numbers with a bound on their error, as Arb computes with them, and how they leave this room.

Every operation of Arb returns a ball that holds all values of the operation on numbers from its operands: see
F. Johansson, Arb: efficient arbitrary-precision midpoint-radius interval arithmetic, IEEE Trans. Comput. 66 (2017).
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from contextlib import contextmanager

from flint import arb, ctx

#: Bits of the midpoints. An orbit loses about 20 of them on its way through a period.
BITS = 192


class ProofError(ValueError):
    """What was to be proved is not proved; the message says what and where, in one line."""


@contextmanager
def arithmetic(terms: int = 2) -> Iterator[None]:
    """Compute with BITS bits, and with power series cut off after a number of terms."""
    before = ctx.prec, ctx.cap
    ctx.prec, ctx.cap = BITS, terms
    try:
        yield
    finally:
        ctx.prec, ctx.cap = before


def around(low: arb | float, high: arb | float) -> arb:
    """Return a ball that holds all numbers from low to high."""
    return arb(low).union(arb(high))


def decimal(numerator: int, denominator: int) -> arb:
    """Return a ball that holds a fraction and the double nearest to it: what is written, and what is computed with."""
    return (arb(numerator) / denominator).union(arb(numerator / denominator))


def limits(ball: arb) -> tuple[float, float]:
    """Return doubles between which a ball lies: the nearest ones that do.

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
    """Return a double that is no less than the width of a ball."""
    return limits(2 * ball.rad())[1]


def digits(ball: arb) -> str:
    """Return a ball as Arb prints it: a decimal of 40 digits at most, and how far off, «[0.0869 +/- 1.2e-50]»."""
    text: str = ball.str(40, more=False, radius=True)
    return text
