"""Krawczyk's operator on systems whose solutions are known."""

import math

import pytest
from flint import arb, arb_mat

from burridge_knopoff.proof.balls import ProofError, arithmetic, width
from burridge_knopoff.proof.krawczyk import (
    derivatives,
    enclose,
    enclose_widest,
    refine_guess,
    solve_linear,
    trial_radii,
)

RADII = [2.0**-k for k in range(8, 30)]


def circle_and_line(unknown):
    """x² + y² = 2 and x = y: solved by (1, 1) and (−1, −1)."""
    x, y = unknown
    return [x * x + y * y - 2, x - y]


def root_of(unknown):
    """x² = c."""
    x, c = unknown
    return [x * x - c]


def test_a_solution_is_enclosed_and_the_only_one_in_its_box():
    enclosure = enclose(circle_and_line, [arb(1.01), arb(0.98)], [0.3, 0.3])
    for ball, box in zip(enclosure.inner, enclosure.outer, strict=True):
        assert ball.contains(1)
        assert width(ball) < 1e-40
        assert 0.6 <= width(box) < 0.6001
        assert not box.contains(-1)


@pytest.mark.parametrize(("middle", "radius"), [(1.0, 2.5), (1.5, 0.2), (1.3, 0.2), (1.0, 1.5)])
def test_boxes_without_a_provable_single_solution_are_refused(middle, radius):
    """Boxes with both solutions, with none, with one nearby, and one box too wide for the proof."""
    with pytest.raises(ProofError, match=r"^unknown \d:"):
        enclose(circle_and_line, [arb(middle)] * 2, [radius] * 2)


def test_a_double_solution_is_refused():
    with pytest.raises(ProofError, match="inverted"):
        enclose(lambda unknown: [unknown[0] * unknown[0]], [arb(0)], [0.1])
    with pytest.raises(ProofError):
        enclose_widest(lambda unknown: [unknown[0] * unknown[0]], [arb(1e-30)], [0.1, 1e-6])


def test_two_nearby_solutions_are_distinguished():
    """x² = 1e-8: the widest cube with a proof contains only one root."""
    enclosure = enclose_widest(lambda unknown: [unknown[0] * unknown[0] - 1e-8], [arb(1e-4)], RADII)
    assert enclosure.inner[0].overlaps(arb(1e-8).sqrt())
    assert not enclosure.outer[0].contains(-1e-4)
    assert width(enclosure.outer[0]) > 5e-5


def test_the_proof_is_for_every_value_of_a_parameter():
    with arithmetic():
        c = arb(2, 0.01)
        enclosure = enclose(root_of, [arb(1.41421356)], trial_radii(root_of, [arb(1.41421356)], [c]), [c])
        for value in (1.99, 2.0, 2.01):
            assert enclosure.inner[0].contains(arb(value).sqrt())
    # The true range of the roots is 0.00707 wide.
    assert width(enclosure.inner[0]) < 0.0075


def test_derivatives_are_enclosed():
    with arithmetic():
        point = [arb(1, 0.125), arb(2)]
        matrix = derivatives(lambda z: [z[0] * z[1].exp(), (z[0] / z[1]).sin()], point)
        for x in (0.875, 1.0, 1.125):
            x = arb(x)
            assert matrix[0, 0].overlaps(arb(2).exp())
            assert matrix[0, 1].contains(x * arb(2).exp())
            assert matrix[1, 0].contains((x / 2).cos() / 2)
            assert matrix[1, 1].contains(-(x / 4) * (x / 2).cos())


def test_a_guess_is_refined_to_all_digits():
    (root,) = refine_guess(root_of, [1.4], [arb(2)])
    with arithmetic():
        assert abs(root - arb(2).sqrt()) < 1e-55
    assert float(root) == math.sqrt(2.0)
    with pytest.raises(ProofError, match="inverted"):
        refine_guess(root_of, [0.0], [arb(2)])


def test_equations_whose_matrix_may_be_singular_are_refused():
    with arithmetic():
        solution = solve_linear(arb_mat([[2, 0], [0, arb(1, 0.5)]]), arb_mat([[1], [1]]))
        assert solution[1, 0].contains(arb(2))
        assert solution[1, 0].contains(arb(2) / 3)
        with pytest.raises(ProofError, match="inverted"):
            solve_linear(arb_mat([[1, 1], [1, arb(1, 1e-30)]]), arb_mat([[1], [2]]))
