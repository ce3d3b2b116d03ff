"""A map of basins in one call: the settings are the config's defaults, and the labels those of whole runs."""

import inspect
from itertools import product

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, basin_map, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from tests.refused import refused


def test_defaults_are_those_of_the_config():
    defaults = {"pixels": 64, "samples": 100, "seed": 1, "cores": None}
    defaults |= {"start": "moving"}
    parameters = inspect.signature(basin_map).parameters
    assert {name: parameters[name].default for name in defaults} == defaults


def test_labels_are_those_of_whole_runs():
    basins, attractors = basin_map(
        Model("linearized", a=0.08), pixels=3, samples=100, first_position=(-1.2, 1.2), last_position=(-1.5, 0.5)
    )
    part = attractors.sel(law="linearized", a=0.08)
    mean = dict(zip(part["branch"].values.tolist(), part["mean_distance"].values.tolist(), strict=True))
    plane = basins.isel(map=0)
    assert plane["branch"].shape == (3, 3)
    assert len(np.unique(plane["branch"])) > 1
    minus = PAPER_STATES["minus"]
    for last, first in product(plane["last_position"].values, plane["first_position"].values):
        state = InitialState("pixel", (first, minus.position[1], last), minus.velocity)
        run = simulate(Model("linearized", a=0.08), state, transient=3000, window=1000, batches=4, lyapunov_exponents=0)
        branch = plane["branch"].sel(first_position=first, last_position=last).item()
        assert run.mean_distance == pytest.approx(mean[branch], abs=2e-3)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"model": Model("linearized")}, "a: missing"),
        ({"model": Model("linearized", a=0.0)}, "transient"),
        ({"initial": "middle"}, "initial: 'middle'"),
        ({"windows": 10.0}, "windows"),
        ({"model": Model("linearized", a=0.08, blocks=4)}, "blocks: 4"),
        ({"initial": InitialState("back", 0.0, (0.1, 0.1, -0.1))}, "velocity: -0.1"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with refused(words):
        basin_map(**{"model": Model("linearized", a=0.08), "pixels": 2, "samples": 3, **options})


@pytest.mark.slow
def test_a_map_for_any_model():
    """Labels of a map for a law by formula in an asymmetric chain, and of its equivalent short form."""
    law = FormulaLaw("1/(1 + a*u)**p", a=0.1, p=1.2)
    chain = Chain(3, coupling=(1.0, 1.2))
    options = {"pixels": 4, "samples": 10, "transient": 1000.0, "window": 1000.0}
    basins, attractors = basin_map(Model(law, chain=chain, v=0.12), **options)
    again = basin_map(Model(law.at(a=0.5), a=0.1, coupling=(1.0, 1.2), v=0.12), **options)
    assert basins.identical(again[0])
    assert attractors.identical(again[1])
    assert attractors["law"].values.tolist() == ["formula"]
    assert basins["law"].values.tolist() == ["formula"]
    assert (attractors["side"] == 0).all()
    assert set(np.unique(attractors["symmetry"])) <= {-1, 2}
    assert basins["undetermined_count"].item() < 8
