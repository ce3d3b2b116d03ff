"""Derivatives of returns with respect to a: near the end of the range of a law, and where stops change."""

import numpy as np
import pytest

from burridge_knopoff import ChainState, FormulaLaw, Model
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at
from burridge_knopoff.periodic_orbits.parameter_line import line_along_a
from burridge_knopoff.periodic_orbits.return_map import ReturnMap
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from tests.normal_forms import CRITICAL, TWO, MapModel, NormalForm, on_line
from tests.refused import refused

#: The friction at the start of a slip is a, which must not exceed 1.
LAW = FormulaLaw("a/(1 + 0.08*u)", name="own", a=1.0)


def test_the_derivative_by_a_is_taken_from_the_side_that_the_law_allows():
    def derivative(a):
        model = Model(LAW.at(a=a))
        start = model.begin(PAPER_STATES["plus"])
        mapping = ReturnMap(model, Symmetry.ASYMMETRIC)
        end = mapping.end(start, 1.0)
        return mapping.parameter_derivative(start, 1.0, end, mapping.event_rows()[:, 1:], line_along_a(model.chain))

    assert np.abs(derivative(1.0)).max() > 0.05
    assert derivative(1.0) == pytest.approx(derivative(1.0 - 1e-6), abs=1e-4)


def test_there_is_no_orbit_outside_the_range_of_a_law():
    with pytest.raises(OrbitError, match="above 0 and at most 1"):
        model_at(Model(LAW), 1.001)


def derivative_at(mu, form):
    """Return the derivative of x_1 after an iteration by a, at CRITICAL + μ."""
    model = MapModel(form.at(CRITICAL + mu))
    start = ChainState(np.zeros(2), np.full(2, 0.5), np.zeros(2, dtype=bool))
    mapping = ReturnMap(model, Symmetry.ASYMMETRIC)
    end = mapping.end(start, 1.0)
    return mapping.parameter_derivative(start, 1.0, end, mapping.event_rows()[:, 1:], line_along_a(TWO))[0]


def kinked(borders):
    """Return the map x_1 → 2μ, or −3μ for μ < 0."""
    return on_line(lambda x, mu: 2.0 * mu if mu > 0.0 else -3.0 * mu, lambda x, mu: 0.0, borders=borders)


@pytest.mark.parametrize(("mu", "expected"), [(5e-8, 2.0), (5e-9, 2.0), (-5e-8, -3.0), (-5e-9, -3.0)])
def test_the_derivative_by_a_is_that_of_the_same_events(mu, expected):
    """Beyond μ = 0, which is within the step of the finite difference, there is another stop."""
    form = kinked(lambda x, mu: np.array([1.0, mu]))
    assert derivative_at(mu, form) == pytest.approx(expected, rel=1e-6)


def test_the_derivative_by_a_is_that_of_the_same_events_of_each_block():
    """Their order among blocks may change."""

    class Reordered(NormalForm):
        def stops(self, x):
            return [0, 1] if self.mu > -5e-8 else [1, 0]

    form = Reordered(lambda x, mu: np.array([2.0 * mu, 0.0]), lambda x, mu: np.zeros((2, 2)))
    assert derivative_at(-5e-8 - 1e-12, form) == pytest.approx(2.0, rel=1e-6)


@pytest.mark.parametrize("width", [5e-8, 1e-14])
def test_the_step_of_the_derivative_by_a_becomes_as_short_as_the_range_of_the_events(width):
    """A block stops for |μ| < width only, where the slope is 1; a step below 1e-13 is not tried."""
    form = on_line(
        lambda x, mu: mu if abs(mu) < width else 9.0 * mu,
        lambda x, mu: 0.0,
        borders=lambda x, mu: np.array([1.0, width - abs(mu)]),
    )
    if width > 1e-13:
        assert derivative_at(0.0, form) == pytest.approx(1.0, rel=1e-6)
    else:
        with refused("a = 0.1", error=OrbitError):
            derivative_at(0.0, form)
