"""The results of a study: points and summaries as in their files, scalars over the grid, and missing files."""

import re
import shutil
import subprocess
import sys

import pytest
import xarray

from burridge_knopoff import open_study
from burridge_knopoff.show.result import open_result
from tests.forged import forge
from tests.refused import refused
from tests.small_study import OF_POINTS, run_study

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


def test_a_study_is_shown_on_one_screen(results):
    lines = repr(open_study(results)).splitlines()
    assert len(lines) == 3 + 8
    assert max(map(len, lines)) < 120
    assert lines[0] == f"<study few in {results}>"
    over = "over law 2, initial 2, a 3"
    form = f"points/<law>/<initial>/a<a> +11 of 12 points {over}, such as points/linearized/minus/a0.0500"
    assert re.fullmatch(form, lines[1])
    assert any(re.fullmatch("summary/lyapunov +Lyapunov exponents and kinds of motion", line) for line in lines)


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
    remedy = f"snakemake -c2 --configfile few.yaml -R {tmp_path.relative_to(root)}/{name}"
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
