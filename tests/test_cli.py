"""`bk`: results, help, and one line with exit code 2 for bad input."""

import signal
import subprocess
import sys
from pathlib import Path

import netCDF4
import pytest

from burridge_knopoff.cli import main
from burridge_knopoff.simulation import simulate

BK = str(Path(sys.executable).parent / "bk")
SHORT = ["--transient", "10", "--window", "20", "--batches", "2"]
RUN = ["simulate", "--law", "linearized", "--a", "0.08", *SHORT]


def bk(*arguments, cwd=None):
    return subprocess.run([BK, *arguments], capture_output=True, text=True, cwd=cwd)


def test_a_point_is_what_python_simulates(tmp_path):
    out = tmp_path / "new folder" / "point.nc"
    run = bk(*RUN, "--initial", "plus", "--out", str(out))
    assert (run.returncode, run.stdout, run.stderr) == (0, "", "")
    expected = simulate("linearized", 0.08, "plus", transient=10.0, window=20.0, batches=2)
    with netCDF4.Dataset(out) as dataset:
        assert dataset["mean_distance"][...] == expected.mean_distance
        assert (dataset["event_time"][:] == expected.event_time).all()
    assert [path.name for path in out.parent.iterdir()] == ["point.nc"]


def test_all_options(tmp_path):
    out = tmp_path / "all.nc"
    options = (
        "--law nonlinear --solver rk4 --step 0.01 --a 0.3 --v 0.2 --blocks 2 --initial pair --position -0.9,-1.1 "
        "--velocity -0.1,0.1 --contact symmetric --start tested --transient 0 --window 30 --batches 3 --sampling 1 "
        "--trajectory 5 --trajectory-sampling 0.5 --events all --event-window 1 "
        "--lyapunov-exponents 2 --lyapunov-alignment 7"
    )
    assert main(["simulate", *options.split(), "--out", str(out)]) == 0
    with netCDF4.Dataset(out) as dataset:
        assert dataset.solver == "rk4"
        assert dataset.step == 0.01
        assert dataset.initial == "pair"
        assert (dataset.contact, dataset.start) == ("symmetric", "tested")
        assert dataset["v"][...] == 0.2
        assert dataset["initial_position"][:].tolist() == [-0.9, -1.1]
        assert len(dataset.dimensions["sample"]) == 31
        assert len(dataset.dimensions["trajectory_time"]) == 11
        assert len(dataset.dimensions["batch"]) == 3
        assert len(dataset.dimensions["exponent"]) == 2
        assert dataset["event_time"][0] < 29.0


def test_no_events(tmp_path):
    out = tmp_path / "none.nc"
    assert main([*RUN, "--events", "none", "--out", str(out)]) == 0
    with netCDF4.Dataset(out) as dataset:
        assert len(dataset.dimensions["event"]) == len(dataset.dimensions["earlier_event"]) == 0
        assert dataset["event_count"][...] > 0


