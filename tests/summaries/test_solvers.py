"""Comparison of solvers: differences and orders of events are those of the runs; other files are rejected."""

import numpy as np
import pytest

from burridge_knopoff import Settings, simulate
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.figures import solvers as figure
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.summaries.points import Grid
from burridge_knopoff.summaries.solvers import summarize
from tests.grids import PAPER_MODELS
from tests.refused import refused

SOLVERS = {"linearized": ["map", "series", "rk4"], "nonlinear": ["series", "rk4"]}
A = {"0.0800": 0.08, "0.2000": 0.2}


def settings(solver):
    exponents = {"lyapunov_exponents": 0, "step": 0.01} if solver == "rk4" else {}
    return {"solver": solver, "transient": 200.0, "window": 300.0, "batches": 3, **exponents}


@pytest.fixture(scope="module")
def runs():
    pairs = [(law, solver) for law in SOLVERS for solver in SOLVERS[law]]
    return {(*pair, name): simulate(pair[0], a, "plus", **settings(pair[1])) for pair in pairs for name, a in A.items()}


@pytest.fixture
def files(tmp_path, runs):
    for (law, solver, name), run in runs.items():
        is_main = solver == SOLVERS[law][0]
        folder = tmp_path / "points" if is_main else tmp_path / "solvers" / solver
        write_point(run, folder / law / "plus" / f"a{name}.nc")
    main_settings = {law: Settings(**settings(solvers[0])) for law, solvers in SOLVERS.items()}
    grid = Grid(tmp_path / "points", {"plus": PAPER_STATES["plus"]}, {"a": A}, main_settings, PAPER_MODELS)
    other_grids = {}
    for solver in ("series", "rk4"):
        law_settings = {law: Settings(**settings(solver)) for law, solvers in SOLVERS.items() if solver in solvers[1:]}
        other_grids[solver] = grid.copy_with(tmp_path / "solvers" / solver, law_settings)
    return grid, other_grids


def test_the_runs_are_compared(files, runs):
    dataset = summarize(*files, 0.01)
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


def test_a_solver_that_does_not_accept_a_law_has_no_numbers(files):
    none = summarize(*files, 0.01).sel(law="nonlinear", solver="map")
    for name in ("status", "step_count", "event_order_count"):
        assert (none[name] == -1).all()
    for name in ("mean_distance", "mean_distance_error", "end_time", "difference", "event_order_time"):
        assert np.isnan(none[name]).all()


def test_a_file_of_another_solver_is_refused(files):
    grid, other_grids = files
    series, rk4 = (other_grids[solver].path("linearized", "plus", "0.0800") for solver in ("series", "rk4"))
    series.write_bytes(rk4.read_bytes())
    with refused("series/linearized/plus/a0.0800.nc", "solver: got rk4", error=BadFile):
        summarize(grid, other_grids, 0.01)


def test_the_figure_draws_every_solver(files):
    dataset = summarize(*files, 0.01)
    panels = figure.draw(dataset).axes
    curves = [line.get_xdata().tolist() for line in panels[0].get_lines() if len(line.get_xdata()) == 2]
    for solver in SOLVERS["linearized"]:
        assert dataset["mean_distance"].sel(law="linearized", solver=solver, initial="plus").values.tolist() in curves
    symbols = [line for line in panels[1].get_lines() if line.get_marker() not in ("|", "None")]
    assert len(symbols) == len(SOLVERS["linearized"]) - 1
    assert panels[4].get_title(loc="left") == "(e) nonlinear law: difference"
