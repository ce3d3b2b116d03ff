"""Derivatives of returns with respect to a, near the end of the range of a law."""

from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, FormulaLaw, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.periodic_orbits import return_map
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.return_map import ReturnMap
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

#: The friction at the start of a slip is a, which must not exceed 1.
LAW = FormulaLaw(1.0, "a/(1 + 0.08*u)", name="own")


def test_the_derivative_by_a_is_taken_from_the_side_that_the_law_allows():
    def derivative(a):
        model = Model(Chain(3), LAW.at(a))
        start = model.begin(PAPER_STATES["plus"])
        mapping = ReturnMap(model, Symmetry.ASYMMETRIC)
        end = mapping.end(start, 1.0)
        return mapping.parameter_derivative(start, 1.0, end, mapping.event_rows()[:, 1:], line_along_a(model.chain))

    assert np.abs(derivative(1.0)).max() > 0.05
    assert derivative(1.0) == pytest.approx(derivative(1.0 - 1e-6), abs=1e-4)


def test_there_is_no_orbit_outside_the_range_of_a_law():
    with pytest.raises(OrbitError, match="above 0 and at most 1"):
        model_at(Model(Chain(3), LAW), 1.001)


def test_the_derivative_by_a_is_that_of_the_same_events_of_each_block(monkeypatch):
    model = Model(Chain(3), law_of("linearized", 0.1))
    end = ChainState(np.zeros(3), np.zeros(3), np.zeros(3, dtype=bool))
    runs = [
        (1e-7, [(0.1, 0, 1), (0.2, 0, 0), (0.3, 1, 0)]),  # one event more
        (1e-7, [(0.1, 0, 0)]),
        (1e-8, [(0.1, 0, 1), (0.2, 1, 0)]),  # of another kind
        (1e-8, [(0.3, 1, 0), (0.4, 0, 0)]),  # of two blocks, in another order
    ]
    left = iter(runs)

    def ran(events, after):
        """Return a stand-in for a runner that has ended with these events."""
        columns = tuple(np.array(events).reshape(-1, 3).T)
        return SimpleNamespace(events=lambda: columns, state_after=lambda start, time: after)

    def runner(model, keep_events):
        size, events = next(left)
        assert abs(model.a - 0.1) == pytest.approx(size)
        return ran(events, ChainState(np.full(3, -3e-8), np.zeros(3), end.stuck))

    monkeypatch.setattr(return_map, "Runner", runner)
    mapping = ReturnMap(model, Symmetry.ASYMMETRIC)
    derivative = mapping.parameter_derivative(end, 1.0, end, np.array([[0, 0], [1, 0]]), line_along_a(model.chain))
    # The last run is at an a smaller by 1e-8.
    assert derivative == pytest.approx([3.0, 3.0, 3.0, 0.0, 0.0, 0.0])
    monkeypatch.setattr(return_map, "Runner", lambda model, keep_events: ran([], end))
    assert (
        mapping.parameter_derivative(end, 1.0, end, np.zeros((0, 2)), line_along_a(model.chain)).tolist() == [0.0] * 6
    )
