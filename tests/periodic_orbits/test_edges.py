"""Edges along followed branches against those of the synchronized orbit, orbits found alone, and runs beside orbits."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Instant, Model, OrbitError, Symmetry, closed_motion, law_of
from burridge_knopoff.periodic_orbits import edges, following
from burridge_knopoff.periodic_orbits.edge_kind import EdgeKind
from burridge_knopoff.periodic_orbits.edges import Edge, locate_edges
from burridge_knopoff.periodic_orbits.following import Following, follow
from burridge_knopoff.periodic_orbits.periodic import find_periodic_orbit
from burridge_knopoff.periodic_orbits.stretch import Stretch, half
from burridge_knopoff.running.runner import Runner

MINUS = (-0.989, -0.993, -0.991)
STEPS = Following(largest_step=2e-3)
#: Where the synchronized orbit of the paper's chain changes; `test_synchrony.py` holds them to 40-digit arithmetic.
CRITICAL = {"linearized": 0.086972904666, "nonlinear": 0.088717222971}
GRAZING = {"linearized": 0.035539733583, "nonlinear": 0.035803901459}
FLIP = 0.272317183794


def settled(a, position=MINUS, law="linearized", velocity=(0.099, 0.1012, 0.1023)):
    """Return the closed orbit that a long run of the paper's chain ends on."""
    model = Model(Chain(3), law_of(law, a))
    end = Runner(model).after(model.begin(InitialState("one", position, velocity)), 10_000.0)
    return closed_motion(model, end)


def at(orbit, a):
    """Return the orbit that an orbit is at another a."""
    return find_periodic_orbit(orbit.model.at(a), orbit.reference, orbit.return_time, orbit.symmetry)


def stretch(orbit, a_range, beyond, settings):
    """Return both halves of the stretch around a stable orbit."""
    return Stretch(*(half(orbit, upward, a_range, beyond, settings) for upward in (False, True)))


@pytest.fixture(scope="module")
def six():
    """The stretch of stable orbits on which the end blocks stop six and three times."""
    orbit = settled(0.12)
    assert orbit.signature == (6, 6, 3)
    return stretch(orbit, (0.1, 0.15), 4, STEPS)


def ends_on(orbit, a):
    """Return the stops of the closed orbit that a run ends on which begins on an orbit, but at another a; else none."""
    model = orbit.model.at(a)
    try:
        return closed_motion(model, Runner(model).after(orbit.reference, 3000.0)).signature
    except OrbitError:
        return ()


def test_synchrony_is_lost_in_a_pitchfork(families, law):
    (edge,) = locate_edges(follow(families[law].at(0.08), (0.01, 0.095), STEPS))
    assert edge.kind == EdgeKind.PITCHFORK
    assert edge.a == pytest.approx(CRITICAL[law], abs=1e-10)
    assert edge.a_error <= 1e-10
    assert edge.loses_stability
    assert not edge.keeps_stability
    assert not edge.turns


def test_an_orbit_is_followed_within_a_range_that_it_lies_in(families, law):
    with pytest.raises(OrbitError, match=r"a = 0\.08: not within the range 0\.2 to 0\.3"):
        follow(families[law].at(0.08), (0.2, 0.3))


@pytest.mark.parametrize(
    ("unstable", "loses", "keeps"),
    [((0, 0), False, True), ((0, 1), True, False), ((0, None), True, False), ((1, 0), False, False)],
)
def test_stability_on_both_sides_of_an_edge(unstable, loses, keeps):
    sides = [None if n is None else SimpleNamespace(multipliers=SimpleNamespace(unstable=n)) for n in unstable]
    edge = Edge(0.1, 1e-9, EdgeKind.GRAZING, sides[0], *sides, turns=False)
    assert (edge.loses_stability, edge.keeps_stability) == (loses, keeps)


def test_the_middle_block_begins_to_stick_at_a_grazing(families, law):
    """The return has no square root there: its derivative jumps, and the stick grows like a root of the way."""
    for a, upward in ((0.03, True), (0.04, False)):
        points = follow(families[law].at(a), (0.02, 0.05), STEPS, upward=upward)
        (edge,) = locate_edges(points)
        assert edge.kind == EdgeKind.GRAZING
        assert edge.a == pytest.approx(GRAZING[law], abs=1e-9)
        assert {edge.before.orbit.signature, edge.after.orbit.signature} == {(1, 0, 1), (1, 1, 1)}
        assert edge.keeps_stability
        assert not edge.loses_stability
    near = [point for point in points if 1e-7 < point.orbit.a - edge.a < 1e-4 and point.orbit.signature == (1, 1, 1)]
    slope = [float(point.contacts.stick[1]) ** 2 / (point.orbit.a - edge.a) for point in near]
    assert len(slope) > 2
    assert slope == pytest.approx([slope[-1]] * len(slope), rel=0.1)


