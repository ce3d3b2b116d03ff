"""Boxes of sampled states whose velocities are formulas of the driver velocity."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from burridge_knopoff import Model
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.distances import distance_form
from burridge_knopoff.model.sampling import velocity_range
from tests.refused import refused

FORMULAS = {"v - 2": lambda v: v - 2, "1/(v - 1)": lambda v: 1 / (v - 1), "-sqrt(v)": lambda v: -math.sqrt(v)}


@pytest.mark.parametrize("formula", FORMULAS)
@pytest.mark.parametrize("v", [0.01, 0.3, 2.5])
def test_an_end_is_the_value_of_its_formula(formula, v):
    """A formula may have no value at a v at which it is not asked for, here at 1."""
    settings = SearchSettings(velocity=[formula, 10.0])
    assert settings.velocity == (formula, 10.0)
    model = Model("linearized", a=0.1, blocks=1, v=v, contact="symmetric")
    assert np.allclose(velocity_range(settings.velocity, model, "velocity"), (FORMULAS[formula](v), 10.0), rtol=1e-15)


def test_a_formula_is_refused_where_it_has_no_value():
    with refused("velocity[0]", "1/(v - 1)", "finite"):
        velocity_range(("1/(v - 1)", 3.0), SimpleNamespace(v=1.0), "velocity")


@pytest.mark.parametrize("end", ["w", "v-", "v" + " + v" * 100, "u"])
def test_what_is_no_formula_of_v_is_refused_at_once(end):
    with refused("velocity[1]"):
        SearchSettings(velocity=[0.0, end])


def test_springs_have_the_length_of_formulas():
    assert distance_form({"distance": "9/r**3"}, "springs")
    with refused("springs.distance", "400 characters"):
        distance_form({"distance": "9/r" + " + 0/r" * 100}, "springs")
