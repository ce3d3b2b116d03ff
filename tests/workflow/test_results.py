"""The results of a study: points, summaries and figures, compared with the package."""

import csv
import os
import re
import shutil
import subprocess

import numpy as np
import pytest
import xarray as xr
from matplotlib.image import imread

from burridge_knopoff import simulate
from burridge_knopoff.check.leftovers import leftovers
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.recorded import recorded_study

GRID = [0.05, 0.08, 0.2, 0.22]
NAMES = ["0.0500", "0.0800", "0.2000", "0.2200"]
OPTIONS = {"transient": 100.0, "window": 200.0, "batches": 4}


@pytest.fixture
def results(finished):
    return finished.folder / "results" / "tiny"


def test_exactly_the_points_of_the_config_exist(results):
    """There is no other point: omitted keys of a config are not taken from config/paper.yaml."""
    paths = sorted(str(path.relative_to(results / "points")) for path in (results / "points").rglob("*.nc"))
    assert paths == sorted(
        f"{law}/{initial}/a{a}.nc"
        for law in ("linearized", "nonlinear")
        for initial in ("minus", "plus")
        for a in NAMES
    )
    assert not list(results.rglob(".*"))


def test_sha256sum_checks_an_archive(results, tmp_path, repository):
    """Without this program, by the lines of docs/data.md."""
    page = (repository / "docs/data.md").read_text()
    write, check = (re.search(rf"^{start}.*", page, re.MULTILINE)[0] for start in ("find paper", "sha256sum -c"))

    def run(line):
        command = ["bash", "-o", "pipefail", "-c", line.replace("paper", "tiny")]
        # The programs of a reader, not those that the README names.
        return subprocess.run(command, cwd=tmp_path, env={"PATH": os.defpath}, capture_output=True, text=True)

    copy = shutil.copytree(results, tmp_path / "tiny")
    assert run(write).returncode == 0
    listed = [line.partition("  ")[2] for line in (tmp_path / "tiny.sha256").read_text().splitlines()]
    assert sorted(listed) == sorted(f"tiny/{name}" for name in files_of(copy))
    assert run(check).returncode == 0
    with (copy / "summary/agreement.csv").open("a") as file:
        file.write("\n")
    assert run(check).returncode == 1


def test_every_file_has_its_metadata(results):
    """Points, parts and summaries have the attributes that the ACDD conventions highly recommend."""
    folders = set()
    for path in results.rglob("[!.]*.nc"):
        folders.add(path.relative_to(results).parts[0])
        with xr.open_dataset(path) as data:
            head = {key: data.attrs[key] for key in ("Conventions", "title", "summary", "keywords")}
        assert "ACDD-1.3" in head["Conventions"], path
        assert all(head.values()), path
        assert "stick-slip" in head["keywords"].split(", "), path
        assert len(head["summary"]) > len(head["title"]) > 5, path
    assert folders >= {"points", "summary", "attractors", "basins", "solvers"}


def test_mean_distance_summary(results):
    with xr.open_dataset(results / "summary" / "mean_distance.nc") as summary:
        assert dict(summary.sizes) == {"law": 2, "initial": 2, "a": 4, "level": 5}
        assert summary["a"].values.tolist() == GRID
        for law in ("linearized", "nonlinear"):
            run = simulate(Model(law, a=0.2), "plus", **OPTIONS)
            point = summary.sel(law=law, initial="plus", a=0.2)
            assert point["mean_distance"].item() == run.mean_distance
            assert point["mean_distance_error"].item() == run.mean_distance_error
            assert point["event_count"].item() == run.event_count
            assert point["synchronized"].item() == 0
        synchronized = summary["mean_distance"] < summary.attrs["synchronization_threshold"]
        assert (summary["synchronized"] == synchronized).all()


