"""Steps along a branch that keep its stops, the approach to a corner, and the continuation beyond it."""

from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, OrbitError, Symmetry
from burridge_knopoff.model.own_units import OwnUnits
from burridge_knopoff.periodic_orbits import border_collision
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit
from tests.periodic_orbits.stand_in import only


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


@pytest.mark.parametrize(
    ("stop_counts", "simpler", "ahead", "made"),
    [
        ((1, 2), None, np.inf, True),
        ((2, 1), None, np.inf, False),
        (None, None, np.inf, False),  # none is found
        # A simpler orbit ends a branch only where the branch joins it.
        ((1, 2), "simpler", 0.19, True),
        ((1, 2), "simpler", 0.21, False),
        ((1, 2), "simpler", np.inf, False),
    ],
)
def test_a_step_keeps_the_stops(monkeypatch, stop_counts, simpler, ahead, made):
    ahead_point = BranchOrbit(SimpleNamespace(stop_counts=stop_counts), np.zeros(4), line_along_a(Chain(1)))

    def step(point, length):
        if stop_counts is None:
            raise OrbitError("none")
        return ahead_point

    monkeypatch.setattr(border_collision, "step_along", step)
    monkeypatch.setattr(border_collision, "reduced_orbit", lambda orbit: simpler)
    monkeypatch.setattr(border_collision, "_distance_to_branch_point", lambda way: ahead)
    accepted = border_collision.smooth_step([SimpleNamespace(orbit=SimpleNamespace(stop_counts=(1, 2)))], 0.1)
    assert (accepted is not None) == made
    if made:
        assert accepted.orbit is ahead_point.orbit
        assert accepted.reduced_orbit == simpler


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


@dataclass(frozen=True)
class Place:
    """A point of a straight branch with a corner at 8e-4; the grazing distance is a power of the remaining length."""

    orbit: float
    length: float = 1e-3
    reduced_orbit: str | None = None
    distance_to_grazing: float = np.nan
    power: int = 1
    corner: float = 8e-4

    @property
    def grazing_distances(self):
        return SimpleNamespace(values=lambda: np.array([(self.corner - self.orbit) ** self.power, np.inf]))


@pytest.fixture
def approach(monkeypatch):
    """Return the approach to a corner from 0, and the attempted steps; steps beyond the corner fail."""

    def come(length, fails=lambda tried: False, joint=np.inf, **fields):
        tried = []

        def step(way, length):
            tried.append(length)
            assert len(way) >= 2
            place = way[-1].orbit + length
            if place > way[-1].corner or fails(len(tried)):
                return None
            return replace(way[-1], orbit=place, length=length, reduced_orbit="simpler" if place > joint else None)

        monkeypatch.setattr(border_collision, "smooth_step", step)
        way = border_collision.approach_grazing([Place(place, **fields) for place in (-2e-3, -1e-3, 0.0)], length)
        return way, tried

    return come


def test_each_step_to_a_corner_leaves_three_percent_of_the_length(approach):
    """The first step is a hundredth of the length, and the last point is within 1e-10 of the corner."""
    way, tried = approach(1e-3)
    left = 7.9e-4 * 0.03 ** np.arange(6)
    assert tried == pytest.approx([1e-5, *(0.97 * left[:-1])], rel=1e-4, abs=0.0)
    assert [point.orbit for point in way] == pytest.approx(8e-4 - left, rel=1e-9)
    assert np.isnan([point.distance_to_grazing for point in way[:-1]]).all()
    assert way[-1].distance_to_grazing == pytest.approx(1.92e-11, rel=1e-2, abs=0.0)


def test_failed_steps_are_repeated_with_a_shorter_length(approach):
    """The following steps are a smaller share of the predicted length."""
    _, tried = approach(1e-3, lambda tried: tried in (1, 2))
    left = np.array([8e-4 - 1.6e-6])
    for share in (0.3104, 0.6208, 0.97):
        left = np.append(left, (1.0 - share) * left[-1])
    assert tried[:6] == pytest.approx([1e-5, 4e-6, 1.6e-6, *(np.array([0.3104, 0.6208, 0.97]) * left[:3])], rel=1e-6)


@pytest.mark.parametrize(("length", "count"), [(1e-3, 13), (1.0, 15)])
def test_the_approach_to_a_corner_ends_if_steps_fail(approach, length, count):
    """The approach ends if steps become shorter than 1e-10, or after fifteen failures."""
    way, tried = approach(length, lambda tried: True)
    assert way == []
    assert tried == pytest.approx([0.01 * length * 0.4**k for k in range(count)], rel=1e-9, abs=0.0)


