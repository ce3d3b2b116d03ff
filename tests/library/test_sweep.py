"""Runs over parameters: the numbers of single runs, on any number of cores, and errors that name their point."""

from itertools import product

import numpy as np
import pytest
import xarray

from burridge_knopoff import Chain, Model, continue_attractors, simulate, sweep
from tests.refused import refused

SHORT = {"transient": 50.0, "window": 50.0, "batches": 2}
A = [0.3, 0.05, 0.1]


def same_as_single(point, run):
    """Require that all numbers of a point of a sweep are those of a single run."""
    single = run.to_dataset().assign(kind=run.kind, period=run.period)
    for name, values in point.data_vars.items():
        assert np.array_equal(values, single[name], equal_nan=True), name


def test_a_sweep_has_the_numbers_of_single_runs():
    model = Model("nonlinear", coupling=1.2, v=0.12)
    runs = sweep(model, "plus", a=A, **SHORT)
    assert runs["a"].values.tolist() == A
    for a in A:
        same_as_single(runs.sel(a=a), simulate(model.at(a=a), "plus", **SHORT))
    assert {"mean_distance", "mean_distance_error", "lyapunov_exponent", "status"} <= set(runs.data_vars)
    assert runs["initial_velocity"].dims == ("a", "block")
    assert all(item.dims[0] == "a" for item in runs.data_vars.values())
    assert runs["mean_distance"].attrs["units"] == "1"


def test_the_variables_that_are_left_out_are_those_over_the_named_dimensions():
    run = simulate(Model("linearized", a=0.1), **SHORT).to_dataset()
    missing = set(run.variables) - set(sweep(Model("linearized"), a=0.1, **SHORT).variables)
    named = sweep.__doc__.partition("are left out")[2].partition(". ")[0]
    assert missing == {name for name, item in run.variables.items() if any(f"`{key}`" in named for key in item.dims)}


def test_a_model_and_the_number_of_cores():
    ways = [
        sweep(model, a=np.array(A), **SHORT, cores=cores)
        for model in (Model("linearized"), Model("linearized", a=0.9))
        for cores in (1, 3, None)
    ]
    assert all(way.identical(ways[0]) for way in ways)


@pytest.mark.parametrize(
    ("law", "axes"),
    [
        ("nonlinear", {"a": [0.3, 0.05], "v": [0.2, 0.1, 0.15]}),
        ("carlson_langer", {"coupling": [0.8, 1.3], "a": [0.3, 0.5], "sigma": [0.02, 0.2]}),
        ("linearized", {"mass": [1.0, 2.5], "threshold": [0.9, 1.1], "pulling": [0.7]}),
    ],
)
def test_a_grid_over_several_parameters_has_the_numbers_of_single_runs(law, axes):
    model = Model(law, a=0.08)
    runs = sweep(model, initial="plus", **axes, **SHORT)
    assert runs["mean_distance"].dims == tuple(axes)
    for values in product(*axes.values()):
        point = dict(zip(axes, values, strict=True))
        same_as_single(runs.sel(point), simulate(model.at(**point), initial="plus", **SHORT))


def test_the_number_of_one_block_is_a_dimension():
    model = Model("linearized", a=0.08)
    runs = sweep(model, initial="plus", **{"mass[3]": [1.0, 1.2], "coupling[1]": 1.1}, **SHORT)
    assert runs["mean_distance"].dims == ("mass_3",)
    assert runs["mass_3"].attrs["long_name"] == "parameter mass[3] of the model"
    for mass in (1.0, 1.2):
        run = simulate(model.at(**{"mass[3]": mass, "coupling[1]": 1.1}), initial="plus", **SHORT)
        assert runs["mean_distance"].sel(mass_3=mass).item() == run.mean_distance
    with refused("mass[4]"):
        sweep(model, **{"mass[4]": [1.0, 1.2]}, **SHORT)


