"""Bifurcations along branches, compared with those of the synchronized orbit, with single orbits and with runs."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import ChainState, InitialState, Model, OrbitError, Symmetry, limit_cycle
from burridge_knopoff.periodic_orbits import bifurcations
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.branch_segment import BranchSegment, follow_half_branch
from burridge_knopoff.periodic_orbits.following import ContinuationSettings, follow
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit
from burridge_knopoff.running.runner import Runner
from tests.refused import refused

MINUS = (-0.989, -0.993, -0.991)
STEPS = ContinuationSettings(largest_step=2e-3)
#: Where the synchronized orbit of the paper's chain changes; `test_synchrony.py` holds them to 40-digit arithmetic.
CRITICAL = {"linearized": 0.086972904666, "nonlinear": 0.088717222971}
GRAZING = {"linearized": 0.035539733583, "nonlinear": 0.035803901459}
PERIOD_DOUBLING = 0.272317183794


def settled_orbit(a, position=MINUS, law="linearized", velocity=(0.099, 0.1012, 0.1023)):
    """Return the periodic orbit on which a long run of the paper's chain ends."""
    model = Model(law, a=a)
    end = Runner(model).state_after(model.begin(InitialState("one", position, velocity)), 10_000.0)
    return limit_cycle(model, end)


def at(orbit, a):
    """Return the continuation of an orbit to another a."""
    return find_periodic_orbit(orbit.model.at(a=a), orbit.reference, orbit.return_time, orbit.symmetry)


def segment(orbit, a_range, beyond, settings):
    """Return the segment around a stable orbit."""
    return BranchSegment(*(follow_half_branch(orbit, upward, a_range, beyond, settings) for upward in (False, True)))


@pytest.fixture(scope="module")
def six():
    """The segment of stable orbits on which the end blocks stop six and three times."""
    orbit = settled_orbit(0.12)
    assert orbit.stop_counts == (6, 6, 3)
    return segment(orbit, (0.1, 0.15), 4, STEPS)


def ends_on(orbit, a):
    """Return the stops of the periodic orbit that a run from an orbit reaches at another a; None if it reaches none."""
    model = orbit.model.at(a=a)
    try:
        return limit_cycle(model, Runner(model).state_after(orbit.reference, 3000.0)).stop_counts
    except OrbitError:
        return ()


def test_synchrony_is_lost_in_a_pitchfork(families, law):
    (bifurcation,) = locate_bifurcations(follow(families[law].at(0.08), (0.01, 0.095), STEPS, parameter="a"))
    assert bifurcation.kind == BifurcationKind.PITCHFORK
    assert bifurcation.a == pytest.approx(CRITICAL[law], abs=1e-10)
    assert bifurcation.error <= 1e-10
    assert bifurcation.loses_stability
    assert not bifurcation.keeps_stability
    assert not bifurcation.is_turning_point


def test_an_orbit_is_followed_within_a_range_that_it_lies_in(families, law):
    with refused("a = 0.08", "0.2 to 0.3", error=OrbitError):
        follow(families[law].at(0.08), (0.2, 0.3), parameter="a")


@pytest.mark.parametrize(
    ("unstable", "loses", "keeps"),
    [((0, 0), False, True), ((0, 1), True, False), ((0, None), True, False), ((1, 0), False, False)],
)
def test_stability_on_both_sides_of_a_bifurcation(unstable, loses, keeps):
    sides = [None if n is None else SimpleNamespace(multipliers=SimpleNamespace(unstable_count=n)) for n in unstable]
    bifurcation = Bifurcation(0.1, 1e-9, BifurcationKind.GRAZING, sides[0], *sides, is_turning_point=False)
    assert (bifurcation.loses_stability, bifurcation.keeps_stability) == (loses, keeps)


def test_the_middle_block_begins_to_stick_at_a_grazing(families, law):
    """The return map has no square root: its derivative jumps, and the duration of the stick grows like a root."""
    for a, upward in ((0.03, True), (0.04, False)):
        points = follow(families[law].at(a), (0.02, 0.05), STEPS, upward=upward, parameter="a")
        (bifurcation,) = locate_bifurcations(points)
        assert bifurcation.kind == BifurcationKind.GRAZING
        assert bifurcation.a == pytest.approx(GRAZING[law], abs=1e-9)
        assert {bifurcation.before.orbit.stop_counts, bifurcation.after.orbit.stop_counts} == {(1, 0, 1), (1, 1, 1)}
        assert bifurcation.keeps_stability
        assert not bifurcation.loses_stability
    near = [point for point in points if 1e-7 < point.orbit.a - bifurcation.a < 1e-4]
    near = [point for point in near if point.orbit.stop_counts == (1, 1, 1)]
    slope = [float(point.grazing_distances.stick[1]) ** 2 / (point.orbit.a - bifurcation.a) for point in near]
    assert len(slope) > 2
    assert slope == pytest.approx([slope[-1]] * len(slope), rel=0.1)


