"""Verdicts on agreement follow the data, both ways."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.seal import BadFile
from burridge_knopoff.simulation import simulate
from burridge_knopoff.summaries import agreement, lyapunov, mean_distance
from tests.grids import grid_of
from tests.sections import AGREEMENT, MOTION


def compare(grid):
    return agreement.summarize(grid, lyapunov.summarize(grid, 3, 1e-6, MOTION), 1e-6, AGREEMENT)


def written(folder, change=lambda law, trajectory: trajectory):
    """Write a grid of one initial state and two a, with altered nonlinear points if asked."""
    settings = {"transient": 2000.0, "window": 400.0, "batches": 4}
    grid = grid_of(folder, ["minus"], {"0.0500": 0.05, "0.0800": 0.08}, **settings)
    for _, (law, initial, a) in grid:
        trajectory = simulate(law, grid.a[a], initial, **settings)
        write_point(change(law, trajectory), grid.path(law, initial, a))
    return grid


def test_two_synchronized_laws_agree(tmp_path):
    dataset = compare(written(tmp_path))
    assert (dataset["agrees"] == 1).all()
    assert (dataset["kind"] == 0).all()
    assert np.isnan(dataset["parting_a"].item())
    assert agreement.digest(dataset) == "minus: the laws agree at all 2 values of a that were compared, 0.05 to 0.08.\n"


def test_altered_data_changes_the_verdict(tmp_path):
    def change(law, trajectory):
        if law == "nonlinear" and trajectory.friction.a == 0.08:
            return dataclasses.replace(trajectory, mean_distance=0.2)
        return trajectory

    dataset = compare(written(tmp_path, change))
    assert dataset["agrees"].values.tolist() == [[1, 0]]
    assert dataset["parting_a"].item() == 0.08
    assert "agree up to a = 0.05 and part at a = 0.08" in agreement.digest(dataset)


def test_a_run_without_result_agrees_with_nothing(tmp_path):
    def change(law, trajectory):
        if law == "linearized":
            return dataclasses.replace(trajectory, status="step_limit", mean_distance=np.nan)
        return trajectory

    grid = written(tmp_path, change)
    dataset = compare(grid)
    assert (dataset["agrees"] == -1).all()
    assert (dataset["same_kind"] == -1).all()
    assert np.isnan(dataset["parting_a"].item())
    assert "2 values of a are undetermined: a run did not complete," in agreement.digest(dataset)
    assert agreement.table(dataset).count("undetermined") == 4
    assert (dataset["kind"].sel(law="linearized") == -1).all()
    means = mean_distance.summarize(grid, 1e-6)
    assert np.isnan(means["mean_distance"].sel(law="linearized")).all()
    assert (means["synchronized"].sel(law="linearized") == 0).all()
    assert (means["status"].sel(law="linearized") == 1).all()


def test_a_missing_point_is_named(tmp_path):
    grid = written(tmp_path)
    grid.path("nonlinear", "minus", "0.0800").unlink()
    with pytest.raises(
        BadFile, match=r"nonlinear/minus/a0\.0800\.nc: is missing; remake it: snakemake -c2 -R .*/a0\.0800\.nc$"
    ):
        mean_distance.summarize(grid, 1e-6)