def test_bifurcation_summary(results):
    from burridge_knopoff.summaries.bifurcation_diagram import section_points

    with xr.open_dataset(results / "summary" / "bifurcation_diagram.nc") as summary:
        assert summary["crossing_count"].attrs["sample_dimension"] == "crossing"
        assert summary["crossing_count"].sum() == summary.sizes["crossing"]
        run = simulate(Model("nonlinear", a=0.22), "minus", **OPTIONS)
        for direction in (1, -1):
            a, velocity = section_points(summary, "nonlinear", "minus", direction)
            mine = run.crossing_velocity[run.crossing_direction == direction]
            assert (velocity[a == 0.22] == mine).all()
            assert len(mine) > 10
            assert set(a) <= set(GRID)


def test_lyapunov_summary(results):
    with xr.open_dataset(results / "summary" / "lyapunov.nc") as summary:
        run = simulate(Model("nonlinear", a=0.22), "plus", **OPTIONS)
        point = summary.sel(law="nonlinear", initial="plus", a=0.22)
        assert point["lyapunov_exponent"].values.tolist() == run.lyapunov_exponent.tolist()
        assert point["lyapunov_error"].values.tolist() == run.lyapunov_error.tolist()
        assert point["lyapunov_infinite_count"].item() == run.lyapunov_infinite_count > 0


def test_attractors_and_basins(results):
    with xr.open_dataset(results / "summary" / "attractors.nc") as attractors:
        assert attractors["a"].values.tolist() == GRID
        there = attractors.sel(law="linearized", a=0.08)
        assert there["branch"].values[0] == 0
        assert there["mean_distance"].values[0] < 1e-6
        counted = there["basin_count"].sum() + there["undetermined_count"]
        assert counted == there["sample_count"] > 0
        # Both runs are on a known attractor.
        assert (there["initial_branch"].sel(contact="one_sided", start="moving") >= 0).all()
        branches = set(there["branch"].values.tolist())
        numbers = set(attractors["branch_number"].values.tolist())
    with xr.open_dataset(results / "summary" / "refined.nc") as refined:
        # The study inserts no values.
        assert refined["a"].values.tolist() == [GRID, GRID]
        assert (refined["in_grid"] == 1).all()
        assert set(refined["branch"].values.ravel().tolist()) <= numbers | {-1}
    with xr.open_dataset(results / "summary" / "basins.nc") as basins:
        steps = {"separation": 13, "separation_step": 12}
        steps["number"] = len(numbers)
        assert dict(basins.sizes) == {"map": 3, "last_position": 8, "first_position": 8, **steps}
        assert list(zip(basins["law"].values.tolist(), basins["a"].values.tolist(), strict=True)) == [
            ("linearized", 0.05),
            ("linearized", 0.08),
            ("nonlinear", 0.08),
        ]
        assert set(basins["branch"].values[1].ravel().tolist()) <= branches | {-1}


def test_phases_summary(results):
    with xr.open_dataset(results / "summary" / "phases.nc") as phases:
        shared = {"a": 2, "inner_share": 2, "amplitude": 2, "phase_difference": 2, "state": 3}
        assert dict(phases.sizes) == {"law": 2, **shared, "inner_block": 1}
        assert phases["a"].values.tolist() == [0.05, 0.08]
        small = phases["branch"].sel(amplitude=0.03)
        assert (small.sel(phase_difference=20.0) == 0).all()
        assert (small.sel(phase_difference=180.0) != 0).all()
        with xr.open_dataset(results / "phases" / "nonlinear.nc") as part:
            assert (phases["branch"].sel(law="nonlinear") == part["branch"]).all()


