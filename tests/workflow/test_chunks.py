"""A study of several parameters through the real Snakefile: a job for each chunk, and a file for each point."""

import os
import re
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest
import xarray as xr

from burridge_knopoff import open_study
from tests.workflow.conftest import Study, copied, run_once
from tests.workflow.test_bad_input import check

PLANE = """
study: plane
laws: {linearized: {}, nonlinear: {}}
grid: {a: [0.05, 0.3], v: [0.05, 0.1]}
initial: {pair: {position: [-0.9, -1.1], velocity: [0.1, 0.1]}}
transient: 100
window: 200
batches: 2
"""
RESULTS = "results/plane"
POINTS = f"{RESULTS}/points/nonlinear/pair"
A = ("0.0500", "0.3000")
POINT, MARK = f"{POINTS}/a0.3000_v0.0500.nc", f"{RESULTS}/chunks/0000.done"


@pytest.fixture(scope="module")
def plane(tmp_path_factory):
    return run_once(tmp_path_factory, "plane", PLANE)


@pytest.fixture
def copy(plane, tmp_path):
    return copied(plane.folder, tmp_path / "copy")


def bk(study, *words):
    command = [str(Path(sys.executable).parent / "bk"), *words]
    return subprocess.run(command, cwd=study.folder, capture_output=True, text=True)


def times(study):
    """Return {point file: when it was written}."""
    paths = (study.folder / RESULTS / "points").rglob("[!.]*.nc")
    return {path.relative_to(study.folder).as_posix(): path.stat().st_mtime_ns for path in paths}


def test_the_whole_study_is_computed_and_read(plane):
    assert "points: completed 8 (status in " in plane.output
    # Its figures over the parameters are not those of the paper.
    assert "paper" not in plane.output
    results = plane.folder / RESULTS
    assert {path.stem for path in (results / "figures").glob("grid_*.png")} == {
        "grid_distance",
        "grid_exponents",
        "grid_kinds",
    }
    told = bk(plane, "show", f"{RESULTS}/summary/lyapunov.nc", "--plot", "exponents.png").stdout
    assert "exponents.png: Largest Lyapunov exponent over the parameters." in told
    summary = xr.load_dataset(results / "summary/lyapunov.nc")
    assert dict(summary.sizes) == {"law": 2, "initial": 1, "a": 2, "v": 2, "exponent": 3}
    tree = open_study(results)
    assert tree["summary/runs"].mean_distance.equals(summary.mean_distance)
    point = tree["points/nonlinear/pair/a0.3000_v0.0500"]
    assert (point.a.item(), point.v.item()) == (0.3, 0.05)
    page = (results / "report.html").read_text()
    assert "figures/grid_kinds.pdf" in page
    assert "v = 0.05, 0.1" in re.sub("<[^>]+>", "", page).replace("\xa0", " ")
    checked = bk(plane, "check", RESULTS)
    assert checked.returncode == 0, checked.stdout
    assert "left over" not in checked.stdout


def test_no_point_is_computed_twice(copy):
    before = times(copy)
    assert "Nothing to be done" in copy.ok()
    assert times(copy) == before


@pytest.mark.parametrize("damage", [Path.unlink, lambda path: path.write_bytes(path.read_bytes()[:-5])])
def test_only_a_missing_or_corrupt_point_is_recomputed(copy, damage):
    before, content = times(copy), (copy.folder / POINT).read_bytes()
    damage(copy.folder / POINT)
    assert f"{MARK}: a point of this chunk is missing or was changed: it is made again" in copy.ok()
    after = times(copy)
    assert {name for name in before if after[name] != before[name]} == {POINT}
    assert (copy.folder / POINT).read_bytes() == content


def test_a_single_point_can_be_computed(tmp_path, plane):
    alone = Study(tmp_path / "alone", PLANE)
    alone.ok(POINT)
    assert [*times(alone)] == [POINT]
    assert (alone.folder / POINT).read_bytes() == (plane.folder / POINT).read_bytes()


def test_another_value_computes_its_points_only(copy):
    before = times(copy)
    copy.config.write_text(PLANE.replace("v: [0.05, 0.1]", "v: [0.05, 0.1, 0.2]"))
    copy.ok(f"{RESULTS}/summary/mean_distance.nc")
    after = times(copy)
    assert {name: after[name] for name in before} == before
    added = {f"{RESULTS}/points/{law}/pair/a{a}_v0.2000.nc" for law in ("linearized", "nonlinear") for a in A}
    assert {*after} - {*before} == added
    copy.config.write_text(PLANE)
    copy.ok(f"{RESULTS}/summary/mean_distance.nc")
    listed = bk(copy, "check", RESULTS).stdout
    assert all(f"leftover {name}: not part of this study\n" in listed for name in added)


@pytest.mark.slow
def test_a_killed_chunk_resumes_where_it_stopped(tmp_path):
    study = Study(tmp_path / "killed", PLANE.replace("window: 200", "window: 60000"))
    command = study.command(MARK)
    with subprocess.Popen(command, cwd=study.folder, env=study.environment(), start_new_session=True) as run:
        while not times(study) and run.poll() is None:
            time.sleep(0.02)
        os.killpg(run.pid, signal.SIGKILL)
    first = times(study)
    assert first
    assert not (study.folder / MARK).exists()
    study.ok("--unlock")
    study.ok(MARK)
    after = times(study)
    assert len(first) < len(after) == 8
    assert {name: after[name] for name in first} == first


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("grid:", "a: [0.1]\ngrid:", ["study.yaml: a: [0.1]", "grid"]),
        ("v: [0.05, 0.1]", "speed: [1]", ["speed: "]),
        (
            "v: [0.05, 0.1]",
            "v: [0.1, 0.100001]",
            ["grid.v: ", "0.100001", "v0.1000.nc"],
        ),
    ],
)
def test_a_wrong_grid_is_refused_before_anything_is_written(tmp_path, old, new, words):
    check(Study(tmp_path, PLANE.replace(old, new)).run(), tmp_path, ["study.yaml"], words)