def test_symmetric_motion_doubles_its_period(families):
    bifurcations = locate_bifurcations(follow(families["linearized"].at(0.26), (0.25, 0.28), STEPS, parameter="a"))
    bifurcation = next(item for item in bifurcations if item.kind == BifurcationKind.PERIOD_DOUBLING)
    assert bifurcation.a == pytest.approx(PERIOD_DOUBLING, abs=1e-9)


def test_the_asymmetric_orbits_begin_at_the_pitchfork_and_end_at_a_grazing():
    half_branches = segment(settled_orbit(0.1), (0.01, 0.13), 4, STEPS)
    assert half_branches.downward.end.kind == BifurcationKind.PITCHFORK
    assert half_branches.downward.end.a == pytest.approx(CRITICAL["linearized"], abs=1e-10)
    assert half_branches.upward.end.kind == BifurcationKind.GRAZING
    # The stick of one end block vanishes and stability is lost: a multiplier jumps across the unit circle.
    assert half_branches.upward.end.after.orbit.stop_counts in ((1, 1, 0), (0, 1, 1))
    assert np.abs(half_branches.upward.end.before.multipliers.whole[0]) < 0.5
    assert np.abs(half_branches.upward.end.after.multipliers.whole[0]) > 1.3


def test_a_branch_joins_a_simpler_one_only_nearby():
    """At the root of the test function, an orbit far from any simpler one is at a fold."""
    (point, *_) = follow(settled_orbit(0.1), (0.09999, 0.10001), STEPS, parameter="a")
    assert bifurcations.kind_at(point, (BifurcationKind.FOLD, "symmetry_preserving")) == BifurcationKind.FOLD


def test_stable_and_unstable_orbits_meet_where_they_graze(six):
    for bifurcation in (six.downward.end, six.upward.end):
        assert bifurcation.kind == BifurcationKind.GRAZING
        assert bifurcation.is_turning_point
        assert bifurcation.error < 1e-10
        assert sorted(bifurcation.after.orbit.stop_counts) == [2, 6, 6]
        assert bifurcation.after.multipliers.unstable_count == 1
    assert six.stable_orbits[0].orbit.a == pytest.approx(six.downward.end.a, abs=1e-9)


def test_runs_leave_an_orbit_beyond_its_bifurcation(six):
    for bifurcation, outward in ((six.downward.end, -1e-6), (six.upward.end, 1e-6)):
        orbit = bifurcation.before.orbit
        assert ends_on(orbit, bifurcation.a - outward) == orbit.stop_counts
        assert ends_on(orbit, bifurcation.a + outward) != orbit.stop_counts


@pytest.fixture(scope="module")
def seven():
    """The segment of stable orbits on which the end blocks stop seven and four times."""
    for u in (-0.989, 0.3, -0.4, 0.7):
        orbit = settled_orbit(0.15, (u, -0.993, -0.991))
        if sorted(orbit.stop_counts) == [4, 7, 7]:
            return segment(orbit, (0.13, 0.16), 4, STEPS)
    raise AssertionError("no run reaches it")


def test_a_fold_against_orbits_found_on_either_side_of_it(seven):
    bifurcation = seven.upward.end
    assert bifurcation.kind == BifurcationKind.FOLD
    assert bifurcation.is_turning_point
    assert bifurcation.at.multipliers.whole[0] == pytest.approx(1.0, abs=1e-5)
    orbit = bifurcation.before.orbit
    gap = bifurcation.a - orbit.a
    while gap > 1e-8:
        gap *= 0.25
        orbit = at(orbit, bifurcation.a - gap)
    with pytest.raises(OrbitError):
        at(orbit, bifurcation.a + 1e-8)


def test_a_bifurcation_does_not_depend_on_the_direction_of_continuation(seven):
    again = segment(seven.stable_orbits[-1].orbit, (0.13, 0.16), 4, ContinuationSettings(largest_step=3e-4))
    for first, second in ((seven.downward.end, again.downward.end), (seven.upward.end, again.upward.end)):
        assert first.a == pytest.approx(second.a, abs=1e-10)
        assert (first.kind, first.is_turning_point) == (second.kind, second.is_turning_point)


