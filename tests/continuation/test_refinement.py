"""Inserted values of a, compared with changes at known places."""

import pytest

from burridge_knopoff import Model, MotionKind
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.continuation.matching import DistanceMatcher
from burridge_knopoff.continuation.refinement import refine_searches
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.running.processes import parallel_map
from tests.motion.stand_in import ASYMMETRIC, at

STILL, OTHER = 0.0, 5.0
BISECTED = [0.25, 0.3125, 0.375, 0.5]


@pytest.fixture
def values():
    """Return a function that returns the values of a inserted between two, with scripted attractors at each a."""

    def insert_values(attractors, low=0.0, high=1.0, resolution=0.1):
        calls = []

        class Scripted(Search):
            def find(self, starts, check=True):
                calls.append(
                    (self.model.parameter("a"), sorted(start.position[1] for start in starts), self.trials, check)
                )
                self.attractors = attractors(self.model.parameter("a"))

        ends = [Scripted(Model("linearized", a=a), attractors=attractors(a)) for a in (low, high)]
        with parallel_map(1) as pool:
            (inner,) = refine_searches(ends, RefinementSettings(resolution), DistanceMatcher(), pool)
        return [search.model.parameter("a") for search in inner], calls

    return insert_values


def changing_at(change, before, later):
    """Return attractors that change at one a."""
    return lambda a: list(before if a < change else later)


def test_bisection_ends_at_the_resolution(values):
    change = changing_at(0.3, [at(STILL)], [at(STILL, section_period=2)])
    inserted, calls = values(change)
    assert inserted == BISECTED
    assert {call[2:] for call in calls} == {(1, False)}
    # No value is inserted into a step of the grid that is small enough, up to rounding.
    assert values(change, resolution=1.0)[0] == []
    assert values(change, low=0.2, high=0.2 + 0.1 * (1 + 1e-12))[0] == []
    assert values(change, low=0.29, high=0.2901, resolution=0.2)[0] == []


def test_no_value_is_inserted_where_nothing_changes(values):
    """Nor is one inserted next to a value without attractors, such as a = 0."""
    for before, later in (([at(STILL)], [at(STILL)]), ([], [at(STILL)]), ([at(STILL)], [])):
        assert values(changing_at(0.5, before, later)) == ([], [])


def test_windows_between_values_are_refined_on_both_sides(values):
    """Values at which a third motion is found differ from both neighbours."""

    def window(a):
        kind = MotionKind.PERIODIC if a < 0.4 else MotionKind.CHAOTIC if a < 0.6 else MotionKind.QUASIPERIODIC
        return [at(STILL, kind=kind)]

    assert values(window)[0] == [0.25, 0.375, 0.4375, 0.5, 0.5625, 0.625, 0.75]


def test_only_changing_attractors_are_followed(values):
    """Unchanged attractors are not followed, and a seed that has reached one does not count as a change."""
    inserted, calls = values(changing_at(0.3, [at(STILL), at(OTHER, partner=1)], [at(STILL)]))
    assert inserted == BISECTED
    for _, seeds, *_ in calls:
        assert seeds == pytest.approx([OTHER], abs=1e-3)


@pytest.mark.parametrize(
    ("later", "found"),
    [
        (at(STILL, kind=MotionKind.QUASIPERIODIC), BISECTED),
        (at(STILL, section_period=2), BISECTED),
        (at(STILL, symmetry=ASYMMETRIC), BISECTED),
        (at(OTHER), BISECTED),
        # ⟨J⟩ and the place of the set may differ, as long as it is the same branch.
        (at(STILL + 0.01, mean_distance_error=0.5), []),
    ],
)
def test_every_difference_of_attractors_counts(values, later, found):
    assert values(changing_at(0.3, [at(STILL)], [later]))[0] == found
