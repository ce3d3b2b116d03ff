"""Attractors along a: those found at one value seed the others, and no result depends on the number of processes."""

import logging
from dataclasses import fields

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, SearchSettings, law_of
from burridge_knopoff.attractors.search import Search
from burridge_knopoff.basins import fractions
from burridge_knopoff.continuation import attractor_continuation as continuation
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.settings import MOTION
from tests.motion.stand_in import at

STILL, OTHER = 0.0, 5.0
A_VALUES = (0.1, 0.2, 0.3, 0.4)


def models(a_values=A_VALUES):
    return [Model(Chain(3), law_of("linearized", a)) for a in a_values]


@pytest.fixture
def scripted(monkeypatch):
    """Initial states lead to one attractor, and at a = 0.2 also to another one, which exists up to a = 0.3."""
    followed = []

    class Scripted(Search):
        def labels(self, starts, check=True):
            if check:
                self.attractors = [at(STILL)]
                self.unsuccessful_states = (b"a state",)
            else:
                assert not self.unsuccessful_states
                followed.append((self.model.a, [round(start.position[1]) for start in starts]))
            if self.model.a == 0.2 or (not check and self.model.a <= 0.3):
                self.attractors = [at(STILL), at(OTHER, partner=1)]

        def known_labels(self, starts):
            places = {round(item.motion.returns[0, 1]): k for k, item in enumerate(self.attractors)}
            return np.array([places.get(round(start.position[1]), -1) for start in starts])

    def labels(searches, start, pool):
        return searches, [np.full(7, len(search.attractors)) for search in searches]

    monkeypatch.setattr(continuation, "Search", Scripted)
    monkeypatch.setattr(continuation, "fraction_labels", labels)
    return followed


def test_attractors_at_one_value_seed_the_others(scripted):
    """They do so downward and upward as far as they exist; attractors known at both values are not followed again."""
    whole = continue_attractors(models(), refine=RefinementSettings(1.0))
    assert scripted == [(0.1, [OTHER]), (0.3, [OTHER]), (0.4, [OTHER])]
    assert [len(attractors) for attractors in whole.attractors] == [2, 2, 2, 1]
    assert [branch.tolist() for branch in whole.branch] == [[1, 2], [1, 2], [1, 2], [1]]
    assert [index.tolist() for index in whole.upward] == [[0, 1], [0, 1], [0, -1], [-1]]
    assert [index.tolist() for index in whole.downward] == [[-1, -1], [0, 1], [0, 1], [0]]
    assert [labels.tolist() for labels in whole.samples] == [[2] * 7] * 3 + [[1] * 7]
    assert whole.grid == [0, 1, 2, 3]


def test_a_branch_is_remembered_over_two_of_the_widest_steps(scripted, monkeypatch):
    """So no branch ends only because the grid is coarser."""
    calls, branches = [], continuation.branches
    monkeypatch.setattr(continuation, "branches", lambda *arguments: calls.append(arguments) or branches(*arguments))
    continue_attractors(models((0.1, 0.2, 0.5, 0.55)), refine=RefinementSettings(1.0))
    ((_, _, _, reach, *_),) = calls
    assert reach == pytest.approx(0.6)


def same(one, other):
    """Require that two results are equal to the bit."""
    assert type(one) is type(other)
    if isinstance(one, np.ndarray):
        np.testing.assert_array_equal(one, other)
    elif isinstance(one, list | tuple):
        assert len(one) == len(other)
        for first, second in zip(one, other, strict=True):
            same(first, second)
    elif hasattr(one, "motion") or hasattr(one, "returns"):
        for item in fields(one):
            same(getattr(one, item.name), getattr(other, item.name))
    elif not isinstance(one, Model):
        assert one == other or (one != one and other != other)


def test_attractors_found_only_in_basin_sampling_seed_the_others():
    """Synchrony loses stability between these two values; the antiphase orbit exists at both."""
    settings = SearchSettings(samples=6, fraction_width=0.2)
    whole = continue_attractors(models((0.0862, 0.09)), settings, refine=RefinementSettings(1.0))
    means = [
        sorted(round(attractor.motion.mean_distance, 2) for attractor in attractors) for attractors in whole.attractors
    ]
    assert means == [[0.0, 0.14, 0.19], [0.02, 0.02, 0.14, 0.19]]
    assert 2 not in whole.samples[0]


@pytest.mark.slow
def test_results_do_not_depend_on_processes_or_the_cache(tmp_path, monkeypatch, caplog):
    """With one more value cached results are used, and the results are those of a run without a cache."""
    monkeypatch.setattr(fractions, "LABELLED_AT_ONCE", 30)
    settings = SearchSettings(samples=10, fraction_width=0.13, transient=1000.0, window=800.0, perturbations=4)

    def continued(a_values, **share):
        states = list(PAPER_STATES.values())
        return continue_attractors(models(a_values), settings, MOTION, RefinementSettings(0.01), starts=states, **share)

    continued((0.06, 0.1), processes=2, folder=tmp_path)
    caplog.set_level(logging.INFO)
    first, *repeated = (
        continued((0.06, 0.09, 0.1), **share)
        for share in ({}, {"processes": 2}, {"folder": tmp_path}, {"processes": 2, "folder": tmp_path})
    )
    assert len(first.models) > 3
    for second in repeated:
        for item in fields(first):
            same(getattr(first, item.name), getattr(second, item.name))
    lines = [line for line in caplog.messages if line.startswith("searched from initial states")]
    assert [line.partition("; ")[2] for line in lines] == ["", "", *(f"{n} from the cache" for n in (2, 3))]
    # The cache has one file for each gap of the grid.
    assert len(list((tmp_path / "neighbours compared").iterdir())) == 2