def test_symmetric_motion_doubles_its_period(families):
    edges = locate_edges(follow(families["linearized"].at(0.26), (0.25, 0.28), STEPS))
    edge = next(edge for edge in edges if edge.kind == EdgeKind.FLIP)
    assert edge.a == pytest.approx(FLIP, abs=1e-9)


def test_the_asymmetric_orbits_begin_at_the_pitchfork_and_end_at_a_grazing():
    found = stretch(settled(0.1), (0.01, 0.13), 4, STEPS)
    assert found.downward.end.kind == EdgeKind.PITCHFORK
    assert found.downward.end.a == pytest.approx(CRITICAL["linearized"], abs=1e-10)
    assert found.upward.end.kind == EdgeKind.GRAZING
    # The stick of one end block vanishes, and with it the stability: a multiplier jumps over the unit circle.
    assert found.upward.end.after.orbit.signature in ((1, 1, 0), (0, 1, 1))
    assert np.abs(found.upward.end.before.multipliers.whole[0]) < 0.5
    assert np.abs(found.upward.end.after.multipliers.whole[0]) > 1.3


def test_what_branches_off_joins_only_where_it_is_near():
    """At the root of a multiplier's function an orbit far from any simpler one is at a fold."""
    (point, *_) = follow(settled(0.1), (0.09999, 0.10001), STEPS)
    assert edges._kind(point, (EdgeKind.FOLD, "keeping")) == EdgeKind.FOLD


def test_stable_and_unstable_orbits_meet_where_they_graze(six):
    for edge in (six.downward.end, six.upward.end):
        assert edge.kind == EdgeKind.GRAZING
        assert edge.turns
        assert edge.a_error < 1e-10
        assert sorted(edge.after.orbit.signature) == [2, 6, 6]
        assert edge.after.multipliers.unstable == 1
    assert six.stable[0].orbit.a == pytest.approx(six.downward.end.a, abs=1e-9)


def test_runs_leave_an_orbit_beyond_its_edge(six):
    for edge, outward in ((six.downward.end, -1e-6), (six.upward.end, 1e-6)):
        orbit = edge.before.orbit
        assert ends_on(orbit, edge.a - outward) == orbit.signature
        assert ends_on(orbit, edge.a + outward) != orbit.signature


@pytest.fixture(scope="module")
def seven():
    """The stretch of stable orbits on which the end blocks stop seven and four times."""
    for u in (-0.989, 0.3, -0.4, 0.7):
        orbit = settled(0.15, (u, -0.993, -0.991))
        if sorted(orbit.signature) == [4, 7, 7]:
            return stretch(orbit, (0.13, 0.16), 4, STEPS)
    raise AssertionError("no run reaches it")


def test_a_fold_against_orbits_found_on_either_side_of_it(seven):
    edge = seven.upward.end
    assert edge.kind == EdgeKind.FOLD
    assert edge.turns
    assert edge.at.multipliers.whole[0] == pytest.approx(1.0, abs=1e-5)
    here = edge.before.orbit
    gap = edge.a - here.a
    while gap > 1e-8:
        gap *= 0.25
        here = at(here, edge.a - gap)
    with pytest.raises(OrbitError):
        at(here, edge.a + 1e-8)


def test_an_edge_does_not_depend_on_the_side_that_it_is_come_to_from(seven):
    again = stretch(seven.stable[-1].orbit, (0.13, 0.16), 4, Following(largest_step=3e-4))
    for one, other in ((seven.downward.end, again.downward.end), (seven.upward.end, again.upward.end)):
        assert one.a == pytest.approx(other.a, abs=1e-10)
        assert (one.kind, one.turns) == (other.kind, other.turns)