@pytest.mark.parametrize("third", [1.1, [1.1, 1.3]])
def test_the_number_of_one_block_takes_precedence_over_a_sequence_for_all(third):
    """As in `Model.at`."""
    model, masses = Model("linearized", a=0.08), [1.0, 1.2]
    runs = sweep(model, initial="plus", mass=masses, **{"mass[3]": third}, **SHORT)
    assert runs["mean_distance"].dims == ("mass", "mass_3")[: 1 + isinstance(third, list)]
    for mass, single in product(masses, np.atleast_1d(third).tolist()):
        run = simulate(Model(model.law, mass=(mass, mass, single)), initial="plus", **SHORT)
        point = {"mass": mass, "mass_3": single} if "mass_3" in runs.dims else {"mass": mass}
        assert runs["mean_distance"].sel(point) == run.mean_distance
    with refused("mass[3]"):
        continue_attractors(model, mass=masses, samples=2, **{"mass[3]": 1.1})


def test_parameters_with_one_value_are_not_dimensions():
    runs = sweep(Model("carlson_langer"), a=0.3, v=[0.1, 0.2], sigma=0.05, coupling=1.1, **SHORT)
    assert runs["mean_distance"].dims == ("v",)
    assert (runs["a"].item(), runs.attrs["law_sigma"], runs.attrs["chain_coupling"]) == (0.3, 0.05, 1.1)
    same = sweep(Model("carlson_langer", a=0.3, sigma=0.05, coupling=1.1), v=[0.1, 0.2], **SHORT)
    assert runs.identical(same)


@pytest.mark.parametrize("number", [0.08, np.float64(0.08), np.array(0.08)])
def test_one_point_has_the_numbers_of_one_run(number):
    runs, run = (
        sweep(Model("linearized"), "plus", a=number, **SHORT),
        simulate(Model("linearized", a=0.08), "plus", **SHORT),
    )
    assert (runs["a"].item(), runs["mean_distance"].shape) == (0.08, ())
    assert runs["mean_distance"].item() == run.mean_distance
    assert np.array_equal(runs["lyapunov_exponent"], run.lyapunov_exponent)


def test_a_run_that_does_not_complete_is_included():
    runs = sweep(Model("linearized", contact="symmetric"), a=[0.1, 1.9], transient=0.0, window=1e4)
    assert runs["status"].values.tolist() == [0, 3]
    assert np.isnan(runs["mean_distance"].values).tolist() == [False, True]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"a": []}, "a"),
        ({"a": [0.1, -0.1]}, "a: -0.1"),
        ({"a": [0.1, 0.2, 0.1]}, "a: 0.1 twice"),
        ({"a": [0.1, "x"]}, "a: 'x'"),
        ({"a": [[0.1, 0.2], [0.3, 0.4]]}, "a: [[0.1, 0.2], [0.3, 0.4]]"),
        ({"v": np.array([[0.1]])}, "v: array([[0.1]])"),
        ({"a": [0.1, 2.0], "solver": "map"}, "a = 2.0: solver: 'map'"),
        ({"colour": "blue"}, "colour"),
        ({"lyapunov_exponents": 7}, "lyapunov_exponents: 7"),
        ({"model": Model("linearized", blocks=4)}, "blocks: 4"),
        ({"chain": Chain(3)}, "chain"),
        ({"v": [0.1, 0.0]}, "v: 0.0"),
        ({"v": [0.1, 0.1]}, "v: 0.1 twice"),
        ({"sigma": [0.1]}, "sigma"),
        ({"coupling": [1.0, -1.0]}, "chain.coupling: -1.0"),
        ({"model": Model("linearized", coupling=(1.0, 2.0)), "coupling": [1.0, 2.0]}, "coupling: (1.0, 2.0)"),
        ({"a": [0.1, 1.9], "threshold": [1.0, 1.2], "solver": "map"}, "a = 1.9, threshold = 1.2: solver: 'map'"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with refused(words):
        sweep(**{"model": Model("linearized"), "a": [0.1], **SHORT, **options})


def test_a_sweep_is_a_dataset_that_can_be_written(tmp_path):
    runs = sweep(Model("linearized"), a=A, **SHORT)
    runs.to_netcdf(tmp_path / "sweep.nc")
    with xarray.open_dataset(tmp_path / "sweep.nc") as again:
        assert again.mean_distance.equals(runs.mean_distance)
