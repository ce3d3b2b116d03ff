"""The results of a study: points and summaries as in their files, scalars over the grid, and missing files."""

import re
import shutil
import subprocess
import sys
from importlib.util import find_spec
from typing import Any
from xml.etree import ElementTree

import numpy as np
import pytest
import xarray

from burridge_knopoff import Model, decode_flags, open_study, plot, sweep
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.running.simulation import run
from burridge_knopoff.show.result import open_result
from burridge_knopoff.study.recorded import recorded_study
from tests.forged import forge
from tests.pages import blocks
from tests.refused import refused
from tests.small_study import OF_POINTS, run_study
from tests.workflow.conftest import snakemake_of_checkout

CONFIG = {"study": "few", "a": [0.05, 0.08, 0.22], "initial": {"minus": {}, "plus": {}}}
CONFIG |= {"transient": 20, "window": 60, "batches": 2, "event_window": 50}
SUMMARY = "summary/mean_distance.nc"
POINT = "points/linearized/plus/a0.0500.nc"
MISSING = "points/nonlinear/plus/a0.0800"


def make_study(folder):
    """Make all points of a study except one, and its summaries of points."""
    small = run_study(folder, {**CONFIG, "study": folder.name, "without": ["attractors"]}, OF_POINTS)
    (folder / f"{MISSING}.nc").unlink()
    small.record("few.yaml", CONFIG, "--configfile few.yaml")


@pytest.fixture(scope="module")
def results(tmp_path_factory):
    folder = tmp_path_factory.mktemp("few") / "results/few"
    make_study(folder)
    return folder


def test_the_tree_has_the_files_as_nodes(results):
    files = [*results.rglob("*.nc")]
    # A file that a job is writing, or has left incomplete, is not a node.
    (results / "summary" / ".some.part-0123abcd.nc").touch()
    study = open_study(results)
    assert len(list(study["summary"])) == 8
    assert len(files) == 11 + 8
    assert sorted(study) == sorted(str(path.relative_to(results).with_suffix("")) for path in files)
    for path in files:
        node = study[str(path.relative_to(results).with_suffix(""))]
        with xarray.open_dataset(path) as expected:
            assert node.to_dataset().identical(expected), path
    counts = {study[f"points/linearized/minus/a{a}"].sizes["event"] for a in ("0.0500", "0.2200")}
    assert len(counts) == 2
    assert study.config["transient"] == 20.0


def test_a_sweep_has_the_bits_of_the_points_of_a_study(results):
    points = open_study(results).points()
    settings = {key: CONFIG[key] for key in ("transient", "window", "batches", "event_window")}
    models = [Model(law) for law in points["law"].values.tolist()]
    runs = sweep(models, points["initial"].values.tolist(), a=points["a"].values, motion=None, **settings)
    there = points["status"] == 0
    assert there.sum() == 11
    common = {*runs.data_vars} & {*points.data_vars}
    assert {"mean_distance", "lyapunov_exponent", "settling_time", "event_count"} <= common
    for name in common - {"initial_position", "initial_velocity"}:
        assert runs[name].dims == points[name].dims
        np.testing.assert_array_equal(runs[name].where(there), points[name].where(there), err_msg=name)


def test_a_study_is_shown_on_one_screen(results):
    lines = repr(open_study(results)).splitlines()
    assert len(lines) == 3 + 8
    assert max(map(len, lines)) < 120
    assert lines[0] == f"<study few in {results}>"
    over = "over law 2, initial 2, a 3"
    form = f"points/<law>/<initial>/a<a> +11 of 12 points {over}, such as points/linearized/minus/a0.0500"
    assert re.fullmatch(form, lines[1])
    assert any(re.fullmatch("summary/lyapunov +Lyapunov exponents and kinds of motion", line) for line in lines)


def test_zeros_at_the_end_of_a_value_may_be_left_out(results):
    study = open_study(results)
    point = study["points/linearized/plus/a0.0800"]
    for name in ("a0.08", "a0.080"):
        assert study[f"points/linearized/plus/{name}"].identical(point)
        assert f"points/linearized/plus/{name}" in study
    for name in ("a0.8", "a0.0", "a0.", "a0.08001"):
        assert f"points/linearized/plus/{name}" not in study


def test_points_are_one_dataset(results):
    """Over the grid, with the numbers of every file; the point that is not there is missing."""
    study = open_study(results)
    points = study.points()
    assert points.mean_distance.dims == ("law", "initial", "a")
    assert points.velocity.dims == ("law", "initial", "a", "trajectory_time", "block")
    assert (points.v.item(), points.coupling.item(), points.time.dims) == (0.1, 1.0, ("sample",))
    assert not {"law", "checksum", "history"} & points.attrs.keys()
    assert points.attrs["transient"] == 20.0
    absent = points.sel(law="nonlinear", initial="plus", a=0.08)
    assert (absent.status.item(), absent.event_count.item(), absent.distance.isnull().all().item()) == (-1, -1, True)
    for leaf in study["points"].leaves:
        at = {name: leaf[name].item() for name in ("law", "initial", "a")}
        for name, variable in points.data_vars.items():
            assert variable.sel(at).equals(leaf[name]), (at, name)
    some = study.points("status", "distance")
    assert set(some.data_vars) == {"status", "distance"}
    assert some.distance.identical(points.distance)
    with refused("names", "event_time"):
        study.points("event_time")


