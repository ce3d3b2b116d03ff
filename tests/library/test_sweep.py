"""Runs along a: the numbers of single runs, on any number of cores, and errors that name their a."""

import numpy as np
import pytest
import xarray

from burridge_knopoff import Chain, Model, law_of, simulate, sweep
from tests.refused import refused

SHORT = {"transient": 50.0, "window": 50.0, "batches": 2}
A = [0.3, 0.05, 0.1]


def test_the_numbers_are_those_of_single_runs():
    options = {"chain": Chain(3, coupling=1.2), "v": 0.12, **SHORT}
    runs = sweep("nonlinear", A, "plus", **options)
    assert runs["a"].values.tolist() == A
    for a in A:
        run = simulate("nonlinear", a, "plus", **options)
        for name, values in runs.sel(a=a).drop_vars("status").data_vars.items():
            assert np.array_equal(values, getattr(run, name), equal_nan=True), name
    assert {"mean_distance", "mean_distance_error", "lyapunov_exponent", "status"} <= set(runs.data_vars)
    assert all(item.dims[0] == "a" for item in runs.data_vars.values())
    assert runs["mean_distance"].attrs["units"] == "1"


def test_a_model_and_the_number_of_cores():
    ways = [
        sweep(law, np.array(A), **SHORT, cores=cores)
        for law in ("linearized", Model(Chain(3), law_of("linearized", 0.9)))
        for cores in (1, 3, None)
    ]
    assert all(way.identical(ways[0]) for way in ways)


def test_a_run_that_does_not_complete_is_there():
    runs = sweep("linearized", [0.1, 1.9], contact="symmetric", transient=0.0, window=1e4)
    assert runs["status"].values.tolist() == [0, 3]
    assert np.isnan(runs["mean_distance"].values).tolist() == [False, True]


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"a": []}, "a: no value"),
        ({"a": [0.1, -0.1]}, "a: -0.1"),
        ({"a": [0.1, 0.2, 0.1]}, "a: got 0.1 twice"),
        ({"a": [0.1, "x"]}, "a: 'x'"),
        ({"a": [0.1, 2.0], "solver": "map"}, "a = 2.0: solver: 'map'"),
        ({"cores": 0}, "cores: 0"),
        ({"colour": "blue"}, "colour: not a setting"),
        ({"lyapunov_exponents": 7}, "lyapunov_exponents: 7"),
        ({"chain": Chain(4)}, "blocks: 4"),
        ({"law": Model(Chain(3), law_of("linearized", 0.1)), "v": 0.2}, "beside a model"),
    ],
)
def test_bad_input_is_refused_in_one_line(options, words):
    with refused(words, match="expected|not a setting"):
        sweep(**{"law": "linearized", "a": [0.1], **SHORT, **options})


def test_a_sweep_is_a_dataset_that_can_be_written(tmp_path):
    runs = sweep("linearized", A, **SHORT)
    runs.to_netcdf(tmp_path / "sweep.nc")
    with xarray.open_dataset(tmp_path / "sweep.nc") as again:
        assert again.mean_distance.equals(runs.mean_distance)