@pytest.mark.parametrize(
    ("arguments", "words"),
    [
        ([], "COMMAND"),
        (["simulat"], "simulat"),
        (["simulate"], "--law"),
        ([*RUN], "--out"),
        ([*RUN, "--outt", "x.nc"], "--out"),
        ([*RUN, "--a", "x", "--out", "x.nc"], "--a: 'x' is not allowed: a number"),
        ([*RUN, "--a", "1_0", "--out", "x.nc"], "--a: '1_0' is not allowed: a number"),
        ([*RUN, "--v", "٣", "--out", "x.nc"], "--v: '٣' is not allowed: a number"),
        ([*RUN, "--v", "", "--out", "x.nc"], "--v: '' is not allowed: a number"),
        ([*RUN, "--v", "0x1", "--out", "x.nc"], "--v: '0x1' is not allowed: a number"),
        ([*RUN, "--batches", "1e3", "--out", "x.nc"], "--batches: '1e3' is not allowed: a whole number"),
        ([*RUN, "--batches", "9" * 5000, "--out", "x.nc"], "is not allowed: a whole number"),
        ([*RUN, "--position", "1,nan,1", "--out", "x.nc"], "position: nan is not allowed: finite numbers"),
        ([*RUN, "--position", "1,1e7,1", "--out", "x.nc"], "position: 10000000.0 is not allowed"),
        ([*RUN, "--v", "0", "--out", "x.nc"], "v: 0.0 is not allowed: 1e-06 to 1000"),
        ([*RUN, "--start", "later", "--out", "x.nc"], "moving | tested"),
        ([*RUN, "--solver", "rk4", "--step", "1e-9", "--window", "1e4", "--out", "x.nc"], "step: 1e-09 is not allowed"),
        ([*RUN, "--events", "all", "--window", "1e9", "--sampling", "1e4", "--out", "x.nc"], "events: 'all' is not"),
        ([*RUN, "--out", ""], "cannot be written"),
        (["check"], "FOLDER"),
        (["check", "nothing"], "nothing: not the results of a study"),
        (["check", "."], ".: not the results of a study"),
        (["check", ".", "--path"], "--path"),
        ([*RUN, "--out", "x.nc", "point"], "point"),
        ([*RUN, "--a", "-0.1", "--out", "x.nc"], "a: -0.1"),
        ([*RUN, "--a", "nan", "--out", "x.nc"], "a: nan"),
        ([*RUN, "--a", "1e400", "--out", "x.nc"], "a: inf"),
        ([*RUN, "--law", "linear", "--out", "x.nc"], "linearized | nonlinear"),
        ([*RUN, "--law", "nonlinear", "--solver", "map", "--out", "x.nc"], "series | rk4"),
        ([*RUN, "--solver", "euler", "--out", "x.nc"], "map | series | rk4"),
        ([*RUN, "--initial", "middle", "--out", "x.nc"], "minus | plus"),
        ([*RUN, "--blocks", "4", "--out", "x.nc"], "blocks: 4"),
        ([*RUN, "--blocks", "1", "--out", "x.nc"], "blocks: 1"),
        ([*RUN, "--position", "1,2,z", "--out", "x.nc"], "--position"),
        ([*RUN, "--position", "1,2", "--out", "x.nc"], "velocity: 3 numbers for 2"),
        ([*RUN, "--velocity", "0.1,-0.1,0.1", "--out", "x.nc"], "one_sided"),
        ([*RUN, "--window", "0", "--out", "x.nc"], "window: 0"),
        ([*RUN, "--transient", "-5", "--out", "x.nc"], "transient: -5"),
        ([*RUN, "--window", "inf", "--out", "x.nc"], "window: inf"),
        ([*RUN, "--batches", "1", "--out", "x.nc"], "batches: 1"),
        ([*RUN, "--batches", "2.5", "--out", "x.nc"], "--batches"),
        ([*RUN, "--step", "0", "--out", "x.nc"], "step: 0"),
        ([*RUN, "--lyapunov-exponents", "-1", "--out", "x.nc"], "lyapunov_exponents: -1"),
        ([*RUN, "--lyapunov-exponents", "7", "--out", "x.nc"], "lyapunov_exponents: 7 is not allowed: at most 6"),
        ([*RUN, "--lyapunov-exponents", "two", "--out", "x.nc"], "--lyapunov-exponents"),
        ([*RUN, "--lyapunov-alignment", "-1", "--out", "x.nc"], "lyapunov_alignment: -1"),
        ([*RUN, "--lyapunov-alignment", "inf", "--out", "x.nc"], "lyapunov_alignment: inf"),
        ([*RUN, "--events", "some", "--out", "x.nc"], "none | window | all"),
        ([*RUN, "--contact", "loose", "--out", "x.nc"], "one_sided | symmetric"),
        ([*RUN, "--sampling", "1e-6", "--window", "1e6", "--out", "x.nc"], "sampling: 1e-06"),
        ([*RUN, "--out", "/proc/x.nc"], "/proc/x.nc: cannot be written"),
        ([*RUN, "--out", "."], "cannot be written"),
        ([*RUN, "--event", "all", "--out", "x.nc"], "--event"),
        ([*RUN, "--out", "/dev/null"], "/dev/null: cannot be written: it is not a regular file"),
        ([*RUN, "--initial", "two words", "--out", "x.nc"], "'two words' is not allowed"),
        ([*RUN, "--position", "", "--out", "x.nc"], "numbers with commas"),
    ],
)
def test_bad_input(tmp_path, arguments, words):
    run = bk(*arguments, cwd=tmp_path)
    assert run.returncode == 2
    assert run.stdout == ""
    assert run.stderr.count("\n") == 1
    assert words in run.stderr
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_ends_early_says_so(tmp_path):
    run = bk(
        *RUN[:4], "1.9", "--contact", "symmetric", "--transient", "0", "--window", "1000", "--out", "x.nc", cwd=tmp_path
    )
    assert run.returncode == 0
    assert run.stderr.count("\n") == 1
    assert "status diverged" in run.stderr
    with netCDF4.Dataset(tmp_path / "x.nc") as dataset:
        assert 0.0 < dataset["end_time"][...] < 1000.0
        assert dataset["mean_distance"][...] != dataset["mean_distance"][...]


def test_a_link_stays_and_its_target_is_written(tmp_path):
    (tmp_path / "target.nc").write_text("old")
    (tmp_path / "link.nc").symlink_to("target.nc")
    assert main([*RUN, "--out", str(tmp_path / "link.nc")]) == 0
    assert (tmp_path / "link.nc").is_symlink()
    assert (tmp_path / "target.nc").stat().st_size > 10_000


def test_an_interrupt_ends_a_long_run_with_one_line(tmp_path):
    command = [BK, *RUN, "--solver", "rk4", "--step", "1e-7", "--out", "x.nc"]
    process = subprocess.Popen(command, cwd=tmp_path, stderr=subprocess.PIPE, text=True)
    with pytest.raises(subprocess.TimeoutExpired):
        process.wait(timeout=3)
    process.send_signal(signal.SIGINT)
    _, message = process.communicate(timeout=30)
    assert process.returncode == 130
    assert message == "bk simulate: interrupted, nothing was written\n"
    assert list(tmp_path.iterdir()) == []


def test_help_names_every_setting():
    from dataclasses import fields

    from burridge_knopoff.settings import Settings

    text = bk("simulate", "--help").stdout
    for item in fields(Settings):
        assert f"--{item.name.replace('_', '-')}" in text
    assert "examples:" in text
    assert "simulate" in bk("--help").stdout


def test_start_up_imports_no_heavy_library(tmp_path):
    """A point job pays for the interpreter, numpy and netCDF4 only."""
    code = (
        "import sys; from burridge_knopoff.cli import main; "
        f"main({[*RUN, '--out', str(tmp_path / 'x.nc')]!r}); "
        "print(sorted({'xarray', 'pandas', 'scipy', 'matplotlib', 'jsonschema', 'snakemake', 'yaml', 'cython'} "
        "& set(sys.modules)))"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert run.stdout == "[]\n"
