"""Verdicts on agreement follow the data, both ways."""

import dataclasses

import numpy as np
import pytest

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.summary import open_summary, write_summary
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.running.simulation import run, simulate
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
    assert agreement.digest(dataset) == (
        "minus, nonlinear law compared with the linearized law: they agree at all 2 values of a that were compared, "
        "0.05 to 0.08.\n"
    )


def test_altered_data_changes_the_verdict(tmp_path):
    def change(law, trajectory):
        if law == "nonlinear" and trajectory.model.a == 0.08:
            return dataclasses.replace(trajectory, mean_distance=0.2)
        return trajectory

    dataset = compare(written(tmp_path, change))
    assert dataset["agrees"].sel(other_law="nonlinear").values.tolist() == [[1, 0]]
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


def three_laws(folder, laws):
    settings = {"transient": 100.0, "window": 100.0, "batches": 2}
    grid = grid_of(folder, ["minus"], {"0.0500": 0.05, "0.2000": 0.2}, {"laws": laws}, **settings)
    for _, (law, initial, a) in grid:
        model = grid.model(law, grid.a[a])
        write_point(run(model, grid.initial[initial], grid.settings[law]), grid.path(law, initial, a))
    return grid


def test_each_law_is_compared_with_the_first(tmp_path):
    laws = {"smooth": {"law": "nonlinear"}, "linearized": {}, "same": {"formula": "1/(1 + a*u)"}}
    dataset = compare(three_laws(tmp_path, laws))
    assert dataset["law"].values.tolist() == list(laws)
    assert dataset["other_law"].values.tolist() == ["linearized", "same"]
    mean = dataset["mean_distance"]
    for other in ("linearized", "same"):
        expected = mean.sel(law=other) - mean.sel(law="smooth")
        assert np.array_equal(dataset["difference"].sel(other_law=other), expected)
    same = dataset.sel(other_law="same")
    assert (abs(same["difference"]) < 1e-9).all()
    assert (same["event_order_time"] == 200.0).all()
    assert (same["agrees"] != 0).all()
    lines = agreement.digest(dataset).splitlines()
    assert [line.split(":")[0] for line in lines] == [
        f"minus, {other} law compared with the smooth law" for other in ("linearized", "same")
    ]
    head, *rows = agreement.table(dataset).splitlines()
    assert head.split(",")[2:5] == [f"mean_distance_{law}" for law in laws]
    assert {"difference_linearized", "difference_same", "agrees_same"} <= set(head.split(","))
    assert [row.count(",") for row in rows] == [head.count(",")] * 2


def test_two_laws_have_the_columns_of_the_paper(tmp_path):
    head = agreement.table(compare(written(tmp_path))).splitlines()[0]
    assert head == (
        "initial,a,mean_distance_linearized,mean_distance_nonlinear,difference,difference_error,section_distance,"
        "event_order_time,kind_linearized,kind_nonlinear,agrees"
    )


def test_one_law_has_nothing_to_be_compared_with(tmp_path):
    dataset = compare(three_laws(tmp_path, {"linearized": {}}))
    assert dataset.sizes["other_law"] == 0
    assert agreement.digest(dataset) == "The linearized law is the only one: there is nothing to compare.\n"
    assert agreement.table(dataset).startswith("initial,a,mean_distance_linearized,kind_linearized\nminus,0.05,")
    write_summary(dataset, tmp_path / "agreement.nc")
    found = open_summary(tmp_path / "agreement.nc")
    assert found["difference"].shape == (0, 1, 2)
    assert found["law"].values.tolist() == ["linearized"]