def test_agreement_summary(results):
    with xr.open_dataset(results / "summary" / "agreement.nc") as agreement:
        pair = [simulate(Model(law, a=0.2), "plus", **OPTIONS) for law in ("linearized", "nonlinear")]
        point = agreement.sel(initial="plus", a=0.2)
        assert point["difference"].item() == pair[1].mean_distance - pair[0].mean_distance
        assert point["difference_error"].item() == np.hypot(*(run.mean_distance_error for run in pair))
        whole = [simulate(Model(law, a=0.2), "plus", events="all", **OPTIONS) for law in ("linearized", "nonlinear")]
        codes = [list(zip(run.event_block, run.event_kind, strict=True)) for run in whole]
        common = next(n for n, (one, two) in enumerate(zip(*codes, strict=False)) if one != two)
        assert point["event_order_count"].item() == common
        assert point["event_order_time"].item() == min(run.event_time[common] for run in whole)
    with open(results / "summary" / "agreement.csv") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 8
    row = next(row for row in rows if row["initial"] == "plus" and float(row["a"]) == 0.2)
    assert float(row["mean_distance_linearized"]) == pytest.approx(pair[0].mean_distance, rel=1e-8)
    lines = (results / "summary" / "agreement.txt").read_text().splitlines()
    assert [line.split(",")[0] for line in lines if "compared with" in line] == ["minus", "plus"]


def test_orbits_summary(results):
    with xr.open_dataset(results / "summary" / "orbits.nc") as orbits:
        assert orbits["a"].values.tolist() == GRID
        assert (orbits["status"] == 0).all()
        assert orbits["critical_a"].values == pytest.approx([0.0869729046661, 0.0887172229712], abs=1e-12)
        for law in ("linearized", "nonlinear"):
            orbit = synchronized_orbits(Model(law, a=0.0)).at(0.2)
            assert orbits["period"].sel(law=law, a=0.2).item() == pytest.approx(orbit.period, abs=1e-12)


def test_stick_slip_summary(results):
    with xr.open_dataset(results / "summary" / "stick_slip.nc") as cycles:
        assert dict(cycles.sizes) == {"law": 2, "initial": 2, "a": 4, "block": 3}
        run = simulate(Model("nonlinear", a=0.22), "plus", events="all", **OPTIONS)
        point = cycles.sel(law="nonlinear", initial="plus", a=0.22)
        for block in (1, 2, 3):
            stops = run.event_time[(run.event_block == block) & (run.event_kind == 0) & (run.event_time >= 100.0)]
            block_data = point.sel(block=block)
            assert block_data["stop_rate"].item() == len(stops) / 200.0 > 0.0
            assert block_data["cycle_time"].item() == pytest.approx(np.diff(stops).mean(), rel=1e-12)
        # The whole window, except before the first stop and after the last event.
        whole = simulate(Model("nonlinear", a=0.22), "plus", **{**OPTIONS, "trajectory": 200.0})
        expected = np.corrcoef(whole.velocity[:, 0], whole.velocity[:, 2])[0, 1]
        assert point["velocity_correlation"].item() == pytest.approx(expected, abs=5e-3)


def test_equilibrium_summary(results):
    with xr.open_dataset(results / "summary" / "equilibrium.nc") as sliding:
        assert sliding["a"].values.tolist() == GRID
        real = sliding["eigenvalue"].sel(part="real", law="linearized").max("mode")
        assert real.values == pytest.approx(0.5 * np.array(GRID))
        assert (sliding["growth_rate"] > 0.0).all()


def test_solvers_summary(results):
    with xr.open_dataset(results / "summary" / "solvers.nc") as solvers:
        assert solvers["a"].values.tolist() == [0.2]
        run = simulate(Model("nonlinear", a=0.2), "minus", solver="rk4", step=0.01, **OPTIONS)
        point = solvers.sel(law="nonlinear", solver="rk4", initial="minus", a=0.2)
        assert point["mean_distance"].item() == run.mean_distance
        assert point["step_count"].item() == run.step_count
        assert abs(solvers["difference"].sel(solver="map")).max() < 1e-11
    folders = {str(path.relative_to(results / "solvers").parent) for path in (results / "solvers").rglob("a*.nc")}
    assert folders == {
        f"{way}/{initial}"
        for way in ("map/linearized", "rk4/linearized", "rk4/nonlinear")
        for initial in ("minus", "plus")
    }