def test_a_file_is_drawn_as_its_dataset(results):
    study = open_study(results)
    for path in ("points/linearized/plus/a0.08", "summary/mean_distance"):
        panels = [plot(result).axes for result in (study[path], study[path].to_dataset())]
        drawn = [[line.get_data() for panel in part for line in panel.lines] for part in panels]
        assert drawn[0]
        assert all(map(np.array_equal, *drawn))
    with refused("result"):
        plot(study["points"])


def test_a_folder_without_points_has_no_dataset_of_them(results, tmp_path):
    shutil.copy(results / "study.json", tmp_path)
    with refused("points/linearized/minus/a0.0500.nc", "missing"):
        open_study(tmp_path).points()


def test_points_of_a_grid_are_over_its_parameters(tmp_path):
    """The mass of one block is in no file a single number; laws have parameters of their own."""
    config = {**CONFIG, "study": "wide", "laws": {"stribeck": {"sigma": 0.3}}, "initial": {"minus": {}}, "without": []}
    config |= {"grid": {"mass[3]": [1.0, 1.2], "a": [0.05, 0.1], "v": [0.1]}}
    del config["a"]
    run_study(tmp_path / "results/wide", config)
    study = open_study(tmp_path / "results/wide")
    points = study.points("mean_distance")
    assert points.mean_distance.dims == ("law", "initial", "mass_3", "a", "v")
    point = study["points/stribeck/minus/mass_3_1.2_a0.1_v0.1"]
    at = {"law": "stribeck", "initial": "minus", "mass_3": 1.2, "a": 0.1, "v": 0.1}
    assert points.mean_distance.sel(at).item() == point.mean_distance.item()
    assert points.sigma.item() == 0.3


def test_files_combine_by_the_calls_of_the_page(results, repository, tmp_path, monkeypatch):
    """Each call has the numbers of `points`; those that need dask are made where it is installed."""
    (tmp_path / "results").mkdir()
    (tmp_path / "results/paper").symlink_to(results)
    monkeypatch.chdir(tmp_path)
    page = (repository / "docs/results.md").read_text(encoding="utf-8")
    calls = [block.text for block in blocks(page) if block.heading == "All points at once"]
    assert sum("open_mfdataset" in call for call in calls) == 1
    names: dict[str, Any] = {}
    made = []
    for call in calls:
        if "open_mfdataset" not in call or find_spec("dask"):
            exec(call, names)
            made.append(names["points"])
    if "plus" in names:
        made.append(names["plus"])
    expected = open_study(results).points()
    for points in made:
        wanted = expected.sel({name: points[name] for name in ("law", "initial", "a")})
        for name, variable in wanted.where(wanted.status >= 0).data_vars.items():
            array = points[name].where(points.status >= 0).transpose(*variable.dims)
            np.testing.assert_array_equal(array.values, variable.values, err_msg=str(name))
    assert {a: len(times) for a, times in names["stops"].items()} == {0.05: 18, 0.08: 23, 0.22: 20}


def test_a_run_that_stopped_early_is_missing_after_its_end(results, tmp_path, monkeypatch):
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    study = recorded_study(tmp_path)[1]
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 40)
    write_point(run(*study.run_of("linearized", "plus", "0.0500")), tmp_path / POINT)
    points = open_study(tmp_path).points()
    stopped = points.sel(law="linearized", initial="plus", a=0.05)
    assert decode_flags(stopped.status).item() == "step_limit"
    assert stopped.mean_distance.isnull()
    assert 0.0 < stopped.end_time < 50.0
    assert (stopped.distance.isnull() == (stopped.time > stopped.end_time)).all()
    assert stopped.velocity.isnull().all()
    assert points.mean_distance.where(points.status == 0).count() == 10


def test_a_notebook_shows_the_same_as_a_table(results):
    study = open_study(results)
    table = ElementTree.fromstring(f"<div>{study._repr_html_()}</div>")
    shown = ["".join(cell.itertext()) for cell in table.iter() if cell.tag in ("caption", "td", "p")]
    assert re.findall(r"[^<>\s]+", " ".join(shown)) == re.findall(r"[^<>\s]+", repr(study))


def test_files_are_opened_on_request(results, tmp_path):
    """A corrupt file does not matter to the others."""
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    (tmp_path / POINT).write_bytes(b"")
    (tmp_path / SUMMARY).write_bytes(b"")
    study = open_study(tmp_path)
    assert "summary/mean_distance" in repr(study)
    assert study["points/linearized/plus/a0.2200"].sizes["block"] == 3
    assert study["summary/lyapunov"].sizes["a"] == 3
    for path, name in (("points", POINT), ("summary", SUMMARY), (POINT.removesuffix(".nc"), POINT), ("/", SUMMARY)):
        with refused(str(tmp_path / name), "empty"):
            study[path]


