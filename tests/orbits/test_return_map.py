"""How returns change with a, next to where a law ends."""

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, Model
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.orbits.orbit import OrbitError, model_at
from burridge_knopoff.orbits.return_map import ReturnMap
from burridge_knopoff.orbits.symmetry import Symmetry

#: Friction of a block that begins to slip is a: no more than 1 is a law.
LAW = FormulaLaw(1.0, "a/(1 + 0.08*u)", name="own")


def test_the_derivative_by_a_is_taken_from_the_side_that_the_law_allows():
    def derivative(a):
        model = Model(Chain(3), LAW.at(a))
        start = model.begin(PAPER_STATES["plus"])
        mapping = ReturnMap(model, Symmetry.ASYMMETRIC)
        end = mapping.end(start, 1.0)
        return mapping.a_derivative(start, 1.0, end, mapping.event_rows()[:, 1:])

    assert np.abs(derivative(1.0)).max() > 0.05
    assert derivative(1.0) == pytest.approx(derivative(1.0 - 1e-6), abs=1e-4)


def test_what_a_law_does_not_allow_is_no_orbit():
    with pytest.raises(OrbitError, match="above 0 and at most 1"):
        model_at(Model(Chain(3), LAW), 1.001)
