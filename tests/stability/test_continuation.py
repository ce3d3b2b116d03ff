"""Branches of attractors along a, and the numbers that two laws share."""

import numpy as np
import pytest

from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.continuation import branches, same_numbers
from tests.stability.stand_in import stand_in


def test_branches_at_a_pitchfork():
    """The synchronized branch ends, its mirror pair begins, and another attractor goes on unharmed."""
    before = [stand_in(Symmetry.SYNCHRONIZED, 0.0, 0), stand_in(Symmetry.SYMMETRIC, 0.14, 1)]
    pair = [stand_in(Symmetry.ASYMMETRIC, 0.01, 1, -1.0), stand_in(Symmetry.ASYMMETRIC, 0.01, 0, 1.0)]
    after = [*pair, stand_in(Symmetry.SYMMETRIC, 0.15, 2)]
    upward = [np.array([0, 2]), np.array([1, 0, 2]), np.array([-1, -1, -1])]
    downward = [np.array([-1, -1]), np.array([0, 0, 1]), np.array([1, 0, 2])]
    later = [stand_in(Symmetry.ASYMMETRIC, 0.01, 1, 1.0), stand_in(Symmetry.ASYMMETRIC, 0.01, 0, -1.0), after[2]]
    branch, side = branches([before, after, later], upward, downward)
    assert [list(row) for row in branch] == [[0, 1], [2, 2, 1], [2, 2, 1]]
    assert [list(row) for row in side] == [[0, 0], [-1, 1, 0], [1, -1, 0]]


@pytest.mark.parametrize(
    ("upward", "downward", "expected"),
    [
        ([0, 0], [1], [[1, 2], [2]]),  # hysteresis: going up leads from A to B, going down from B to B
        ([0, -1], [1], [[1, 2], [3]]),  # not reached back
        ([0, 0], [-1], [[1, 2], [3]]),
        ([0, 0], [0], [[1, 2], [1]]),
    ],
)
def test_an_attractor_that_is_not_reached_back_is_a_new_branch(upward, downward, expected):
    first = [stand_in(Symmetry.SYMMETRIC, 0.1, 0), stand_in(Symmetry.SYMMETRIC, 0.2, 1)]
    second = [stand_in(Symmetry.SYMMETRIC, 0.21, 0)]
    up, down = [np.array(upward), np.array([-1])], [np.array([-1, -1]), np.array(downward)]
    branch, _ = branches([first, second], up, down)
    assert [list(row) for row in branch] == expected


def test_branches_are_numbered_by_their_mean_distance():
    """Of one a in that order; two that come from one share its number only once."""
    first = [stand_in(Symmetry.SYMMETRIC, mean, k) for k, mean in enumerate((0.3, 0.1, 0.2))]
    second = [stand_in(Symmetry.SYMMETRIC, mean, k) for k, mean in enumerate((0.31, 0.32))]
    up, down = [np.array([0, 0, 1]), np.array([-1, -1])], [np.full(3, -1), np.array([0, 0])]
    branch, side = branches([first, second], up, down)
    assert [list(row) for row in branch] == [[3, 1, 2], [3, 4]]
    assert not np.concatenate(side).any()
    # Synchrony is branch 0, and what comes from it is not.
    still = [stand_in(Symmetry.SYNCHRONIZED, 0.0, 0)]
    branch, _ = branches([still, first[:1], still], [np.array([0])] * 3, [np.array([0])] * 3)
    assert [list(row) for row in branch] == [[0], [1], [0]]


def test_branches_of_two_laws_that_look_alike_carry_one_number():
    """By ⟨J⟩ and by which blocks stick, at most values of a; the rest is numbered on."""
    free, middle = (True, False, True), (True, True, True)
    first = {
        0: {0: (0.0, middle)},
        1: dict.fromkeys(range(4), (0.14, middle)),
        2: dict.fromkeys(range(3), (0.18, free)),
    }
    second = {
        0: {0: (0.0, middle)},
        1: dict.fromkeys(range(3), (0.181, free)),
        2: dict.fromkeys(range(4), (0.142, middle)),
        3: {1: (0.141, free), 2: (0.3, middle)},
    }
    assert same_numbers(first, second, 0.01, 2) == {0: 0, 1: 2, 2: 1, 3: 3}
    assert same_numbers(first, first, 0.01, 2) == {0: 0, 1: 1, 2: 2}
    assert same_numbers({}, second, 0.01, 0) == {0: 0, 1: 1, 2: 2, 3: 3}
    # Numbers that a law between them has taken are left to it.
    assert same_numbers(first, second, 0.01, 5) == {0: 0, 1: 2, 2: 1, 3: 6}
