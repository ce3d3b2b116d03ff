"""How a branch continues, joins or passes a branch of simpler orbits, and where it ends."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, Symmetry, limit_cycle, synchronized_orbit
from burridge_knopoff.periodic_orbits import following
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import locate_bifurcations
from burridge_knopoff.periodic_orbits.following import CONTINUATION, ContinuationSettings, follow
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.pseudo_arclength import begin_branch
from tests.normal_forms import CRITICAL, border_collision, fold, on_line, orbit_at, pitchfork
from tests.refused import refused

LINE = line_along_a(Chain(2))


@pytest.mark.parametrize(("d", "touches"), [(0.0145, True), (0.0155, False)])
def test_a_branch_turns_back_without_a_fold_at_a_simpler_orbit(d, touches):
    """It is recognized within a distance 2d of 0.03; the distance in a is of the order of its square."""
    first, second = (
        begin_branch(orbit_at(pitchfork(1.0), d**2, [side * d, -side * d], chain=Chain(2)), side < 0.0, LINE)
        for side in (1.0, -1.0)
    )
    passed = following._passed_orbit(first, second)
    assert (passed and passed.symmetry) == (Symmetry.SYNCHRONIZED if touches else None)
    # The branch continues on the same side.
    assert following._passed_orbit(first, first) is None


def test_a_branch_turns_back_at_a_fold():
    first, second = (begin_branch(orbit_at(fold(), 1e-4, x), x < 0.0, LINE) for x in (1e-2, -1e-2))
    assert following._passed_orbit(first, second) is None


def test_repetitions_of_another_orbit_do_not_continue_a_branch():
    """At a = 0.11226 an orbit with 29 stops grazes; one with one stop, which ends 3e-5 below, does not continue it."""
    model = Model("linearized", a=0.112265625)
    position = np.array([0.10663254, 0.07868783, 0.06869955])
    start = ChainState(position, np.array([0.0, 0.06015978, 0.02200926]), np.array([True, False, False]))
    branch = follow(
        limit_cycle(model, start),
        (0.1122, 0.1123),
        upward=False,
        is_complete=lambda points: len(points) > 12,
        parameter="a",
    )
    corner = next(number for number, point in enumerate(branch) if point.is_grazing)
    assert {point.orbit.stop_counts for point in branch[: corner + 1]} == {(29, 29, 10)}
    assert {point.orbit.stop_counts for point in branch[corner + 1 :]} == {(29, 29, 9)}
    # Both orbits exist on the same side: the grazing is a turning point, beyond which the branch is unstable.
    assert all(point.orbit.a > branch[corner].orbit.a for point in branch[corner + 1 :])
    assert [point.multipliers.unstable_count for point in branch] == [0] * (corner + 1) + [1] * (
        len(branch) - corner - 1
    )


def doubled_orbit(a):
    """Return the orbit with (12, 26, 26) stops, which branches off the one with (6, 13, 13) at a = 0.136416."""
    model = Model("linearized", a=a)
    position = np.array([-0.01583146, -0.00898694, -0.04390718])
    start = ChainState(position, np.array([0.21336224, 0.16773024, 0.2330488]), np.zeros(3, dtype=bool))
    return limit_cycle(model, limit_cycle(model.at(a=0.135), start, settling=3000.0).reference, settling=6000.0)


@pytest.mark.parametrize("a", [0.135, 0.1355, 0.136])
def test_no_step_jumps_to_a_simpler_orbit(a):
    """A long step past the grazing must not jump to the simple orbit, which is not nearby."""
    orbit = doubled_orbit(a)
    assert orbit.stop_counts == (12, 26, 26)
    branch = follow(orbit, (0.1345, 0.137), upward=False, parameter="a")
    corner = next(point for point in branch if point.is_grazing)
    assert corner.orbit.a == pytest.approx(0.1348243355, abs=1e-10)
    assert all(point.reduced_orbit is None for point in branch)
    # In the other direction the branch does join it.
    branch = follow(orbit, (0.1345, 0.137), parameter="a")
    assert branch[-1].reduced_orbit.stop_counts == (6, 13, 13)
    (bifurcation,) = locate_bifurcations(branch)
    assert bifurcation.kind == BifurcationKind.PERIOD_DOUBLING
    assert bifurcation.a == pytest.approx(0.136416049, abs=1e-9)
    assert bifurcation.at.multipliers.symmetry_preserving == pytest.approx(
        bifurcation.at.multipliers.symmetry_preserving.real
    )
    assert np.abs(bifurcation.at.multipliers.symmetry_preserving + 1.0).min() < 1e-8


def test_a_branch_must_begin_within_its_interval():
    """The orbit may lie exactly at an end of the interval; an interval runs from low to high."""
    orbit = limit_cycle(SLOW, synchronized_orbit(SLOW).reference)
    for a_range in ((0.08, 0.08), (0.08, 0.09), (0.07, 0.08)):
        assert follow(orbit, a_range, replace(CONTINUATION, max_orbits=1), parameter="a")[0].orbit is orbit
    with refused("interval: (0.09, 0.07)"):
        follow(orbit, (0.09, 0.07), parameter="a")


SLOW = Model("linearized", a=0.08)


def linear_orbit(**fields):
    """Return the orbit x = 2μ of x → x/2 + μ at μ = −0.01."""
    form = on_line(lambda x, mu: 0.5 * x + mu, lambda x, mu: 0.5, **fields)
    return orbit_at(form, -0.01, -0.02)


def lengths_of(branch):
    return [point.length for point in branch[1:]]


def test_steps_become_longer_up_to_the_largest():
    """From 1e-4 to 5e-4; the branch ends after 200 orbits."""
    branch = follow(linear_orbit(), parameter="a")
    assert len(branch) == 200
    assert lengths_of(branch) == pytest.approx([1e-4, 2e-4, 4e-4, *[5e-4] * 196])


def test_steps_become_shorter_up_to_the_end_of_a_branch():
    """The law exists up to μ = −0.008; the branch is given up where steps are shorter than the smallest one."""
    branch = follow(linear_orbit(exists=lambda mu: mu <= -0.008), parameter="a")
    assert 0.0 <= CRITICAL - 0.008 - branch[-1].value < 1e-8
    assert not branch[-1].is_grazing
    assert branch[-1].length < 1e-7


def test_after_a_corner_steps_start_again_with_the_first_length():
    branch = follow(orbit_at(border_collision(0.5, -0.4), -0.001, -0.002), (0.09, 0.103), parameter="a")
    (corner,) = (k for k, point in enumerate(branch) if point.is_grazing)
    assert branch[corner].value == pytest.approx(CRITICAL, abs=1e-10)
    assert branch[corner + 1].value > CRITICAL
    assert lengths_of(branch[corner + 1 :])[:4] == pytest.approx([1e-4, 2e-4, 4e-4, 5e-4])


def test_a_branch_ends_when_it_is_complete():
    counts = []

    def enough(points):
        counts.append(len(points))
        return len(points) == 3

    assert len(follow(linear_orbit(), is_complete=enough, parameter="a")) == 3
    assert counts == [1, 2, 3]
    # This also applies to the approach to a corner.
    counts.clear()
    near = orbit_at(border_collision(0.5, -0.4), -1e-5, -2e-5)
    assert len(follow(near, is_complete=enough, parameter="a")) == 3
    assert counts == [1, 2, 3]


@pytest.mark.parametrize("most", range(1, 14))
def test_a_branch_has_at_most_the_requested_number_of_orbits(most):
    """It does not end at a corner, since the other side would be missing."""
    orbit = orbit_at(border_collision(0.5, -0.4), -1e-5, -2e-5)
    (corner,) = (k for k, point in enumerate(follow(orbit, (0.09, 0.101), parameter="a")) if point.is_grazing)
    assert 2 < corner < 12
    branch = follow(orbit, settings=replace(CONTINUATION, max_orbits=most), parameter="a")
    assert len(branch) == most + (most == corner + 1)
    assert not branch[-1].is_grazing


@pytest.mark.parametrize("high", [CRITICAL - 1e-6, CRITICAL + 1e-3])
def test_at_most_one_orbit_beyond_the_range_is_kept(high):
    """The range may end within the approach to a corner."""
    branch = follow(orbit_at(border_collision(0.5, -0.4), -0.001, -0.002), (0.09, high), parameter="a")
    assert [point.value > high for point in branch] == [False] * (len(branch) - 1) + [True]


@pytest.mark.parametrize("steps", [(1e6, 1e6, 1e6), (1e6, 1e6, 1e-300), (5e-324, 1e6, 5e-324)], ids=str)
@pytest.mark.parametrize("parameter", ["a", "coupling"])
def test_a_branch_ends_whatever_the_lengths_of_steps(steps, parameter):
    first, largest, smallest = steps
    settings = ContinuationSettings(first_step=first, largest_step=largest, smallest_step=smallest, max_orbits=5)
    orbit = synchronized_orbit(Model("linearized", a=0.08))
    assert 1 <= len(follow(orbit, (0.0, 10.0), settings, parameter=parameter)) <= 6
