"""Steps along a branch that keep its stops, and the approach to a corner, of maps in closed form."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, Symmetry
from burridge_knopoff.periodic_orbits import border_collision
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.pseudo_arclength import begin_branch, step_along
from tests import normal_forms
from tests.normal_forms import CRITICAL, orbit_at
from tests.periodic_orbits.stand_in import only

LINE = line_along_a(Chain(2))
#: Length along the branch x = 2μ, in which x has the weight 0.01, per change of μ.
PER_MU = np.sqrt(1.04)


def start_at(mu, **fields):
    """Return the orbit x = 2μ < 0 of x → x/2 + μ, with the border x = 0, and the tangent upward."""
    form = replace(normal_forms.border_collision(0.5, -0.4), **fields)
    return begin_branch(orbit_at(form, mu, 2.0 * mu), True, LINE)


@pytest.mark.parametrize(
    ("values", "length", "expected"),
    [
        ((0.5, 0.25), 0.1, 0.1),
        ((-0.3, -0.2), 0.1, 0.2),
        ((0.2, 0.3), 0.1, np.inf),
        ((0.2, 0.2), 0.1, np.inf),
        ((0.2,), 0.1, np.inf),
    ],
)
def test_a_branch_point_lies_where_a_multiplier_reaches_1(values, length, expected):
    orbit = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC)
    way = [SimpleNamespace(orbit=orbit, multipliers=only(1.0 + value), length=length) for value in values]
    assert border_collision._distance_to_branch_point(way) == pytest.approx(expected)
    # Earlier points of the path do not matter.
    ahead = border_collision._distance_to_branch_point(
        [SimpleNamespace(orbit=orbit, multipliers=only(10.0), length=9.0), *way]
    )
    assert ahead == pytest.approx(expected) or len(way) == 1


@pytest.mark.parametrize(("length", "is_made"), [(5e-4, True), (2e-3, False)])
def test_a_step_keeps_the_stops(length, is_made):
    """The border is within 1.02e-3."""
    step = border_collision.smooth_step([start_at(-1e-3)], length)
    assert (step is not None) == is_made
    if step is not None:
        assert (step.length, step.orbit.stop_counts) == (length, (0, 1))


def test_a_step_to_where_there_is_no_law_is_not_made():
    point = start_at(-1e-3, exists=lambda mu: mu <= -8e-4)
    assert border_collision.smooth_step([point], 1e-4) is not None
    assert border_collision.smooth_step([point], 4e-4) is None


@pytest.mark.parametrize(
    ("before", "here", "expected"),
    [
        ((0.5, 0.9), (0.4, 0.6), 0.2),
        ((0.5, 0.9), (0.6, 0.6), 0.2),
        # A distance that grows, stays constant or is infinite predicts no grazing.
        ((0.5, np.inf), (0.6, np.inf), np.inf),
        ((0.5, 0.3), (0.5, 0.5), np.inf),
        ((0.5, np.inf), (0.4, 0.2), 0.4),
    ],
)
def test_a_decreasing_grazing_distance_predicts_a_grazing(before, here, expected):
    points = [
        SimpleNamespace(
            grazing_distances=SimpleNamespace(values=lambda distances=distances: np.array(distances)), length=0.1
        )
        for distances in (before, here)
    ]
    assert border_collision.distance_to_grazing(*points) == pytest.approx(expected)


def approach(left, length, **fields):
    """Return the approach to a border that is a length away, and the remaining lengths after each step."""
    first = start_at(-(left + 1e-3) / PER_MU, **fields)
    path = [first, step_along(first, 1e-3)]
    steps = border_collision.approach_grazing(path, length)
    return steps, left - np.cumsum([point.length for point in steps])


def test_each_step_to_a_corner_leaves_three_percent_of_the_length():
    """The first step is a hundredth of the length, and the last point is within 1e-10 of the corner."""
    steps, left = approach(8e-4, 1e-3)
    assert left == pytest.approx(7.9e-4 * 0.03 ** np.arange(6), rel=1e-3, abs=1e-12)
    assert np.isnan([point.distance_to_grazing for point in steps[:-1]]).all()
    assert steps[-1].distance_to_grazing == pytest.approx(1.92e-11, rel=1e-2, abs=0.0)
    assert -steps[-1].value + CRITICAL == pytest.approx(1.92e-11 / PER_MU, rel=1e-2, abs=0.0)


def test_failed_steps_are_repeated_with_a_shorter_length():
    """Steps of 1e-5 and 4e-6 are too long. The next ones are a smaller share of the predicted length."""
    _, left = approach(2e-6, 1e-3)
    assert left[0] == pytest.approx(0.4e-6, rel=1e-6)
    assert left[1:4] / left[:3] == pytest.approx(1.0 - np.array([0.3104, 0.6208, 0.97]), rel=1e-4)


def test_the_approach_to_a_corner_ends_if_steps_fail():
    """There is no law ahead."""
    assert approach(8e-4, 1e-3, exists=lambda mu: mu <= -8e-4 / PER_MU + 1e-12)[0] == []


def test_the_approach_to_a_corner_ends_if_it_comes_no_closer():
    """A distance that falls like a fourth power predicts a quarter of the remaining length."""
    steps, _ = approach(8e-4, 1e-3, borders=lambda x, mu: np.array([x[0] ** 3 * abs(x[0]), np.inf]))
    assert len(steps) == 32
    assert not any(point.is_grazing for point in steps)


def test_no_corner_is_searched_for_beyond_the_given_length():
    steps, _ = approach(5e-2, 1e-3)
    assert [point.length for point in steps] == pytest.approx([1e-5, 1e-3])
