"""Which orbits belong to a segment, tested with stand-ins."""

from types import SimpleNamespace

import pytest

from burridge_knopoff.periodic_orbits.branch_segment import CLOSE, BranchSegment, HalfBranch, _stop_after_unstable
from burridge_knopoff.periodic_orbits.symmetry import Symmetry


def an_orbit(a, period=1.0, stop_counts=(1, 2, 1), symmetry=Symmetry.ASYMMETRIC, mean_distance=0.2):
    model = SimpleNamespace(scale=1.0)
    return SimpleNamespace(
        a=a, period=period, stop_counts=stop_counts, symmetry=symmetry, mean_distance=mean_distance, model=model
    )


def point(a, *, unstable=0, length=0.01, is_grazing=False, **look):
    orbit = an_orbit(a, **look)
    multipliers = SimpleNamespace(unstable_count=unstable)
    return SimpleNamespace(orbit=orbit, multipliers=multipliers, length=length, is_grazing=is_grazing)


def half(*points, end=None):
    """Return a half branch whose stable orbits end at an a, if it is given."""
    branch = HalfBranch([point(0.1, length=0.0), *points])
    bifurcations = [
        SimpleNamespace(a=a, loses_stability=lost) for a, lost in ((0.1, False), (end, True)) if a is not None
    ]
    vars(branch)["bifurcations"] = bifurcations
    return branch


def places(points):
    return [item.orbit.a for item in points]


def test_stable_orbits_end_at_the_first_loss_of_stability():
    """This holds even if the branch is stable again beyond its end; an unknown end does not limit it."""
    downward = half(point(0.09), point(0.07, unstable=1), point(0.05))
    upward = half(point(0.11), point(0.13, unstable=1), point(0.15))
    ended = half(*downward.orbits[1:], end=0.08), half(*upward.orbits[1:], end=0.12)
    assert [part.end and part.end.a for part in (*ended, downward, upward)] == [0.08, 0.12, None, None]
    for low, high, expected in (
        (downward, upward, [0.05, 0.09, 0.1, 0.11, 0.15]),
        (ended[0], upward, [0.09, 0.1, 0.11, 0.15]),
        (downward, ended[1], [0.05, 0.09, 0.1, 0.11]),
        (*ended, [0.09, 0.1, 0.11]),
    ):
        assert places(BranchSegment(low, high).stable_orbits) == expected


def test_orbits_of_the_approach_to_a_corner_are_not_drawn():
    near = 0.5 * CLOSE
    whole = BranchSegment(
        half(point(0.09), point(0.089, length=near)),
        half(point(0.11, length=near), point(0.12, length=near, is_grazing=True)),
    )
    assert places(whole.drawn_orbits) == [0.09, 0.1, 0.12]


@pytest.mark.parametrize(
    ("a", "period", "stop_counts", "expected"),
    [
        (0.105, 1.05, (1, 2, 1), True),
        (0.105, 1.0521, (1, 2, 1), False),
        (0.105, 1.05, (1, 3, 1), False),
        # Between the last stable orbit and the end, and beyond.
        (0.12, 1.1, (1, 2, 1), True),
        (0.126, 1.1, (1, 2, 1), False),
        (0.084, 1.0, (1, 2, 1), True),
        (0.079, 1.0, (1, 2, 1), False),
    ],
)
def test_a_segment_contains_orbits_by_a_stops_and_period(a, period, stop_counts, expected):
    whole = BranchSegment(half(point(0.09), end=0.08), half(point(0.11, period=1.1), end=0.125))
    orbit = an_orbit(a, period, stop_counts)
    assert whole.contains(orbit, 1e-3) is expected
    assert BranchSegment(HalfBranch([]), HalfBranch([])).contains(orbit, 1e-3) is False
    mirrored = an_orbit(a, period, stop_counts[::-1])
    assert whole.contains(mirrored, 1e-3) is expected


@pytest.mark.parametrize(
    ("look", "expected"),
    [
        ({"mean_distance": 0.29}, True),
        ({"mean_distance": 0.42}, False),
        ({"mean_distance": 0.08}, False),
        ({"symmetry": Symmetry.SYMMETRIC}, False),
    ],
)
def test_a_segment_does_not_contain_another_orbit_of_equal_stops_and_period(look, expected):
    """In a ring the rotated images of two orbits may share stops and period."""
    whole = BranchSegment(half(point(0.09)), half(point(0.11, mean_distance=0.3)))
    assert whole.contains(an_orbit(0.105, **look), 1e-3) is expected


@pytest.mark.parametrize(("off", "scale", "expected"), [(9e-4, 1.0, True), (1.1e-3, 1.0, False), (9e-3, 10.0, True)])
def test_the_mean_distance_may_be_off_by_a_thousandth_for_v_0_1(off, scale, expected):
    whole = BranchSegment(half(point(0.09)), half(point(0.11)))
    orbit = an_orbit(0.105, mean_distance=0.2 + off)
    orbit.model.scale = scale
    assert whole.contains(orbit, 1e-3) is expected


def test_a_half_branch_ends_two_orbits_after_the_first_unstable_one():
    is_complete, points, complete = _stop_after_unstable(2), [], []
    for unstable in (0, 0, 2, 0, 1):
        points.append(point(0.1, unstable=unstable))
        complete.append(is_complete(points))
    assert complete == [False, False, False, False, True]
