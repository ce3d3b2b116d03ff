"""Values of a put in between: where they are put, against changes at known places."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.stability import refinement
from burridge_knopoff.stability.attractor import Symmetry
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.refinement import refined
from burridge_knopoff.stability.settings import Refine
from tests.stability.stand_in import stand_in

STILL, OTHER = 0.0, 5.0


def at(place, partner=0, **told):
    returns = np.full((1, 6), place)
    return stand_in(Symmetry.SYMMETRIC, 0.1, partner, **{"returns": returns, "mirror_returns": returns, **told})


@pytest.fixture
def values(monkeypatch):
    """Return the values of a put in between two, where the attractors at each a are told by a function."""

    def put_in(attractors, low=0.0, high=1.0, resolution=0.1):
        asked = []

        class Scripted(Search):
            def labels(self, starts, check=True):
                asked.append((self.model.a, sorted(start.position[1] for start in starts), self.tuning.lasting, check))
                self.attractors = attractors(self.model.a)

        monkeypatch.setattr(refinement, "Search", Scripted)
        ends = []
        for a in (low, high):
            ends.append(Search(Model(Chain(3), law_of("linearized", a))))
            ends[-1].attractors = attractors(a)
        found = refined(*ends, Refine(resolution))
        return [search.model.a for search in found], asked

    return put_in


def after(change, before, later):
    """Return attractors that change at one a."""
    return lambda a: list(before if a < change else later)


def test_bisection_ends_at_the_resolution(values):
    change = after(0.3, [at(STILL)], [at(STILL, section_period=2)])
    found, asked = values(change)
    assert found == [0.25, 0.3125, 0.375, 0.5]
    assert {check for *_, check in asked} == {False}
    assert {lasting for _, _, lasting, _ in asked} == {1}
    # A step of the grid that is near enough is left alone, to rounding.
    assert values(change, resolution=1.0)[0] == []
    assert values(change, low=0.2, high=0.2 + 0.1 * (1 + 1e-12))[0] == []
    assert values(change, low=0.29, high=0.2901, resolution=0.2)[0] == []


def test_nothing_is_put_in_where_nothing_changes(values):
    assert values(lambda a: [at(STILL)]) == ([], [])
    # Nor where nothing attracts, as at a = 0.
    assert values(after(0.5, [], [at(STILL)])) == ([], [])
    assert values(after(0.5, [at(STILL)], [])) == ([], [])


def test_windows_between_are_found_on_both_sides(values):
    """Values at which a third motion is found differ from both neighbours."""

    def window(a):
        kind = MotionKind.PERIODIC if a < 0.4 else MotionKind.CHAOTIC if a < 0.6 else MotionKind.QUASIPERIODIC
        return [at(STILL, kind=kind)]

    found, _ = values(window)
    assert found == [0.25, 0.375, 0.4375, 0.5, 0.5625, 0.625, 0.75]


def test_only_what_changes_is_followed(values):
    """What does not change is not looked for, and no reason to go on where a seed has come to it."""

    def ends(a):
        return [at(STILL, 0), at(OTHER, 1)] if a < 0.3 else [at(STILL, 0)]

    found, asked = values(ends)
    assert found == [0.25, 0.3125, 0.375, 0.5]
    for _, seeds, *_ in asked:
        assert seeds == pytest.approx([OTHER], abs=1e-3)


def test_every_way_to_differ_counts(values):
    for later in (
        at(STILL, kind=MotionKind.QUASIPERIODIC),
        at(STILL, section_period=2),
        replace(at(STILL), symmetry=Symmetry.ASYMMETRIC),
        at(OTHER),
    ):
        assert values(after(0.3, [at(STILL)], [later]))[0] == [0.25, 0.3125, 0.375, 0.5]
    # ⟨J⟩ may differ, and where the set lies as well, as far as it is the same branch.
    assert values(after(0.3, [at(STILL)], [at(STILL + 0.01, mean_distance_error=0.5)]))[0] == []
