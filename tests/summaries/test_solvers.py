"""Comparison of solvers: differences and orders of events are those of the runs; other files are rejected."""

import numpy as np
import pytest

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.summaries.solvers import compare_solvers
from tests.grids import grid_of
from tests.refused import refused

SOLVERS = {"linearized": ["map", "series", "rk4"], "nonlinear": ["series", "rk4"]}
A = {"0.0800": 0.08, "0.2000": 0.2}


def settings(solver):
    exponents = {"lyapunov_exponents": 0, "step": 0.01} if solver == "rk4" else {}
    return {"solver": solver, "transient": 200.0, "window": 300.0, "batches": 3, **exponents}


@pytest.fixture(scope="module")
def runs():
    pairs = [(law, solver) for law in SOLVERS for solver in SOLVERS[law]]
    return {
        (*pair, name): simulate(Model(pair[0], a=a), "plus", **settings(pair[1]))
        for pair in pairs
        for name, a in A.items()
    }


@pytest.fixture
def study(tmp_path, runs):
    """The keys of a study, and the folder of its results."""
    part, _ = grid_of(tmp_path, ["plus"], A, **settings("series"))
    config = {
        **part.config,
        "solver": {law: solvers[0] for law, solvers in SOLVERS.items()},
        "lyapunov_exponents": 3,
        "a_digits": 4,
        "solvers": {"a": [*A.values()], "step": 0.01},
    }
    for (law, solver, name), run in runs.items():
        folder = "points" if solver == SOLVERS[law][0] else f"solvers/{solver}"
        write_point(run, tmp_path / folder / law / "plus" / f"a{name}.nc")
    return config, tmp_path


def test_the_runs_are_compared(study, runs):
    dataset = compare_solvers(*study)
    assert dict(dataset.sizes) == {"law": 2, "solver": 3, "initial": 1, "a": 2}
    assert dataset.attrs["solver_linearized"] == "map"
    for (law, solver, name), run in runs.items():
        reference = runs[law, SOLVERS[law][0], name]
        point = dataset.sel(law=law, solver=solver, initial="plus", a=A[name])
        assert point["mean_distance"].item() == run.mean_distance
        assert point["difference"].item() == run.mean_distance - reference.mean_distance
        assert point["step_count"].item() == run.step_count
        assert point["status"].item() == 0
        expected = 0.0 if run is reference else np.hypot(run.mean_distance_error, reference.mean_distance_error)
        assert point["difference_error"].item() == expected
        if run is reference:
            assert point["event_order_count"].item() == run.event_count
            assert point["event_order_time"].item() == run.end_time == 500.0
    torus = dataset.sel(law="linearized", initial="plus", a=0.08)
    assert abs(torus["difference"].sel(solver="series")) < 1e-11
    assert torus["event_order_time"].sel(solver="series") == 500.0
    assert 1e-9 < abs(torus["difference"].sel(solver="rk4")) < 1e-3
    # In chaos a time-stepping solution soon has a different order of events.
    assert 20.0 < dataset["event_order_time"].sel(law="linearized", solver="rk4", initial="plus", a=0.2) < 500.0


def test_a_solver_that_does_not_accept_a_law_has_no_numbers(study):
    none = compare_solvers(*study).sel(law="nonlinear", solver="map")
    for name in ("status", "step_count", "event_order_count"):
        assert (none[name] == -1).all()
    for name in ("mean_distance", "mean_distance_error", "end_time", "difference", "event_order_time"):
        assert np.isnan(none[name]).all()


def test_a_file_of_another_solver_is_refused(study):
    series, rk4 = (study[1] / f"solvers/{solver}/linearized/plus/a0.0800.nc" for solver in ("series", "rk4"))
    series.write_bytes(rk4.read_bytes())
    with refused("series/linearized/plus/a0.0800.nc", "solver: rk4", error=BadFile):
        compare_solvers(*study)