@pytest.mark.parametrize(
    "name",
    [
        *(
            "friction_laws",
            "mean_distance",
            "bifurcation_diagram",
            "distance",
            "motion_minus",
            "motion_plus",
            "agreement",
        ),
        *(
            "lyapunov",
            "basins",
            "basin_fractions",
            "bifurcations",
            "orbits",
            "phases",
            "stick_slip",
            "equilibrium",
            "solvers",
        ),
    ],
)
def test_figures_are_pictures(results, name):
    picture = imread(results / "figures" / f"{name}.png")
    assert picture.shape[0] > 600
    assert picture.shape[1] > 900
    ink = (picture[..., :3].min(axis=2) < 0.9).mean()
    # Maps are coloured everywhere.
    assert 0.005 < ink < 0.7
    assert (results / "figures" / f"{name}.pdf").read_bytes().startswith(b"%PDF")


def test_logs_and_benchmarks(results):
    for folder, suffix in (("logs", ".log"), ("benchmarks", ".tsv")):
        names = {path.name for path in (results / folder).glob(f"*{suffix}")}
        assert {f"{rule}{suffix}" for rule in ("mean_distance", "agreement", "figure_bifurcation_diagram")} <= names
        assert len(list((results / folder / "simulate").rglob(f"*{suffix}"))) == 16
    assert all(path.read_text() == "" for path in (results / "logs" / "simulate").rglob("*.log"))


def left_over(results, folder, config):
    """Return the names of what is left over after the start of a run of another config in a copy of the results."""
    copy = shutil.copytree(results, folder / "results/tiny")
    return {path.relative_to(copy).as_posix() for path in leftovers(copy, load_study(config, "tiny.yaml"))}


def files_of(results):
    return {path.relative_to(results).as_posix() for path in results.rglob("*") if path.is_file()}


@pytest.mark.parametrize(("key", "name"), [("initial", "plus"), ("laws", "nonlinear"), ("a", "0.0800")])
def test_leftovers_of_a_larger_study_are_recognized(results, tmp_path, key, name):
    """`bk check` lists all files of a state, a law or an a that is no longer in the config."""
    record, study = recorded_study(results)
    assert leftovers(results, study) == []
    config = {**record["given"], "initial": {"minus": {}, "plus": {}}, "laws": {"linearized": {}, "nonlinear": {}}}
    if key == "a":
        config["a"] = [a for a in study.grid.values() if a != 0.08]
        config["phases"] = {**config["phases"], "a": [0.05]}
    else:
        del config[key][name]
    # With one law there is nothing to compare it with.
    compared = r"|figures?[/_]agreement.*|.*(figure_)?two_blocks\.[a-z]+|.*figure_agreement.*" if key == "laws" else ""
    named = re.compile(rf"(.*(/a?|motion_){name}(/.*|\.[a-z]+)){compared}")
    assert left_over(results, tmp_path, config) == {file for file in files_of(results) if named.fullmatch(file)}


@pytest.mark.parametrize(
    ("stage", "names"),
    [
        (
            "attractors",
            "(figure_)?(attractors|refined|returns|rotation|attractor_kinds|bifurcations|basins|basin_fractions|"
            "branches_reached|detuning|phases)",
        ),
        ("bifurcations", "(figure_)?bifurcations"),
        ("solvers", "(figure_)?solvers|simulate_solver"),
        ("two_blocks", "(figure_)?two_blocks"),
        ("proof", "proof"),
        ("claims", "claims"),
    ],
)
def test_leftovers_of_an_omitted_stage_are_recognized(results, tmp_path, stage, names):
    left = left_over(results, tmp_path, {**recorded_study(results)[0]["given"], "without": [stage]})
    named = re.compile(rf"(.*/)?({names})(/.*|\.[a-z]+)")
    assert left == {file for file in files_of(results) if named.fullmatch(file)}


def test_the_data_dictionary_names_every_variable(results, repository):
    words = set(re.findall(r"`(\w+)`", (repository / "docs" / "variables.md").read_text()))
    files = [*results.glob("summary/*.nc"), results / "points" / "linearized" / "plus" / "a0.0800.nc"]
    assert len(files) >= 8
    for path in files:
        with xr.open_dataset(path) as dataset:
            unknown = {str(name) for name in dataset.variables} - words - {"law", "initial"}
            assert not unknown, path
