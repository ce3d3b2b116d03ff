"""Point files: content, CF compliance, reproducible bytes and size."""

import re
import shlex
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import netCDF4
import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import Model, simulate
from burridge_knopoff.dataset.point import (
    POINT_VARIABLES,
    point_attributes,
    point_values,
    run_coordinates,
    with_run_coordinates,
    write_point,
)
from burridge_knopoff.dataset.variables import write_variables
from burridge_knopoff.laws import FormulaLaw
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.running.trajectory import Trajectory

#: The scalar coordinates of a run of the paper's chain under its own laws.
SCALARS = "law initial coupling threshold mass damping pulling_damping weakening a v"
#: The scalars of the chain by default.
USUAL = {"coupling": 1.0, "threshold": 1.0, "mass": 1.0, "damping": 0.0, "pulling_damping": 0.0, "weakening": 1.0}


@pytest.fixture(scope="module")
def trajectory():
    return simulate(Model("linearized", a=0.08), "plus", transient=100.0, window=200.0, batches=4, event_window=50.0)


@pytest.fixture
def path(trajectory, tmp_path):
    write_point(trajectory, tmp_path / "point.nc")
    return tmp_path / "point.nc"


def test_the_file_and_the_dataset_have_the_same_content(trajectory, path):
    with xr.open_dataset(path) as file:
        xr.testing.assert_identical(file.load().drop_attrs(deep=True), trajectory.to_dataset().drop_attrs(deep=True))
        assert set(file.variables) == {*POINT_VARIABLES, *run_coordinates(file.attrs)}
        assert (file.attrs["law"], file.attrs["law_formula"]) == ("linearized", "1 - a*u")
        assert (file.attrs["chain_coupling"], file.attrs["chain_pulling"]) == (1.0, "neighbours")
        assert (file.attrs["chain_threshold"], file.attrs["chain_ends"]) == (1.0, "open")
        assert (file.attrs["initial"], file.attrs["transient"], file.attrs["window"]) == ("plus", 100.0, 200.0)
        assert (file["a"].item(), file["v"].item(), file["block"].values.tolist()) == (0.08, 0.1, [1, 2, 3])
        assert tuple(file["initial_position"].values) == trajectory.initial.position
        assert tuple(file["initial_velocity"].values) == trajectory.initial.velocity
        assert file["batch"].values.tolist() == [125.0, 175.0, 225.0, 275.0]
        assert file["status"].item() == 0
        for name, coordinates in {
            "mean_distance": SCALARS,
            "event_position": f"event_time {SCALARS}",
            "distance": f"time {SCALARS}",
        }.items():
            assert file[name].encoding["coordinates"] == coordinates
        for name, dimensions in {"position": ("trajectory_time", "block"), "batch_mean_distance": ("batch",)}.items():
            assert file[name].dims == dimensions
            assert file[name].encoding["coordinates"] == SCALARS
        for name, variable in file.variables.items():
            assert variable.attrs["long_name"], name
            assert "_FillValue" not in variable.encoding, name


@pytest.mark.parametrize(
    ("law", "chain", "numbers"),
    [
        ({}, {}, USUAL),
        (
            {"law": "stribeck", "sigma": 0.3},
            {"coupling": (1.0, 1.1), "pulling": 0.5, "mass": 1.2, "damping": 0.1},
            {"sigma": 0.3, "eta": 0.2, "pulling": 0.5, "threshold": 1.0, "mass": 1.2}
            | {"damping": 0.1, "pulling_damping": 0.0, "weakening": 1.0},
        ),
        # These names have other meanings in a file.
        (
            {"formula": "1 - a*u + 0*(event + time)", "event": 1, "time": 2},
            {"threshold": {"random": "uniform", "low": 0.9, "high": 1.1, "seed": 1}},
            {name: value for name, value in USUAL.items() if name != "threshold"},
        ),
    ],
)
def test_what_is_one_number_is_a_scalar_coordinate(tmp_path, law, chain, numbers):
    """In the file, in the Dataset, and in a file of an earlier version, which has attributes only."""
    own = InitialState("θ", (-0.9, -1.1, -1.0), 0.1)
    run = simulate(Model({"mine": law or {"law": "linearized"}}, a=0.08, **chain), own, window=5.0)
    write_point(run, tmp_path / "new.nc")
    with netCDF4.Dataset(tmp_path / "old.nc", "w") as file:
        write_variables(file, POINT_VARIABLES, point_values(run), point_attributes(run))
    with xr.open_dataset(tmp_path / "new.nc") as new, xr.open_dataset(tmp_path / "old.nc") as old:
        assert "law" not in old.variables
        for point in (new, run.to_dataset(), with_run_coordinates(old)):
            scalars = {str(name): value.item() for name, value in point.coords.items() if not value.dims}
            assert scalars == {"law": "mine", "initial": "θ", "a": 0.08, "v": 0.1, **numbers}
        xr.testing.assert_identical(with_run_coordinates(old).drop_attrs(deep=False), new.drop_attrs(deep=False))