def test_a_doubled_orbit_ends_at_the_period_doubling_of_the_single_one():
    doubled = settled_orbit(0.135)
    assert sorted(doubled.stop_counts) == [12, 26, 26]
    branch = segment(doubled, (0.13, 0.15), 4, ContinuationSettings(largest_step=1e-4))
    assert branch.upward.end.kind == BifurcationKind.PERIOD_DOUBLING
    doubling = segment(branch.upward.orbits[-1].reduced_orbit, (0.13, 0.15), 4, STEPS).downward.end
    assert doubling.a == pytest.approx(branch.upward.end.a, abs=1e-10)
    assert doubling.at.multipliers.whole[0] == pytest.approx(-1.0, abs=1e-7)
    # The squared distance of the doubled orbit from its start after half its period falls to 0 there.
    near = [point.orbit for point in branch.stable_orbits if 0.0 < doubling.a - point.orbit.a < 6e-4]
    ends = [Runner(orbit.model).state_after(orbit.reference, 0.5 * orbit.period) for orbit in near]
    missed = [np.abs(end.vector() - orbit.reference.vector()).max() for end, orbit in zip(ends, near, strict=True)]
    slope, offset = np.polyfit([orbit.a for orbit in near], np.square(missed), 1)
    assert len(near) > 2
    assert -offset / slope == pytest.approx(doubling.a, abs=5e-5)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_a_period_doubling_may_break_the_mirror_symmetry(law):
    """Two synchronized blocks separate so that each does in one period what the other does in the next."""
    model = Model(law, a=0.05, blocks=2)
    orbit = limit_cycle(model, model.begin(InitialState("one", (-0.9, -0.9), (0.1, 0.1))), 1000.0)
    (doubling,) = locate_bifurcations(follow(orbit, (0.045, 0.055), parameter="a"))
    assert doubling.kind == BifurcationKind.PERIOD_DOUBLING
    start = doubling.at.orbit.reference
    start = ChainState(start.position + np.array([0.002, -0.002]), start.velocity, start.stuck)
    doubled = find_periodic_orbit(model.at(a=doubling.a + 2e-4), start, doubling.at.orbit.period, Symmetry.SYMMETRIC)
    branch = follow(doubled, (0.045, 0.055), upward=False, parameter="a")
    assert branch[-1].reduced_orbit.period == pytest.approx(0.5 * doubled.period, rel=1e-3)
    (end,) = locate_bifurcations(branch)
    assert end.kind == BifurcationKind.PERIOD_DOUBLING
    assert end.a == pytest.approx(doubling.a, abs=1e-9)
    # An orbit found without its symmetry is continued in its minimal form.
    plain = find_periodic_orbit(doubled.model, doubled.reference, doubled.period, Symmetry.ASYMMETRIC)
    again = follow(plain, (0.045, 0.055), upward=False, parameter="a")
    assert [bifurcation.kind for bifurcation in locate_bifurcations(again)] == [BifurcationKind.PERIOD_DOUBLING]
    assert again[0].orbit.symmetry == Symmetry.SYMMETRIC


def test_a_torus_branches_off_where_perturbations_stop_decaying():
    orbit = settled_orbit(0.12, (-0.787, -0.661, -0.869), velocity=(0.0, 0.101, 0.189))
    assert (orbit.symmetry, orbit.stop_counts) == (Symmetry.SYMMETRIC, (1, 0, 1))
    bifurcation = segment(orbit, (0.1, 0.16), 4, STEPS).upward.end
    assert bifurcation.kind == BifurcationKind.NEIMARK_SACKER
    assert abs(bifurcation.at.multipliers.whole[0]) == pytest.approx(1.0, abs=1e-9)
    assert abs(bifurcation.at.multipliers.whole[0].imag) > 0.1
    for offset, grows in ((-1e-3, False), (1e-3, True)):
        nearby = at(bifurcation.at.orbit, bifurcation.a + offset)
        reference = nearby.reference
        start = ChainState(reference.position + np.array([1e-6, 0.0, 0.0]), reference.velocity, reference.stuck)
        end = Runner(nearby.model).state_after(start, 3000.0 * nearby.period)
        assert (np.abs(end.vector() - reference.vector()).max() > 1e-6) == grows


def test_a_branch_ends_where_friction_drops_and_an_orbit_grazes():
    """Even the shortest stick ends with a jump, so that the branch ends at the grazing."""
    orbit = settled_orbit(0.05, law="carlson_langer")
    points = follow(orbit, (0.01, 0.06), STEPS, upward=False, parameter="a")
    assert 0.02 < points[-1].orbit.a < 0.05
    assert not list(locate_bifurcations(points))[:-1]
