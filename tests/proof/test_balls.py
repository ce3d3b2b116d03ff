"""Conversion of balls to doubles and text: rounded outward, and no wider than necessary."""

import math
from fractions import Fraction

import pytest
from flint import arb, ctx

from burridge_knopoff.proof.balls import BITS, ProofError, arithmetic, decimal, digits, limits, width


@pytest.mark.parametrize(("numerator", "denominator"), [(1, 3), (-1, 3), (2, 3), (8, 100), (1, 4), (-5, 7), (0, 1)])
def test_limits_are_the_nearest_doubles_around(numerator, denominator):
    with arithmetic():
        low, high = limits(arb(numerator) / denominator)
    exact = Fraction(numerator, denominator)
    assert Fraction(low) <= exact <= Fraction(high)
    assert math.nextafter(low, math.inf) >= high
    assert (low == high) == (exact == Fraction(float(exact)))


def test_limits_contain_both_ends_of_a_wide_ball():
    with arithmetic():
        low, high = limits(arb(1, 0.1))
    assert Fraction(low) <= Fraction(1) - Fraction(0.1)
    assert Fraction(high) >= Fraction(1) + Fraction(0.1)
    assert (low, high) == pytest.approx((0.9, 1.1), abs=1e-8)


def test_a_number_without_a_bound_is_refused():
    with pytest.raises(ProofError, match="nan"):
        limits(arb("nan"))


def test_a_decimal_and_its_double_are_in_one_ball():
    with arithmetic():
        ball = decimal(8, 100)
        assert ball.contains(arb(8) / 100)
        assert ball.contains(arb(0.08))
    assert 0.0 < width(ball) < 1e-17


def test_digits_state_their_error():
    with arithmetic():
        text = digits(arb(2).sqrt())
        assert text.startswith("[1.41421356237309504880168872420969807857")
        assert arb(text).contains(arb(2).sqrt())
        assert width(arb(text)) < 1e-38


def test_precision_is_restored():
    before = ctx.prec, ctx.cap
    with arithmetic(5):
        assert (ctx.prec, ctx.cap) == (BITS, 5)
    assert (ctx.prec, ctx.cap) == before
    with pytest.raises(ZeroDivisionError), arithmetic(5):
        arb(1) / (1 // 0)
    assert (ctx.prec, ctx.cap) == before