def test_every_observable_of_a_run_has_a_test(repository):
    """A field of a trajectory is a row of the point files, or not; some test mentions it."""
    words = {word for path in repository.glob("tests/**/test_*.py") for word in re.findall(r"\w+", path.read_text())}
    assert {field.name for field in fields(Trajectory)} - words == set()


def test_flags_keep_their_meanings():
    """Changing these would break programs that read the files."""
    meanings = {
        name: dict(zip(item.attributes["flag_values"].tolist(), item.attributes["flag_meanings"].split(), strict=True))
        for name, item in POINT_VARIABLES.items()
        if "flag_values" in item.attributes
    }
    event = {0: "stop", 1: "start"}
    assert meanings == {
        "status": {0: "completed", 1: "step_limit", 2: "accumulating_events", 3: "diverged"},
        "earlier_event_kind": event,
        "event_kind": event,
        "crossing_direction": {-1: "downward", 1: "upward"},
        "initially_slipping": {0: "no", 1: "yes"},
    }


def test_events_of_the_whole_run(trajectory):
    """Earlier events, then those of the event window with their states, together the whole sequence."""
    everything = simulate(Model("linearized", a=0.08), "plus", transient=100.0, window=200.0, batches=4, events="all")
    time = np.concatenate([trajectory.earlier_event_time, trajectory.event_time])
    assert (time == everything.event_time).all()
    block = np.concatenate([trajectory.earlier_event_block, trajectory.event_block])
    assert (block == everything.event_block).all()
    assert trajectory.event_time.min() >= 250.0 > trajectory.earlier_event_time.max()
    assert (trajectory.event_position == everything.event_position[-len(trajectory.event_time) :]).all()
    velocity = trajectory.event_velocity[np.arange(len(trajectory.event_time)), trajectory.event_block - 1]
    assert (velocity == 0.0).all()
    kinds = everything.event_kind[everything.event_block == 2]
    assert (kinds[1:] != kinds[:-1]).all()


def test_positions_are_relative_to_the_driver(trajectory):
    first = simulate(Model("linearized", a=0.08), "plus", transient=0.0, window=20.0, trajectory=20.0)
    assert np.allclose(first.position[0], first.initial.position, atol=1e-14)
    assert (first.velocity[0] == first.initial.velocity).all()
    assert np.abs(trajectory.position).max() < 2.0


def made_by(command, path):
    """Return the bytes of the file that a command makes."""
    _, *arguments = command
    subprocess.run([str(Path(sys.executable).parent / "bk"), *arguments, "--out", str(path)], check=True)
    return path.read_bytes()


def test_the_same_inputs_give_the_same_bytes(tmp_path):
    command = ["bk", "simulate", "--law", "nonlinear", "--a", "0.2", "--window", "300", "--transient", "10"]
    assert made_by(command, tmp_path / "one") == made_by(command, tmp_path / "two")


def test_history_is_the_command_that_makes_the_file(path, tmp_path):
    with xr.open_dataset(path) as dataset:
        command = shlex.split(dataset.attrs["history"])
    assert made_by(command, tmp_path / "again.nc") == path.read_bytes()


