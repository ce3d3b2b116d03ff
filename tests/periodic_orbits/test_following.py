"""How a branch continues, joins or passes a branch of simpler orbits, and where it ends."""

from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, Symmetry, follow, law_of, limit_cycle, synchronized_orbit
from burridge_knopoff.periodic_orbits import following
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import locate_bifurcations
from burridge_knopoff.periodic_orbits.following import ContinuationSettings
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from tests.periodic_orbits.stand_in import only, stand_in


@pytest.mark.parametrize(
    ("slopes", "values", "away", "touches"),
    [
        ((1.0, -1.0), (0.5, 0.5), 0.0, True),
        ((-0.1, 0.1), (-0.5, -0.5), 0.0, True),
        # The branch continues; it has a fold; there is no simpler orbit.
        ((1.0, 1.0), (0.5, 0.5), 0.0, False),
        ((1.0, -1.0), (0.5, -0.5), 0.0, False),
        ((1.0, -1.0), (0.5, 0.5), np.inf, False),
        # The distance tolerance is 0.03; the distance in a is of the order of its square.
        ((1.0, -1.0), (0.5, 0.5), 0.029, True),
        ((1.0, -1.0), (0.5, 0.5), 0.031, False),
    ],
)
def test_a_branch_turns_back_without_a_fold_at_a_simpler_orbit(monkeypatch, slopes, values, away, touches):
    monkeypatch.setattr(following, "minimal_form", lambda orbit, tolerance: "simpler" if away <= tolerance else orbit)
    orbit = SimpleNamespace(symmetry=Symmetry.ASYMMETRIC)
    points = [
        SimpleNamespace(orbit=orbit, tangent=[slope], multipliers=only(1.0 + value))
        for slope, value in zip(slopes, values, strict=True)
    ]
    assert following._passed_orbit(*points) == ("simpler" if touches else None)


