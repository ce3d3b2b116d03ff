"""Attractors along a: those found at one value seed the others, and no result depends on the number of processes."""

import logging
from dataclasses import fields

import numpy as np
import pytest

from burridge_knopoff import Model, SearchSettings
from burridge_knopoff.basins import fractions
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.motion.settings import MOTION


def models(a_values):
    return [Model("linearized", a=a) for a in a_values]


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