@pytest.mark.parametrize("exponents", [0, 2, 6])
def test_history_states_the_number_of_exponents(tmp_path, exponents):
    settings = {"transient": 50.0, "window": 60.0, "lyapunov_exponents": exponents, "lyapunov_alignment": 12.5}
    run = simulate(Model("nonlinear", a=0.1), "plus", **settings)
    write_point(run, tmp_path / "point.nc")
    with xr.open_dataset(tmp_path / "point.nc") as dataset:
        command = shlex.split(dataset.attrs["history"])
        assert dataset["lyapunov_exponent"].shape == (exponents,)
        assert dataset["batch_lyapunov_exponent"].shape == (7, exponents)
    assert command[command.index("--lyapunov-alignment") + 1] == "12.5"
    assert made_by(command, tmp_path / "again.nc") == (tmp_path / "point.nc").read_bytes()


def test_exponents_that_were_not_computed_are_nan(tmp_path):
    write_point(
        simulate(Model("linearized", a=0.08), "plus", solver="rk4", step=0.1, window=50.0), tmp_path / "point.nc"
    )
    with xr.open_dataset(tmp_path / "point.nc") as dataset:
        assert dataset["lyapunov_exponent"].shape == (3,)
        for name in ("lyapunov_exponent", "lyapunov_error", "batch_lyapunov_exponent"):
            assert np.isnan(dataset[name]).all(), name
        assert dataset["lyapunov_infinite_count"].item() == -1


@pytest.mark.slow
def test_files_comply_with_cf(tmp_path):
    law = FormulaLaw("1 - c*tanh(a*u/c)", name="soft", a=0.08, c=0.1)
    files = [str(tmp_path / name) for name in ("open.nc", "ring.nc")]
    ring = Chain(3, (1.0, 2.0, 3.0), (0.5, 1.0, 0.5), (1.0, 2.0, 1.0), "ring")
    for chain, file in zip((None, ring), files, strict=True):
        write_point(simulate(Model(law, a=0.08, chain=chain), "plus", transient=10.0, window=50.0), file)
    checker = [str(Path(sys.executable).parent / "compliance-checker"), "--test=cf:1.11", "--criteria=strict"]
    run = subprocess.run([*checker, *files], capture_output=True, text=True, cwd=tmp_path)
    assert run.stdout.count("All tests passed!") == 2, run.stdout
    assert run.returncode == 0


@pytest.mark.parametrize(("law", "a"), [("linearized", 0.08), ("nonlinear", 0.095), ("nonlinear", 0.25)])
def test_a_default_point_is_small(tmp_path, law, a):
    """It is below 310 KB, also if the motion never repeats and does not compress."""
    write_point(simulate(Model(law, a=a), "plus"), tmp_path / "point.nc")
    assert 50_000 < (tmp_path / "point.nc").stat().st_size < 310_000


def test_a_run_that_did_not_complete_has_nan(tmp_path, monkeypatch):
    monkeypatch.setattr("burridge_knopoff.running.runner.STEP_LIMIT", 10)
    write_point(simulate(Model("linearized", a=0.08), "plus"), tmp_path / "point.nc")
    with xr.open_dataset(tmp_path / "point.nc") as dataset:
        meanings = dataset["status"].attrs["flag_meanings"].split()
        assert meanings[dataset["status"].item()] == "step_limit"
        assert np.isnan(dataset["mean_distance"].item())
        assert np.isnan(dataset["distance"].values[-1])


def test_provenance_names_sources_but_no_person(path):
    import getpass
    import socket

    with xr.open_dataset(path) as dataset:
        text = str(dataset.attrs)
        assert len(dataset.attrs["source_fingerprint"]) == 16
    for word in (socket.gethostname(), getpass.getuser(), "2026"):
        assert f" {word} " not in text


@pytest.mark.parametrize(("solver", "steps"), [("series", False), ("rk4", True)])
def test_only_a_run_in_steps_has_a_step(solver, steps):
    run = simulate(Model("linearized", a=0.08), "plus", solver=solver, transient=0.0, window=5.0)
    assert ("step" in point_attributes(run)) == steps
