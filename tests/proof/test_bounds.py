"""Signs over whole arcs: every dip between samples is detected, and roots at the ends are excluded."""

import math

import pytest
from flint import arb

from burridge_knopoff.proof.balls import ProofError, arithmetic
from burridge_knopoff.proof.bounds import bounds, check_positive, jet


def touching(height, at=1 / 3):
    """Return a parabola with a given minimum at t = 1/3."""
    return lambda t: (t - at) * (t - at) + height


def test_a_function_that_comes_near_to_0_is_positive():
    check_positive(touching(1e-9), arb(1))
    check_positive(lambda t: 1 + t - t, arb(1))


@pytest.mark.parametrize("height", [-1e-9, 0.0, -0.1])
def test_a_dip_of_any_depth_is_detected(height):
    """1e-9 below 0 for 6e-5 of the time."""
    with pytest.raises(ProofError, match=r"time 0\.\d+ of an arc"):
        check_positive(touching(height), arb(1))


def test_the_message_has_the_time_of_the_dip():
    with pytest.raises(ProofError) as error:
        check_positive(touching(-1e-9, 0.7), arb(1))
    assert float(str(error.value).split()[3]) == pytest.approx(0.7, abs=1e-4)


def started(t):
    """t² (2 − t): a start at 0, a stop at 2."""
    return t * t * (2 - t)


def test_known_roots_at_the_ends_are_not_events():
    check_positive(started, arb(2), root_at_start=True, root_at_end=True)
    check_positive(started, arb(1.99), root_at_start=True)
    check_positive(lambda t: 2 - t, arb(2), root_at_end=True)


@pytest.mark.parametrize(
    ("function", "length", "known"),
    [
        (started, 2.0, {"root_at_start": True}),
        (started, 2.0, {"root_at_end": True}),
        (started, 2.001, {"root_at_start": True}),
        (lambda t: -t * t, 1.0, {"root_at_start": True}),
        # A start at which the second derivative also vanishes is undecided.
        (lambda t: t * t * t, 1.0, {"root_at_start": True}),
        # A known root where the function rises through 0: it was negative before.
        (lambda t: t - 1, 1.0, {"root_at_end": True}),
        # These are not roots.
        (lambda t: 1 + t, 1.0, {"root_at_start": True}),
        (lambda t: t + t * t, 1.0, {"root_at_start": True}),
        (lambda t: 2 - t, 1.0, {"root_at_end": True}),
        # A grazing just before the end.
        (lambda t: (1 - t) * ((t - 0.999) * (t - 0.999) - 1e-12), 1.0, {"root_at_end": True}),
        # A grazing just after the start.
        (lambda t: t * t * ((t - 0.001) * (t - 0.001) - 1e-12), 1.0, {"root_at_start": True}),
    ],
)
def test_other_roots_prevent_the_proof(function, length, known):
    with pytest.raises(ProofError):
        check_positive(function, arb(length), **known)


def test_the_proof_is_for_all_lengths_of_a_ball():
    with arithmetic():
        near, wide = arb(2, 1e-9), arb(2, 0.5)
    # Wherever the true end is, the function falls to 0 there.
    check_positive(started, near, root_at_start=True, root_at_end=True)
    with pytest.raises(ProofError):
        check_positive(touching(-1e-9, 2.4), wide)


def test_a_jet_encloses_a_function_and_its_derivatives_at_all_times():
    with arithmetic():
        value, slope, curvature = jet(lambda t: (2 * t).sin(), arb(0.5, 0.1))
        for time in (0.4001, 0.5, 0.5999):
            assert value.contains((2 * arb(time)).sin())
            assert slope.contains(2 * (2 * arb(time)).cos())
            assert curvature.contains(-4 * (2 * arb(time)).sin())


def test_bounds_enclose_all_values_tightly():
    with arithmetic():
        ball = bounds(lambda t: t.sin(), arb(math.pi))
        assert ball.contains(1)
        assert ball.contains(0)
        assert ball < 1.06
        assert ball > -0.06
