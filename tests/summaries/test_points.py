"""Grids of point files: their paths, their commands, and files that are rejected."""

import shutil

import numpy as np
import pytest

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, open_point, read_point
from tests.forged import forge
from tests.grids import PAPER_MODELS, grid_of
from tests.refused import refused
from tests.summaries.points import write_points

SETTINGS = {"transient": 10.0, "window": 20.0, "batches": 2, "event_window": 5.0}
POINT = ("nonlinear", "plus", "0.20")


@pytest.fixture
def grid(tmp_path):
    models = {"chain": {**PAPER_MODELS["chain"], "threshold": [1.0, 1.0, 0.9]}, "v": 0.2}
    return write_points(grid_of(tmp_path, ["plus"], {"0.05": 0.05, "0.20": 0.2}, models, **SETTINGS))


def test_a_grid_is_its_points_in_order(grid, tmp_path):
    assert (grid.laws, grid.chain.blocks, grid.shape) == (("linearized", "nonlinear"), 3, (2, 1, 2))
    expected = [((i, 0, k), (law, "plus", a)) for i, law in enumerate(grid.laws) for k, a in enumerate(grid.a)]
    assert list(grid) == expected
    assert grid.path(*POINT) == tmp_path / "nonlinear/plus/a0.20.nc"
    assert grid.of_laws(["nonlinear"]).path(*POINT) == grid.path(*POINT)
    assert grid.of_laws(["nonlinear"]).laws == ("nonlinear",)
    model = grid.model("nonlinear", 0.2)
    assert (model.v, model.law.a, model.law.name, model.chain.threshold) == (0.2, 0.2, "nonlinear", (1.0, 1.0, 0.9))
    for words in ("simulate --law nonlinear --a 0.2", "--initial plus", "--v 0.2", "--transient 10.0", "--window 20.0"):
        assert words in grid.command(*POINT)
    other = grid.copy_with(tmp_path / "other", {"linearized": Settings(**SETTINGS, solver="map")})
    assert {law: item.solver for law, item in other.settings.items()} == {"linearized": "map"}
    assert other.folder == tmp_path / "other"
    assert (other.initial, other.a, other.models) == (grid.initial, grid.a, grid.models)
    config = {
        "initial": {"plus": {}},
        "parameters": grid.parameters,
        "settings": dict.fromkeys(grid.laws, SETTINGS),
        **grid.models,
    }
    assert Grid.from_points(tmp_path, config) == grid
    states = {"plus": {"position": [0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]}}
    assert Grid.from_points(tmp_path, {**config, "initial": states}).command(*POINT) != grid.command(*POINT)


def test_points_are_read_back(grid):
    read = read_point(grid, POINT, ["mean_distance", "time", *EVENTS])
    whole = open_point(grid, *POINT)
    for name, values in read.items():
        assert np.array_equal(values, whole[name].values), name
    time, block, kind = all_events(read)
    # The last events are those with states.
    assert len(time) == len(block) == len(kind) == whole["event_count"].item() > len(read["event_time"]) > 0
    assert (np.diff(time) >= 0.0).all()
    assert block[: len(read["earlier_event_block"])].tolist() == read["earlier_event_block"].tolist()
    assert kind[-len(read["event_kind"]) :].tolist() == read["event_kind"].tolist()


@pytest.mark.parametrize(
    "read", [lambda grid: read_point(grid, POINT, ["mean_distance"]), lambda grid: open_point(grid, *POINT)]
)
def test_another_file_is_refused(grid, read):
    path = grid.path(*POINT)
    shutil.copy(grid.path("nonlinear", "plus", "0.05"), path)
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
    forge(grid.path(*POINT), source_fingerprint="0" * 16)
    assert read_point(grid, POINT, ["mean_distance"])


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
    path = grid.path(*POINT)
    forge(path, history=made)
    with refused(str(path), words, error=BadFile), open_run(path, expected):
        pass
