"""When J settles: hand-made samples."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.running.simulation import run, simulate
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.summaries import lyapunov
from burridge_knopoff.summaries.mean_distance import LEVELS, settling_time, summarize
from tests.grids import grid_of
from tests.sections import MOTION

TIME = np.array([0.0, 5.0, 10.0, 15.0])


@pytest.mark.parametrize(
    ("distance", "expected"),
    [
        ([1.0, 0.5, 0.05, 0.005], 15.0),
        ([1.0, 0.005, 0.05, 0.005], 15.0),  # comes back once
        ([1.0, 0.005, 0.001, 0.0], 5.0),
        ([0.001, 0.001, 0.001, 0.001], 0.0),
        ([0.001, 0.001, 0.001, 0.01], np.nan),  # at the level is not below it
        ([0.001, 0.001, 0.001, np.nan], np.nan),
        ([0.001, np.nan, 0.001, 0.001], 10.0),
    ],
)
def test_settling_time(distance, expected):
    assert settling_time(TIME, np.array(distance), [0.01]) == pytest.approx([expected], nan_ok=True)


def test_settling_times_of_runs(tmp_path):
    settings = {"transient": 1500.0, "window": 100.0, "batches": 2}
    grid = grid_of(tmp_path, ["minus"], {"0.0800": 0.08}, **settings)
    runs = {}
    for _, (law, initial, a) in grid:
        runs[law] = simulate(law, 0.08, initial, **settings)
        if law == "nonlinear":
            runs[law] = dataclasses.replace(runs[law], status="step_limit")
        write_point(runs[law], grid.path(law, initial, a))
    found = summarize(grid, 1e-6)["settling_time"]
    assert found.sel(law="linearized").values.ravel().tolist() == settling_time(
        runs["linearized"].time, runs["linearized"].distance, LEVELS
    )
    # J at synchrony dies out like the transverse multiplier to the power of the number of periods.
    settled = found.sel(law="linearized", initial="minus", a=0.08)
    assert 500.0 < settled.sel(level=1e-6).item() < 1500.0
    assert settled.sel(level=1e-2) <= settled.sel(level=1e-3) < settled.sel(level=1e-6)
    assert np.isnan(found.sel(law="nonlinear")).all()


@pytest.mark.parametrize(("thresholds", "synchronized"), [([1.0, 1.1, 1.0], 1), ([1.0, 1.0, 1.1], 0)])
def test_only_a_chain_that_is_its_own_mirror_image_synchronizes(tmp_path, thresholds, synchronized):
    """Whatever J is: here runs of the third block have been given that of synchrony."""
    settings = {"transient": 50.0, "window": 50.0, "batches": 2}
    chain = {"coupling": 1.0, "pulling": "neighbours", "threshold": thresholds, "ends": "open"}
    models = {"laws": {"linearized": {}}, "chain": chain}
    grid = grid_of(tmp_path, ["minus"], {"0.0800": 0.08}, models, **settings)
    for _, (law, initial, a) in grid:
        trajectory = run(grid.model(law, grid.a[a]), grid.initial[initial], grid.settings[law])
        same = dataclasses.replace(trajectory, mean_distance=1e-9, crossing_velocity=np.full(20, 0.1))
        same = dataclasses.replace(same, crossing_direction=np.ones(20, np.int8), crossing_time=np.arange(20.0))
        same = dataclasses.replace(same, lyapunov_exponent=np.array([0.0, -0.1, -0.2]))
        write_point(same, grid.path(law, initial, a))
    found = summarize(grid, 1e-6)["synchronized"]
    assert found.values.ravel().tolist() == [synchronized]
    assert ("comment" in found.attrs) == (not synchronized)
    kind = lyapunov.summarize(grid, 3, 1e-6, MOTION)["kind"]
    assert kind.item() == (MotionKind.SYNCHRONIZED if synchronized else MotionKind.PERIODIC)