def test_the_approach_to_a_corner_ends_if_it_comes_no_closer(approach):
    """A distance that falls like a fourth power predicts a quarter of the remaining length."""
    way, tried = approach(1e-3, power=4)
    assert len(tried) == len(way) == 32
    assert not [point for point in way if point.distance_to_grazing > 0.0]


def test_no_corner_is_searched_for_beyond_the_given_length(approach):
    way, tried = approach(1e-3, corner=1.0)
    assert tried == pytest.approx([1e-5, 1e-3])
    assert [point.orbit for point in way] == pytest.approx([1e-5, 1.01e-3])


def test_the_approach_to_a_corner_ends_where_the_branch_joins_another_one(approach):
    way, tried = approach(1e-3, joint=5e-4)
    assert [point.reduced_orbit for point in way] == [None, "simpler"]
    assert len(tried) == 2


@pytest.fixture
def turn(monkeypatch):
    """Return the orbit found beyond a corner if successive steps lead to orbits with these stops."""

    def turned(signatures, drops=False, simple=(), lost=(), here=(1, 2)):
        tried, tangents, left = [], [], iter(signatures)

        def orbit_of(model, state, time, symmetry):
            tangents.append((model, *state.position))
            if len(tangents) in lost:
                raise OrbitError("none")
            return len(tangents)

        def step(point, length, tangent):
            tried.append((length, *tangent))
            stop_counts = next(left)
            if stop_counts is None:
                raise OrbitError("none")
            return SimpleNamespace(orbit=SimpleNamespace(stop_counts=stop_counts))

        monkeypatch.setattr(border_collision, "has_friction_drop", lambda model: drops)
        monkeypatch.setattr(border_collision, "orbit_of", orbit_of)
        monkeypatch.setattr(border_collision, "tangent_of", lambda number, line: np.array([number, 0.0]))
        monkeypatch.setattr(border_collision, "step_along", step)
        monkeypatch.setattr(
            border_collision, "reduced_orbit", lambda orbit: "one" if orbit.stop_counts in simple else None
        )
        reference = ChainState(np.array([0.5, 0.25]), np.zeros(2), np.zeros(2, dtype=bool))
        attributes = {"model": SimpleNamespace(blocks=2), "return_time": 1.0, "symmetry": None}
        orbit = SimpleNamespace(reference=reference, stop_counts=here, **attributes)
        line = SimpleNamespace(
            coordinate=lambda model: 2e-6, model=lambda model, a: a, lower_bound=0.0, units=OwnUnits()
        )
        point = SimpleNamespace(orbit=orbit, line=line, tangent=np.array([4.0, -2.0, 0.0, 0.0, 0.0, -1.0]))
        orbit_beyond = border_collision.switch_branch(point)
        return orbit_beyond and orbit_beyond.orbit.stop_counts, tried, tangents

    return turned


def test_beyond_a_corner_the_orbit_has_other_stops(turn):
    """The orbit may lie on either side; it must have stops that differ from before and not repeat a simpler orbit."""
    none, same, twice = (0, 0), (1, 2), (2, 2)
    stops, tried, tangents = turn([None, same, none, twice, (1, 1)], simple=(twice,))
    assert stops == (1, 1)
    assert tried == [(1e-5, 1, 0), (1e-5, -1, 0), (1e-4, 1, 0), (1e-4, -1, 0), (1e-6, 1, 0)]
    # The tangent is that of an orbit slightly farther on, at an a that is not negative.
    assert tangents == [(0.0, pytest.approx(0.50001), pytest.approx(0.249995))]
    assert turn([], drops=True) == (None, [], [])
    assert turn([(1, 1)])[0] == (1, 1)


@pytest.mark.parametrize(
    ("beyond", "continues"),
    [((3, 2, 3), True), ((2, 2, 2), True), ((3, 2, 2), False), ((2, 2, 3), False), ((0, 0, 0), False)],
)
def test_which_branches_continue_from_a_symmetric_corner(turn, beyond, continues):
    """A branch with its own stops or none does not continue: less symmetric orbits begin at such a corner."""
    assert turn([beyond] * 24, here=(2, 2, 3))[0] == (beyond if continues else None)


def test_a_branch_whose_other_side_is_not_found_ends(turn):
    stops, tried, tangents = turn([None] * 24)
    assert stops is None
    assert tried == [
        (length, sign * k, 0) for k in (1, 2, 3) for length in (1e-5, 1e-4, 1e-6, 1e-7) for sign in (1, -1)
    ]
    assert [position for _, position, _ in tangents] == pytest.approx([0.50001, 0.5001, 0.500001], abs=1e-12)
    assert [a for a, *_ in tangents] == pytest.approx([0.0, 0.0, 1e-6], abs=1e-12)
    stops, tried, _ = turn([(1, 1)], lost=(1, 2))
    assert (stops, tried) == ((1, 1), [(1e-5, 3, 0)])