def test_groups_are_trees_of_their_files(results):
    study = open_study(results)
    assert set(study["points/linearized"].children) == {"minus", "plus"}
    assert set(study["/points/nonlinear/plus/"].children) == {"a0.0500", "a0.2200"}
    assert set(study["/"].children) == {"points", "summary"}
    point = "points/linearized/plus/a0.0500"
    assert study["/"][point].identical(study[point])


@pytest.mark.parametrize("path", ["summary/lyapunow", MISSING, "point", "summary/lyap"])
def test_a_missing_file_is_named(results, path):
    study = open_study(results)
    assert path not in study
    with refused(path, str(results), error=KeyError):
        study[path]


def test_parts_of_arrays_are_read_on_request(results):
    path = results / "points" / "linearized" / "plus" / "a0.2200.nc"
    node = open_study(results)["points/linearized/plus/a0.2200"]
    with xarray.open_dataset(path) as point:
        for chosen in ({"block": 1}, {"event": [5, 2, 2]}, {"event": slice(None, None, 7), "block": [0, 2]}):
            assert node.event_velocity.isel(chosen).equals(point.event_velocity.isel(chosen))
        assert node.velocity.sel(block=2).equals(point.velocity.sel(block=2))


@pytest.mark.parametrize(
    ("name", "damage", "reason"),
    [
        (POINT, lambda path: path.write_bytes(b""), "empty"),
        (POINT, lambda path: path.write_bytes(b"no netCDF"), "corrupt"),
        (
            POINT,
            lambda path: shutil.copy(path.with_name("a0.0800.nc"), path),
            "a: got 0.08",
        ),
        (SUMMARY, lambda path: path.write_bytes(b""), "empty"),
        (
            SUMMARY,
            lambda path: forge(path, file="summary/x.nc"),
            "summary/x.nc",
        ),
        (
            SUMMARY,
            lambda path: forge(path, params='{"synchronization_threshold": 0.3}'),
            "synchronization_threshold",
        ),
    ],
)
def test_a_file_that_is_corrupt_or_not_of_the_study_is_named(results, tmp_path, name, damage, reason):
    """The message, with the command that recreates the file, is that of `bk show`."""
    shutil.copytree(results, tmp_path, dirs_exist_ok=True)
    damage(tmp_path / name)
    messages = []
    study = open_study(tmp_path)
    for read in (lambda: study[name.removesuffix(".nc")], lambda: open_result(tmp_path / name)):
        with refused(str(tmp_path / name), reason) as caught:
            read()
        messages.append(str(caught.value))
    assert messages[0] == messages[1]
    assert messages[0].startswith(f"{tmp_path / name}: ")
    root = tmp_path.parents[1]
    remedy = f"{snakemake_of_checkout(root)} --configfile few.yaml -R {tmp_path.relative_to(root)}/{name}"
    assert messages[0].endswith(f"; remake it: cd {root} && {remedy}")


def test_a_folder_without_a_study_is_refused(tmp_path):
    with refused("results/nothing"):
        open_study("results/nothing")
    with refused(str(tmp_path)):
        open_study(tmp_path)


def test_dask_is_not_needed(results):
    script = (
        "import sys; sys.modules['dask'] = None; from burridge_knopoff import open_study; "
        f"print(open_study({str(results)!r})['summary/mean_distance'].mean_distance.sel(a=0.05).notnull().all().item())"
    )
    run = subprocess.run([sys.executable, "-c", script], check=True, capture_output=True, text=True)
    assert run.stdout == "True\n"


def test_a_study_that_snakemake_has_made(finished):
    results = finished.folder / "results" / "tiny"
    study = open_study(results)
    assert set(study["summary"].children) == {path.stem for path in (results / "summary").glob("*.nc")}
    assert study["summary/runs"].mean_distance.equals(study["summary/mean_distance"].mean_distance)


@pytest.mark.slow
def test_threads_may_open_files(results):
    """This runs in a separate process, since HDF5 may crash it."""
    script = (
        "from concurrent.futures import ThreadPoolExecutor; from burridge_knopoff import open_study\n"
        f"study = open_study({str(results)!r})\n"
        "with ThreadPoolExecutor(8) as pool: print(len([*pool.map(study.__getitem__, [*study] * 3)]))"
    )
    run = subprocess.run([sys.executable, "-c", script], capture_output=True, text=True)
    assert (run.returncode, run.stdout) == (0, f"{3 * (11 + 8)}\n")


@pytest.mark.slow
def test_the_whole_tree_is_one_file(results, tmp_path):
    open_study(results)["/"].to_netcdf(tmp_path / "all.nc")
    assert (tmp_path / "all.nc").stat().st_size > 10_000
