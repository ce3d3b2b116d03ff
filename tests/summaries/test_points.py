"""Grids of point files: their paths, their commands, and files that are rejected."""

from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff.provenance.seal import BadFile, read_sealed, write_sealed
from burridge_knopoff.summaries.points import EVENTS, Grid, all_events, open_point, read_point
from tests.grids import PAPER_MODELS, grid_of
from tests.summaries.points import write_points

SETTINGS = {"transient": 10.0, "window": 20.0, "batches": 2, "event_window": 5.0}
POINT = ("nonlinear", "plus", "0.20")


@pytest.fixture
def grid(tmp_path):
    models = {"chain": {**PAPER_MODELS["chain"], "threshold": [1.0, 1.0, 0.9]}, "v": 0.2}
    return write_points(grid_of(tmp_path, ["plus"], {"0.05": 0.05, "0.20": 0.2}, models, **SETTINGS))


def test_a_grid_is_its_points_in_order(grid, tmp_path):
    assert (grid.laws, grid.blocks, grid.shape) == (("linearized", "nonlinear"), 3, (2, 1, 2))
    expected = [((i, 0, k), (law, "plus", a)) for i, law in enumerate(grid.laws) for k, a in enumerate(grid.a)]
    assert list(grid) == expected
    assert grid.path(*POINT) == tmp_path / "nonlinear/plus/a0.20.nc"
    assert not grid.is_mirror_symmetric
    assert grid_of(tmp_path, ["plus"], {"0.1": 0.1}).is_mirror_symmetric
    model = grid.model("nonlinear", 0.2)
    assert (model.v, model.law.a, model.law.name, model.chain.threshold) == (0.2, 0.2, "nonlinear", (1.0, 1.0, 0.9))
    for words in ("simulate --law nonlinear --a 0.2", "--initial plus", "--v 0.2", "--transient 10.0", "--window 20.0"):
        assert words in grid.command(*POINT)
    other = grid.copy_with(tmp_path / "other", {"linearized": {**SETTINGS, "solver": "map"}})
    assert {law: item.solver for law, item in other.settings.items()} == {"linearized": "map"}
    assert other.folder == tmp_path / "other"
    assert (other.initial, other.a, other.models) == (grid.initial, grid.a, grid.models)
    given = {
        "initial": {"plus": {}},
        "parameters": grid.parameters,
        "settings": dict.fromkeys(grid.laws, SETTINGS),
        **grid.models,
    }
    assert Grid.from_points(tmp_path, given) == grid
    own = {"plus": {"position": [0.989, -0.993, -0.991], "velocity": [0.099, 0.1012, 0.1023]}}
    assert Grid.from_points(tmp_path, {**given, "initial": own}).command(*POINT) != grid.command(*POINT)


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
@pytest.mark.parametrize(
    ("change", "reason"),
    [
        ({"command": "bk simulate"}, "is another run: "),
        ({"sources": "0" * 16}, "was made by other sources"),
    ],
)
def test_another_file_is_refused(grid, read, change, reason):
    path = grid.path(*POINT)
    content, about, status = read_sealed(path)
    write_sealed(path, lambda name: Path(name).write_bytes(content), {**about, **change}, status)
    with pytest.raises(BadFile) as caught:
        read(grid)
    assert f"nonlinear/plus/a0.20.nc: {reason}" in str(caught.value)
    grid.path(*POINT).unlink()
    with pytest.raises(BadFile, match="is missing"):
        read(grid)
