"""Titles name the parameters of a model that are not the paper's."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import (
    Chain,
    FormulaLaw,
    Model,
    basin_map,
    continue_attractors,
    find_attractors,
    limit_cycle,
    plot,
    simulate,
    sweep,
)
from burridge_knopoff.figures.model_words import fixed_numbers, model_title
from tests.figures.test_parameter_panels import summary

QUICK = {"transient": 300.0, "window": 300.0}
OTHER = {"v": 0.2, "coupling": 1.5}
WORDS = "linearized law, $a=0.08$, $v=0.2$, coupling 1.5"


def title(figure, panel=0):
    return figure.axes[panel].get_title(loc="left").replace("\n", " ")


@pytest.mark.parametrize(
    ("model", "axes", "words"),
    [
        (Model("linearized", a=0.08), (), "linearized law, $a=0.08$"),
        (Model("linearized", a=0.08, blocks=5), ("a",), "linearized law"),
        (Model("linearized", a=0.08, coupling=1.5, v=0.2), (), WORDS),
        (Model("linearized", a=0.08, coupling=1.5, v=0.2), ("v", "a"), "linearized law, coupling 1.5"),
        (Model("carlson_langer", a=3.0), (), "carlson_langer law, $a=3$"),
        (Model("carlson_langer", a=3.0, sigma=0.3), (), r"carlson_langer law, $a=3$, $\sigma=0.3$"),
        (Model(FormulaLaw("1 - p*a*u", a=0.1, p=2.0)), (), "formula law, $a=0.1$, $p=2$"),
        (Model("linearized", a=0.08, mass=(1.0, 1.0, 1.2)), ("a",), "linearized law, mass[3] 1.2"),
        (Model("linearized", a=0.08, mass=(1.0, 1.0, 1.2)), ("a", "mass[3]"), "linearized law"),
        (Model("linearized", a=0.1, blocks=2, pulling=(1.0, 0.0)), ("a",), "linearized law, pulling not uniform"),
    ],
)
def test_a_model(model, axes, words):
    assert model_title(model, axes) == words


def test_random_numbers_of_a_model_and_of_its_run():
    chain = Chain(3, threshold={"random": "uniform", "low": 0.9, "high": 1.0, "seed": 1})
    run = simulate(Model("linearized", a=0.08, chain=chain), "plus", **QUICK)
    assert model_title(run.model) == "linearized law, $a=0.08$, threshold not uniform"
    assert fixed_numbers(run.to_dataset()) == ["$a=0.08$", "threshold not uniform"]


def test_a_run_its_point_and_its_orbit():
    run = simulate(Model("linearized", a=0.08, **OTHER), "plus", **QUICK)
    assert plot(run)._suptitle.get_text() == f"plus, {WORDS}"
    assert title(plot(run.to_dataset())) == "(a) velocities: plus, $a=0.08$, linearized law, $v=0.2$, coupling 1.5"
    orbit = limit_cycle(run.model, run.final, settling=1000.0)
    assert title(plot(orbit), 1).endswith(WORDS)


def test_attractors_and_basins():
    search = {"samples": 8, **QUICK}
    assert title(plot(find_attractors(Model("linearized", a=0.08, **OTHER), **search))) == WORDS
    basins, attractors = basin_map(Model("linearized", a=0.08, **OTHER), pixels=4, **search)
    assert title(plot((basins, attractors))) == WORDS
    assert title(plot(attractors)) == "(a) linearized law, $v=0.2$, coupling 1.5"


@pytest.mark.slow
def test_attractors_along_a_parameter():
    data = continue_attractors(Model("linearized"), a=[0.08, 0.09], v=0.2, samples=8, cores=1, **QUICK)
    assert [title(plot(data), k) for k in (0, 1)] == [
        "(a) linearized law, $v=0.2$",
        "(b) linearized law, $v=0.2$: basin fractions",
    ]


def test_a_sweep():
    runs = sweep(
        [Model("linearized"), Model("nonlinear")], ["plus", "minus"], a=[0.05, 0.1], v=[0.1, 0.2], batches=2, **QUICK
    )
    assert title(plot(runs.sel(v=0.1))) == ""
    assert title(plot(runs.sel(v=0.2))) == title(plot(runs.isel(v=[1]))) == "$v=0.2$"
    assert title(plot(runs.isel(a=[0]))) == "$a=0.05$"
    assert title(plot(runs.sel(law="nonlinear", initial="plus", a=0.1))) == "nonlinear law, from plus, $a=0.1$"
    assert title(plot(runs.sel(law="nonlinear", initial="plus"))) == "nonlinear law, plus"


def test_a_sweep_with_a_parameter_of_the_law_and_of_a_block():
    runs = sweep(Model("carlson_langer"), "plus", a=[1.0, 2.0], sigma=0.3, **{"mass[3]": 1.2}, batches=2, **QUICK)
    assert title(plot(runs)) == r"carlson_langer law, from plus, $\sigma=0.3$, mass[3] 1.2"
    masses = summary(laws=("linearized",), states=("plus",), mass_3=[1.0, 1.2], a=[0.1, 0.2])
    assert title(plot(masses.sel(mass_3=1.2))) == "linearized law, from plus, mass[3] 1.2"
    assert title(plot(masses.sel(a=0.1))) == "linearized law, from plus, $a=0.1$"
    assert title(plot(masses.assign_coords(v=0.2))) == "linearized law, plus, $v=0.2$"


def test_other_coordinates_are_no_parameters():
    data = xr.Dataset(coords={"a": [0.1], "batch": [5.0], "block": [1], "time": np.array(2.0), "law": "linearized"})
    assert fixed_numbers(data) == ["$a=0.1$"]
