"""The points of a study: their paths, their commands, and files that are rejected."""

import shutil

import numpy as np
import pytest

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import EVENTS, all_events, open_point, read_point
from tests.forged import forge
from tests.grids import PAPER_MODELS, grid_of
from tests.refused import refused
from tests.summaries.points import write_points

SETTINGS = {"transient": 10.0, "window": 20.0, "batches": 2, "event_window": 5.0}
POINT = {"law": "nonlinear", "initial": "plus", "a": "0.20"}


def path_of(grid):
    study, results = grid
    return results / study.run_file(**POINT)


@pytest.fixture
def grid(tmp_path):
    models = {"chain": {**PAPER_MODELS["chain"], "threshold": [1.0, 1.0, 0.9]}, "v": 0.2}
    return write_points(*grid_of(tmp_path, ["plus"], {"0.05": 0.05, "0.20": 0.2}, models, **SETTINGS))


def test_the_points_of_a_study_in_order(grid):
    study, _ = grid
    points = all_points(study)
    assert [tuple(point.values()) for point in points] == [
        (law, "plus", a) for law in ("linearized", "nonlinear") for a in ("0.05", "0.20")
    ]
    assert points[-1] == POINT
    assert study.run_file(**POINT) == "points/nonlinear/plus/a0.20.nc"
    assert study.run_file(**POINT, solver="rk4") == "solvers/rk4/nonlinear/plus/a0.20.nc"
    assert all_points(study.of_laws(["nonlinear"])) == points[2:]
    model, _, _ = study.run_of(**POINT)
    assert (model.v, model.law.parameters["a"], model.law.name, model.chain.threshold) == (
        0.2,
        0.2,
        "nonlinear",
        (1.0, 1.0, 0.9),
    )
    for words in ("simulate --law nonlinear --a 0.2", "--initial plus", "--v 0.2", "--transient 10.0", "--window 20.0"):
        assert words in study.command(**POINT)
    numbers = {"position": [0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]}
    other = Study({**study.config, "initial": {"plus": numbers}}, study.parameters)
    assert other.command(**POINT) != study.command(**POINT)


def test_points_are_read_back(grid):
    read = read_point(*grid, POINT, ["mean_distance", "time", *EVENTS])
    whole = open_point(*grid, POINT)
    for name, values in read.items():
        assert np.array_equal(values, whole[name].values), name
    time, block, kind = all_events(read)
    # The last events are those with states.
    assert len(time) == len(block) == len(kind) == whole["event_count"].item() > len(read["event_time"]) > 0
    assert (np.diff(time) >= 0.0).all()
    assert block[: len(read["earlier_event_block"])].tolist() == read["earlier_event_block"].tolist()
    assert kind[-len(read["event_kind"]) :].tolist() == read["event_kind"].tolist()


@pytest.mark.parametrize(
    "read", [lambda grid: read_point(*grid, POINT, ["mean_distance"]), lambda grid: open_point(*grid, POINT)]
)
def test_another_file_is_refused(grid, read):
    path = path_of(grid)
    shutil.copy(path.with_name("a0.05.nc"), path)
    with refused("nonlinear/plus/a0.20.nc", "0.05", "0.2", error=BadFile):
        read(grid)
    forge(path, history="another program")
    with refused("nonlinear/plus/a0.20.nc", error=BadFile):
        read(grid)
    path.unlink()
    with refused("nonlinear/plus/a0.20.nc", "missing", error=BadFile):
        read(grid)


def test_a_file_of_other_sources_is_read(grid):
    """Whoever has touched it has decided that the edit of the sources changes no number."""
    forge(path_of(grid), source_fingerprint="0" * 16)
    assert read_point(*grid, POINT, ["mean_distance"])


@pytest.mark.parametrize(
    ("made", "expected", "words"),
    [
        ("--number sigma=0.01", "--number sigma=0.02", "number sigma: 0.01"),
        ("--formula '1/(1 + a*u)'", "--formula '1 - a*u'", "formula: 1/(1 + a*u)"),
        ("--law-name soft", "", "law-name: soft"),
        ("--a 0.08 --v 0.1", "--a 0.05 --v 0.1", "a: 0.08"),
        ("snakemake", "bk simulate", "`snakemake`"),
    ],
)
def test_where_commands_differ(grid, made, expected, words):
    path = path_of(grid)
    forge(path, history=made)
    with refused(str(path), words, error=BadFile), open_run(path, expected):
        pass