def test_repetitions_of_another_orbit_do_not_continue_a_branch():
    """At a = 0.11226 an orbit with 29 stops grazes; one with one stop, which ends 3e-5 below, does not continue it."""
    model = Model(Chain(3), law_of("linearized", 0.112265625))
    position = np.array([0.10663254, 0.07868783, 0.06869955])
    start = ChainState(position, np.array([0.0, 0.06015978, 0.02200926]), np.array([True, False, False]))
    branch = follow(
        limit_cycle(model, start), (0.1122, 0.1123), upward=False, is_complete=lambda points: len(points) > 12
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
    model = Model(Chain(3), law_of("linearized", a))
    position = np.array([-0.01583146, -0.00898694, -0.04390718])
    start = ChainState(position, np.array([0.21336224, 0.16773024, 0.2330488]), np.zeros(3, dtype=bool))
    return limit_cycle(model, limit_cycle(model.at(0.135), start, settling=3000.0).reference, settling=6000.0)


@pytest.mark.parametrize("a", [0.135, 0.1355, 0.136])
def test_no_step_jumps_to_a_simpler_orbit(a):
    """A long step past the grazing must not jump to the simple orbit, which is not nearby."""
    orbit = doubled_orbit(a)
    assert orbit.stop_counts == (12, 26, 26)
    branch = follow(orbit, (0.1345, 0.137), upward=False)
    corner = next(point for point in branch if point.is_grazing)
    assert corner.orbit.a == pytest.approx(0.1348243355, abs=1e-10)
    assert all(point.reduced_orbit is None for point in branch)
    # In the other direction the branch does join it.
    branch = follow(orbit, (0.1345, 0.137))
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
        assert follow(orbit, a_range, ContinuationSettings(max_orbits=1))[0].orbit is orbit
    with pytest.raises(ValueError, match=r"^interval: got \(0\.09, 0\.07\), expected \(low, high\) with low ≤ high$"):
        follow(orbit, (0.09, 0.07))


SLOW = Model(Chain(3), law_of("linearized", 0.08))


@dataclass(frozen=True)
class Step:
    """The result of a step along a branch in a."""

    orbit: SimpleNamespace
    length: float = 0.0
    is_grazing: bool = False
    reduced_orbit: str | None = None
    tangent: tuple[float, ...] = (1.0,)

    @property
    def value(self):
        return self.orbit.a


def a_step(a, length=0.0, **fields):
    return Step(SimpleNamespace(a=a), length, **fields)


@pytest.fixture
def walk(monkeypatch):
    """Return the points of a branch from a = 0.1, and the lengths of the attempted steps."""

    def walked(smooth, corners, turned, **options):
        lengths, smooth, corners, turned = [], iter(smooth), iter(corners), iter(turned)

        def step(points, length):
            lengths.append(length)
            return next(smooth)

        line = SimpleNamespace(value=lambda model: model.a)
        monkeypatch.setattr(following, "line_of", lambda orbit, parameter: line)
        monkeypatch.setattr(following, "reduced_orbit", lambda orbit: None)
        monkeypatch.setattr(following, "begin_branch", lambda orbit, upward, line: Step(orbit))
        monkeypatch.setattr(following, "smooth_step", step)
        monkeypatch.setattr(following, "approach_grazing", lambda points, length: next(corners))
        monkeypatch.setattr(following, "switch_branch", lambda point: next(turned))
        return follow(stand_in(PeriodicOrbit, model=SimpleNamespace(a=0.1)), (0.1, 0.2), **options), lengths

    return walked


def test_after_a_corner_steps_start_again_with_the_first_length(walk):
    corner = a_step(0.13, 1e-9, is_grazing=True)
    smooth = [a_step(0.11), a_step(0.12), None, a_step(0.2), a_step(0.21)]
    points, lengths = walk(smooth, [[a_step(0.125), corner]], [a_step(0.14)])
    assert [point.orbit.a for point in points] == [0.1, 0.11, 0.12, 0.125, 0.13, 0.14, 0.2, 0.21]
    assert lengths == pytest.approx([1e-4, 2e-4, 4e-4, 1e-4, 2e-4])
    # There is no orbit beyond the last corner.
    points, _ = walk(smooth[:3], [[corner]], [None])
    assert points[-1] is not None
    assert points[-1].is_grazing


def test_after_an_approach_without_a_corner_the_next_step_is_as_long_as_the_last(walk):
    """Otherwise the next step is a tenth of the length that was too long."""
    points, lengths = walk([None, None, a_step(0.21)], [[a_step(0.11, 3e-5)], [a_step(0.12, 1e-9)]], [])
    assert lengths == pytest.approx([1e-4, 3e-5, 3e-6])
    assert [point.orbit.a for point in points] == [0.1, 0.11, 0.12, 0.21]


def test_a_branch_ends_where_it_joins_another_one(walk):
    points, _ = walk([a_step(0.11), a_step(0.12, reduced_orbit="simpler")], [], [])
    assert [point.reduced_orbit for point in points] == [None, None, "simpler"]
    points, _ = walk([None], [[a_step(0.11), a_step(0.12, reduced_orbit="simpler"), a_step(0.13)]], [])
    assert [point.reduced_orbit for point in points] == [None, None, "simpler"]


def test_a_branch_ends_where_it_has_passed_another_one(walk, monkeypatch):
    monkeypatch.setattr(following, "_passed_orbit", lambda first, second: "passed" if second.orbit.a == 0.12 else None)
    points, _ = walk([a_step(0.11), a_step(0.12)], [], [])
    assert [point.reduced_orbit for point in points] == [None, None, "passed"]


def test_a_branch_ends_when_it_is_complete(walk):
    counts = []

    def enough(points):
        counts.append(len(points))
        return len(points) == 3

    assert len(walk([a_step(0.11), a_step(0.12)], [], [], is_complete=enough)[0]) == 3
    assert counts == [1, 2, 3]
    # This also applies to the approach to a corner.
    counts.clear()
    assert len(walk([None], [[a_step(0.11), a_step(0.12), a_step(0.13)]], [], is_complete=enough)[0]) == 3
    assert counts == [1, 2, 3]


@pytest.mark.parametrize(("most", "count"), [(2, 2), (3, 3), (4, 5), (5, 5), (6, 6)])
def test_a_branch_has_at_most_the_requested_number_of_orbits(walk, most, count):
    """It does not end at a corner, since the other side would be missing."""
    way = [a_step(0.11), a_step(0.12), a_step(0.13, 1e-9, is_grazing=True)]
    settings = ContinuationSettings(max_orbits=most)
    points, _ = walk([None, a_step(0.15), a_step(0.21)], [way], [a_step(0.14)], settings=settings)
    assert [point.orbit.a for point in points] == [0.1, 0.11, 0.12, 0.13, 0.14, 0.15, 0.21][:count]


def test_at_most_one_orbit_beyond_the_range_is_kept(walk):
    points, _ = walk([None], [[a_step(0.11), a_step(0.21), a_step(0.22)]], [])
    assert [point.orbit.a for point in points] == [0.1, 0.11, 0.21]


@pytest.mark.parametrize("steps", [(1e6, 1e6, 1e6), (1e6, 1e6, 1e-300), (5e-324, 1e6, 5e-324)], ids=str)
@pytest.mark.parametrize("parameter", ["a", "coupling"])
def test_a_branch_ends_whatever_the_lengths_of_steps(steps, parameter):
    first, largest, smallest = steps
    settings = ContinuationSettings(first_step=first, largest_step=largest, smallest_step=smallest, max_orbits=5)
    orbit = synchronized_orbit(Model(Chain(3), law_of("linearized", 0.08)))
    assert 1 <= len(follow(orbit, (0.0, 10.0), settings, parameter=parameter)) <= 6