def test_a_doubled_orbit_ends_at_the_flip_of_the_single_one():
    doubled = settled(0.135)
    assert sorted(doubled.signature) == [12, 26, 26]
    found = stretch(doubled, (0.13, 0.15), 4, Following(largest_step=1e-4))
    assert found.upward.end.kind == EdgeKind.FLIP
    flip = stretch(found.upward.orbits[-1].joined, (0.13, 0.15), 4, STEPS).downward.end
    assert flip.a == pytest.approx(found.upward.end.a, abs=1e-10)
    assert flip.at.multipliers.whole[0] == pytest.approx(-1.0, abs=1e-7)
    # The square of what the doubled orbit misses after half its period falls to 0 there.
    near = [point.orbit for point in found.stable if 0.0 < flip.a - point.orbit.a < 6e-4]
    ends = [Runner(orbit.model).after(orbit.reference, 0.5 * orbit.period) for orbit in near]
    missed = [np.abs(end.vector() - orbit.reference.vector()).max() for end, orbit in zip(ends, near, strict=True)]
    slope, offset = np.polyfit([orbit.a for orbit in near], np.square(missed), 1)
    assert len(near) > 2
    assert -offset / slope == pytest.approx(flip.a, abs=5e-5)


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_a_flip_may_break_the_mirror_symmetry(law):
    """Two blocks that move as one part so that each does in a period what the other one does in the next."""
    model = Model(Chain(2), law_of(law, 0.05))
    one = closed_motion(model, model.begin(InitialState("one", (-0.9, -0.9), (0.1, 0.1))), 1000.0)
    (flip,) = locate_edges(follow(one, (0.045, 0.055)))
    assert flip.kind == EdgeKind.FLIP
    start = flip.at.orbit.reference
    start = Instant(start.position + np.array([0.002, -0.002]), start.velocity, start.stuck)
    doubled = find_periodic_orbit(model.at(flip.a + 2e-4), start, flip.at.orbit.period, Symmetry.SYMMETRIC)
    branch = follow(doubled, (0.045, 0.055), upward=False)
    assert branch[-1].joined.period == pytest.approx(0.5 * doubled.period, rel=1e-3)
    (end,) = locate_edges(branch)
    assert end.kind == EdgeKind.FLIP
    assert end.a == pytest.approx(flip.a, abs=1e-9)
    # Found without its symmetry it is followed as what it is.
    plain = find_periodic_orbit(doubled.model, doubled.reference, doubled.period, Symmetry.ASYMMETRIC)
    again = follow(plain, (0.045, 0.055), upward=False)
    assert [edge.kind for edge in locate_edges(again)] == [EdgeKind.FLIP]
    assert again[0].orbit.symmetry == Symmetry.SYMMETRIC


def test_a_torus_branches_off_where_perturbations_stop_decaying():
    orbit = settled(0.12, (-0.787, -0.661, -0.869), velocity=(0.0, 0.101, 0.189))
    assert (orbit.symmetry, orbit.signature) == (Symmetry.SYMMETRIC, (1, 0, 1))
    edge = stretch(orbit, (0.1, 0.16), 4, STEPS).upward.end
    assert edge.kind == EdgeKind.NEIMARK_SACKER
    assert abs(edge.at.multipliers.whole[0]) == pytest.approx(1.0, abs=1e-9)
    assert abs(edge.at.multipliers.whole[0].imag) > 0.1
    for offset, grows in ((-1e-3, False), (1e-3, True)):
        beside = at(edge.at.orbit, edge.a + offset)
        here = beside.reference
        start = Instant(here.position + np.array([1e-6, 0.0, 0.0]), here.velocity, here.stuck)
        end = Runner(beside.model).after(start, 3000.0 * beside.period)
        assert (np.abs(end.vector() - here.vector()).max() > 1e-6) == grows


@pytest.mark.parametrize("succeeds", [True, False])
def test_steps_become_longer_or_shorter_and_end(families, monkeypatch, succeeds):
    """Up to 5e-4, and after 200 orbits, or below 1e-9."""
    lengths = []

    def step(points, length):
        lengths.append(length)
        return points[-1] if succeeds else None

    monkeypatch.setattr(following, "smooth_step", step)
    monkeypatch.setattr(following, "come_to_corner", lambda here, length: [])
    found = follow(families["linearized"].at(0.08), (0.01, 0.1))
    assert len(found) == (200 if succeeds else 1)
    expected = [1e-4, 2e-4, 4e-4, *[5e-4] * 196] if succeeds else [1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9]
    assert lengths == pytest.approx(expected)


def test_a_branch_ends_where_friction_drops_and_an_orbit_grazes():
    """There a block that stops for however short a time starts with a jump: no orbit goes on from the grazing one."""
    orbit = settled(0.05, law="carlson_langer")
    points = follow(orbit, (0.01, 0.06), STEPS, upward=False)
    assert 0.02 < points[-1].orbit.a < 0.05
    assert not list(locate_edges(points))[:-1]
