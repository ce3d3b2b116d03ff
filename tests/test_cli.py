"""`bk`: results, help, and one line with exit code 2 for bad input."""

import os
import shlex
import signal
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

import netCDF4
import pytest

from burridge_knopoff import Chain, FormulaLaw, Model, Settings, simulate
from burridge_knopoff.cli import build_parser, main
from burridge_knopoff.cli.options import simulated_law
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import to_ascii, with_error
from burridge_knopoff.study.load import load_study

BK = str(Path(sys.executable).parent / "bk")
SHORT = ["--transient", "10", "--window", "20", "--batches", "2"]
RUN = ["simulate", "--law", "linearized", "--a", "0.08", *SHORT]
DROP = ["simulate", "--law", "carlson_langer", "--a", "0.08", *SHORT]
OWN = ["simulate", "--a", "0.08", *SHORT, "--formula"]


def without_doubles(arguments):
    """Return the arguments of a row; an option replaces an earlier one of RUN."""
    kept = list(arguments)
    for name in ("--law", "--a", "--transient", "--window", "--batches"):
        if kept.count(name) > 1:
            at = kept.index(name)
            del kept[at : at + 2]
    return kept


def bk(*arguments, cwd=None):
    return subprocess.run([BK, *arguments], capture_output=True, text=True, cwd=cwd)


def test_a_point_is_what_python_simulates(tmp_path):
    out = tmp_path / "a folder" / "point.nc"
    out.parent.mkdir()
    run = bk(*RUN, "--initial", "plus", "--out", str(out))
    assert (run.returncode, run.stderr) == (0, "")
    expected = simulate(Model("linearized", a=0.08), "plus", transient=10.0, window=20.0, batches=2)
    mean, error = expected.mean_distance, expected.mean_distance_error
    assert run.stdout.startswith(f"{out}: <J> = {to_ascii(with_error(mean, error))}, largest Lyapunov exponent ")
    assert run.stdout.endswith(f", {expected.event_count} stops and starts until tau = 30\n")
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
        expected = {"solver": "rk4", "step": 0.01, "initial": "pair", "contact": "symmetric", "start": "tested"}
        assert {name: dataset.getncattr(name) for name in expected} == expected
        assert dataset["v"][...] == 0.2
        assert dataset["initial_position"][:].tolist() == [-0.9, -1.1]
        sizes = {"sample": 31, "trajectory_time": 11, "batch": 3, "exponent": 2}
        assert {name: len(dataset.dimensions[name]) for name in sizes} == sizes
        assert dataset["event_time"][0] < 29.0


def test_a_custom_law_in_a_ring(tmp_path):
    """It needs neither a compiler nor a file: the formula, its parameters and the springs are in the point."""
    out = tmp_path / "own.nc"
    options = ["--number", "c=0.1", "--law-name", "soft", "--ends", "ring", "--coupling", "1,2,3", "--pulling", "0.5"]
    assert main([*OWN, "1 - c*tanh(a*u/c)", *options, "--threshold", "1,1.5,1", "--out", str(out)]) == 0
    law = FormulaLaw("1 - c*tanh(a*u/c)", name="soft", a=0.08, c=0.1)
    chain = Chain(3, (1.0, 2.0, 3.0), 0.5, (1.0, 1.5, 1.0), "ring")
    expected = simulate(Model(law, chain=chain), "minus", transient=10.0, window=20.0, batches=2)
    with netCDF4.Dataset(out) as dataset:
        assert dataset["mean_distance"][...] == expected.mean_distance
        assert (dataset.law, dataset.law_formula, dataset.law_c) == ("soft", "1 - c*tanh(a*u/c)", 0.1)
        assert dataset.chain_coupling.tolist() == [1.0, 2.0, 3.0]
        assert dataset.chain_threshold.tolist() == [1.0, 1.5, 1.0]
        assert (dataset.chain_pulling, dataset.chain_ends) == (0.5, "ring")
        words = shlex.split(dataset.history)
    again = tmp_path / "again.nc"
    assert main([*words[1:], "--out", str(again)]) == 0
    assert again.read_bytes() == out.read_bytes()


@pytest.mark.parametrize(
    ("law", "numbers"),
    [
        ({"law": "carlson_langer"}, {"sigma": 0.02}),
        ({"law": "stribeck"}, {"sigma": 0.1, "eta": 0.3}),
        ({"formula": "1 - c*tanh(a*u/c)"}, {"c": 0.3}),
    ],
)
def test_the_numbers_of_a_law_have_one_name_in_python_a_config_and_a_command(law, numbers):
    settings = {"transient": 1.0, "window": 1.0, "batches": 2, "lyapunov_exponents": 0}
    expected = simulate(Model(law, a=0.1, **numbers), "minus", **settings).model.law
    assert dict(expected.parameters) == {"a": 0.1, **numbers}
    ((kind, words),) = law.items()
    options = [word for name, value in numbers.items() for word in ("--number", f"{name}={value}")]
    command = ["simulate", f"--{kind}", words, *options, "--law-name", expected.name, "--a", "0.1", "--out", "x.nc"]
    assert simulated_law(build_parser().parse_args(command)) == expected
    config = {"study": "x", "initial": {"minus": {}}}
    study = load_study({**config, "a": [0.1], "laws": {expected.name: {**law, **numbers}}}, "x.yaml")
    assert study.model(expected.name, 0.1).law == expected
    # As parameters of a grid.
    grid = {"a": [0.1], **{name: [value] for name, value in numbers.items()}}
    plane = load_study(
        {**config, "grid": grid, "laws": {expected.name: {**law, **dict.fromkeys(numbers, 0.2)}}}, "x.yaml"
    )
    assert plane.model(expected.name, 0.1, **plane.other_values[0]).law == expected


def test_parameters_and_another_name_of_a_built_in_law(tmp_path):
    assert main([*DROP, "--number", "sigma=0.02", "--law-name", "drop", "--out", str(tmp_path / "x.nc")]) == 0
    with netCDF4.Dataset(tmp_path / "x.nc") as dataset:
        assert (dataset.law, dataset.law_sigma) == ("drop", 0.02)
        begin = "bk simulate --law carlson_langer --law-name drop --number sigma=0.02 --a 0.08 "
        assert dataset.history.startswith(begin)


@pytest.mark.parametrize(
    ("given", "position"),
    [(["--position", "-0.9,-1,-1"], [-0.9, -1.0, -1.0]), (["--velocity", "0.1,0.1,0.1"], [-0.989, -0.993, -0.991])],
)
def test_a_state_without_a_name_is_not_one_of_the_paper(tmp_path, given, position):
    assert main([*RUN, *given, "--out", str(tmp_path / "x.nc")]) == 0
    with netCDF4.Dataset(tmp_path / "x.nc") as dataset:
        assert dataset.initial == "own"
        assert dataset["initial_position"][:].tolist() == position


def test_the_other_half_of_a_state_is_that_of_the_paper_at_this_v(tmp_path):
    model = Model("nonlinear", a=0.08, v=0.03)
    position, velocity = model.initial_coordinates(PAPER_STATES["minus"])
    for arguments, half in ((["--position", "-0.9,-1,-1"], "position"), (["--velocity", "0.1,0.2,0.3"], "velocity")):
        options = ["--law", "nonlinear", "--a", "0.08", "--v", "0.03", "--transient", "0", "--window", "1", *arguments]
        assert main(["simulate", *options, "--out", str(tmp_path / "x.nc")]) == 0
        with netCDF4.Dataset(tmp_path / "x.nc") as dataset:
            assert (dataset["initial_position"][:] == position).all() == (half != "position")
            assert (dataset["initial_velocity"][:] == velocity).all() == (half != "velocity")


def test_a_state_of_the_paper_follows_v_and_its_command_makes_the_same_file(tmp_path):
    for v in ("0.1", "0.2"):
        first, again = tmp_path / f"{v}.nc", tmp_path / f"{v}_again.nc"
        assert main([*RUN, "--v", v, "--initial", "plus", "--out", str(first)]) == 0
        with netCDF4.Dataset(first) as dataset:
            assert ("--position" in dataset.history) == (v == "0.1")
            assert dataset["initial_velocity"][0] == pytest.approx(0.99 * float(v), rel=1e-15)
            words = shlex.split(dataset.history)
        assert main([*words[1:], "--out", str(again)]) == 0
        assert again.read_bytes() == first.read_bytes()


def test_times_longer_than_the_run_are_reported(tmp_path, capsys):
    assert main([*RUN, "--trajectory", "5000", "--event-window", "25", "--out", str(tmp_path / "x.nc")]) == 0
    output = capsys.readouterr().err.splitlines()
    assert output == [
        "note: bk simulate: trajectory: 5000 is longer than the run; all 30 time units were recorded",
        "note: bk simulate: event_window: 25 is longer than the window; all 20 time units were recorded",
    ]


@pytest.mark.slow
def test_the_cost_of_a_long_chain_is_printed_before_the_run(tmp_path):
    options = "--law nonlinear --a 0.3 --blocks 100000 --position=-0.9 --velocity 0.1 --initial all --trajectory 1"
    command = [BK, "simulate", *options.split(), "--lyapunov-exponents", "0", "--out", tmp_path / "x.nc"]
    with subprocess.Popen(command, stderr=subprocess.PIPE, text=True) as process:
        output = process.stderr.readline()
        process.send_signal(signal.SIGINT)
    assert output == (
        "note: bk simulate: 100000 blocks: about 5 min per time unit, 35 days for the run if they keep slipping; "
        "0.45 GB in addition to the recorded events\n"
    )


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
        (["simulate", "--law", "linearized", "--out", "x.nc"], "--a: "),
        (["simulate", "--formula", "1 - a*u", "--out", "x.nc"], "--a: "),
        (["simulate"], "--out"),
        ([*RUN], "--out"),
        ([*RUN, "--outt", "x.nc"], "--out"),
        ([*RUN, "--a", "x", "--out", "x.nc"], "--a: 'x'"),
        ([*RUN, "--a", "1_0", "--out", "x.nc"], "--a: '1_0'"),
        ([*RUN, "--v", "٣", "--out", "x.nc"], "--v: '٣'"),
        ([*RUN, "--v", "", "--out", "x.nc"], "--v: ''"),
        ([*RUN, "--v", "0x1", "--out", "x.nc"], "--v: '0x1'"),
        ([*RUN, "--v", "010", "--out", "x.nc"], "--v: '010'"),
        ([*RUN, "--window", "1_0.5", "--out", "x.nc"], "--window: '1_0.5'"),
        ([*RUN, "--batches", "03", "--out", "x.nc"], "--batches: '03'"),
        ([*RUN, "--blocks", "03", "--out", "x.nc"], "--blocks: '03'"),
        ([*RUN, "--grid", "3,01", "--out", "x.nc"], "--grid: '3,01'"),
        ([*RUN, "--position", "1,-01,1", "--out", "x.nc"], "--position: '1,-01,1'"),
        ([*RUN, "--section", "block=02", "--out", "x.nc"], "section.block: '02'"),
        (
            [*RUN, "--threshold", "random=uniform,low=1,high=1_0,seed=1", "--out", "x.nc"],
            "chain.threshold.high: '1_0'",
        ),
        ([*DROP, "--number", "sigma=00", "--out", "x.nc"], "--number: '00'"),
        ([*RUN, "--batches", "1e3", "--out", "x.nc"], "--batches: '1e3'"),
        ([*RUN, "--batches", "9" * 5000, "--out", "x.nc"], "--batches: '999"),
        ([*RUN, "--position", "1,nan,1", "--out", "x.nc"], "position[1]: nan"),
        ([*RUN, "--position", "1,1e7,1", "--out", "x.nc"], "position[1]: 10000000.0"),
        ([*RUN, "--v", "0", "--out", "x.nc"], "v: 0.0"),
        ([*RUN, "--start", "later", "--out", "x.nc"], "start: 'later'"),
        ([*RUN, "--solver", "rk4", "--step", "1e-9", "--window", "1e4", "--out", "x.nc"], "step: 1e-09"),
        ([*RUN, "--out", ""], "cannot be written"),
        (["check"], "FOLDER"),
        (["check", "nothing"], "nothing: "),
        (["check", "."], " .: "),
        (["check", ".", "--path"], "--path"),
        ([*RUN, "--out", "x.nc", "point"], "point"),
        ([*RUN, "--a", "-0.1", "--out", "x.nc"], "a: -0.1"),
        ([*RUN, "--a", "nan", "--out", "x.nc"], "a: nan"),
        ([*RUN, "--a", "1e400", "--out", "x.nc"], "a: inf"),
        ([*RUN, "--law", "linear", "--out", "x.nc"], "law: 'linear'"),
        ([*RUN, "--law", "1 - a*u", "--out", "x.nc"], '--formula "1 - a*u"'),
        ([*RUN, "--law", "nonlinear", "--solver", "map", "--out", "x.nc"], "solver: 'map'"),
        ([*RUN, "--solver", "euler", "--out", "x.nc"], "solver: 'euler'"),
        (["simulate", "--a", "0.1", "--out", "x.nc"], "--law --formula"),
        ([*RUN, "--formula", "1 - a*u", "--out", "x.nc"], "--formula: "),
        ([*RUN, "--number", "sigma=0.1", "--out", "x.nc"], "linearized.sigma: "),
        ([*RUN, "--number", "sigma", "--out", "x.nc"], "--number: 'sigma'"),
        ([*RUN, "--number", "sigma=x", "--out", "x.nc"], "--number: 'x'"),
        ([*RUN, "--number", "law=1", "--out", "x.nc"], "--number: 'law=1'"),
        ([*RUN, "--law-name", "a/b", "--out", "x.nc"], "--law-name: 'a/b'"),
        ([*DROP, "--number", "sigma=1", "--out", "x.nc"], "carlson_langer: '(1 - sigma)/"),
        (
            [*DROP, *("--number", "sigma=0.1") * 2, "--out", "x.nc"],
            "--number: ",
        ),
        ([*OWN, "1 - b*u", "--out", "x.nc"], "formula.a: not a parameter"),
        (["orbit", "--law", "linearized", "--a", "0.08", "--events", "-3"], "--events: '-3'"),
        ([*OWN, "a - 1", "--out", "x.nc"], "formula: 'a - 1'"),
        ([*OWN, "", "--out", "x.nc"], "not a formula"),
        ([*OWN, "__import__('os')", "--out", "x.nc"], "not a formula"),
        ([*OWN, "1 - a*u", "--number", "u=1", "--out", "x.nc"], "formula.u: "),
        ([*OWN, "1 - window*u", "--number", "window=1", "--out", "x.nc"], "window: "),
        ([*OWN, "1 - samples*u", "--number", "samples=1", "--out", "x.nc"], "samples: "),
        ([*OWN, "1 - a*u", "--number", "self=1", "--out", "x.nc"], "formula.self: "),
        ([*RUN, "--coupling", "1,2,3", "--out", "x.nc"], "chain.coupling: "),
        ([*RUN, "--coupling", "-1,2", "--out", "x.nc"], "chain.coupling[0]: -1.0"),
        ([*RUN, "--pulling", "all", "--out", "x.nc"], "--pulling: 'all'"),
        ([*RUN, "--threshold", "nan", "--out", "x.nc"], "chain.threshold: nan"),
        ([*RUN, "--ends", "closed", "--out", "x.nc"], "chain.ends: 'closed'"),
        ([*RUN, "--ends", "ring", "--solver", "map", "--out", "x.nc"], "solver: 'map'"),
        ([*RUN, "--initial", "middle", "--out", "x.nc"], "initial: 'middle'"),
        ([*RUN, "--initial", "Plus", "--out", "x.nc"], "plus?"),
        ([*RUN, "--blocks", "4", "--out", "x.nc"], "blocks: 4"),
        ([*RUN, "--blocks", "1", "--out", "x.nc"], "blocks: 1"),
        ([*RUN, "--position", "1,2,z", "--out", "x.nc"], "--position"),
        ([*RUN, "--position", "1,2", "--out", "x.nc"], "velocity: "),
        ([*RUN, "--velocity", "0.1,-0.1,0.1", "--out", "x.nc"], "velocity: -0.1"),
        ([*RUN, "--window", "0", "--out", "x.nc"], "window: 0"),
        ([*RUN, "--transient", "-5", "--out", "x.nc"], "transient: -5"),
        ([*RUN, "--window", "inf", "--out", "x.nc"], "window: inf"),
        ([*RUN, "--batches", "1", "--out", "x.nc"], "batches: 1"),
        ([*RUN, "--batches", "2.5", "--out", "x.nc"], "--batches"),
        ([*RUN, "--step", "0", "--out", "x.nc"], "step: 0"),
        ([*RUN, "--lyapunov-exponents", "-1", "--out", "x.nc"], "lyapunov_exponents: -1"),
        ([*RUN, "--lyapunov-exponents", "7", "--out", "x.nc"], "lyapunov_exponents: 7"),
        ([*RUN, "--lyapunov-exponents", "two", "--out", "x.nc"], "--lyapunov-exponents"),
        ([*RUN, "--lyapunov-alignment", "-1", "--out", "x.nc"], "lyapunov_alignment: -1"),
        ([*RUN, "--lyapunov-alignment", "inf", "--out", "x.nc"], "lyapunov_alignment: inf"),
        ([*RUN, "--events", "some", "--out", "x.nc"], "events: 'some'"),
        ([*RUN, "--contact", "loose", "--out", "x.nc"], "contact: 'loose'"),
        ([*RUN, "--sampling", "1e-6", "--window", "1e6", "--out", "x.nc"], "sampling: 1e-06"),
        ([*RUN, "--out", "/proc/x.nc"], "/proc/x.nc: "),
        ([*RUN, "--out", "."], "cannot be written"),
        ([*RUN, "--event", "all", "--out", "x.nc"], "--event"),
        ([*RUN, "--out", "/dev/null"], "/dev/null: "),
        ([*RUN, "--initial", "two words", "--out", "x.nc"], "--initial: 'two words'"),
        ([*RUN, "--position", "", "--out", "x.nc"], "--position: ''"),
        ([*RUN, "--out", "no/folder/x.nc"], "no/folder/x.nc: "),
        ([*RUN, "--initial", "plus", "--position", "1,1,1", "--out", "x.nc"], "initial: 'plus'"),
        (["attractors", "--law", "linearized", "--a", "0.08", "--samples", "-1"], "samples: -1"),
        (
            ["attractors", "--law", "linearized", "--a", "0.08", "--position-box", "1,0"],
            "position: (1.0, 0.0)",
        ),
        (["basins", "--law", "linearized", "--a", "0.08", "--pixels", "0"], "pixels: 0"),
        (["basins", "--law", "linearized", "--a", "0", "--samples", "1", "--pixels", "1"], "transient: 3000"),
        (["orbit", "--law", "linearized", "--a", "0.08", "--settling", "-1"], "settling: -1.0"),
        (["exponents", "--law", "linearized", "--a", "0.08", "--lyapunov-exponents", "7"], "lyapunov_exponents: 7"),
        (["exponents", "--law", "linearized", "--a", "0.08", "--longest-period", "0"], "longest_period: 0.0"),
        (
            ["basins", *RUN[1:5], "--out", "x.nc", "--attractors-out", "./x.nc"],
            "--attractors-out: './x.nc'",
        ),
        (["orbit", *RUN[1:5], "--v", "0.1", "--v=0.2"], "--v: "),
        (["orbit", *RUN[1:3], "--a", "3"], "a = 3.0"),
        (["orbit", *RUN[1:5], "--threshold", "1,2,3"], "chain: "),
        (["show", "x.nc"], "x.nc: "),
        (["completion", "csh"], "'csh'"),
    ],
)
def test_bad_input(tmp_path, monkeypatch, capsys, arguments, words):
    monkeypatch.chdir(tmp_path)
    try:
        code = main(without_doubles(arguments))
    except SystemExit as end:
        code = end.code
    output = capsys.readouterr()
    assert (code, output.out) == (2, "")
    assert output.err.count("\n") == 1
    assert words in output.err.replace(": got ", ": ")
    assert list(tmp_path.iterdir()) == []


def test_a_run_that_ends_early_is_reported(tmp_path):
    longer = ["--transient", "0", "--window", "1000"]
    run = bk(*RUN[:4], "1.9", "--contact", "symmetric", *longer, "--out", "x.nc", cwd=tmp_path)
    assert (run.returncode, run.stdout) == (3, "")
    assert run.stderr.count("\n") == 1
    assert "diverged at tau" in run.stderr
    with netCDF4.Dataset(tmp_path / "x.nc") as dataset:
        assert 0.0 < dataset["end_time"][...] < 1000.0
        assert dataset["mean_distance"][...] != dataset["mean_distance"][...]


def test_a_link_is_replaced_and_its_target_is_kept(tmp_path):
    (tmp_path / "target.nc").write_text("old")
    (tmp_path / "link.nc").symlink_to("target.nc")
    assert main([*RUN, "--out", str(tmp_path / "link.nc")]) == 0
    assert not (tmp_path / "link.nc").is_symlink()
    assert (tmp_path / "link.nc").stat().st_size > 10_000
    assert (tmp_path / "target.nc").read_text() == "old"


@pytest.mark.slow
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
    text = bk("simulate", "--help").stdout
    for item in (*fields(Chain), *fields(Settings)):
        assert f"--{item.name.replace('_', '-')}" in text
    assert "simulate" in bk("--help").stdout


@pytest.mark.parametrize(
    ("output", "code", "error"),
    [
        (">&-", 0, ""),
        ("> /dev/full", 2, "bk completion: standard output: cannot be written: No space left on device"),
    ],
)
def test_an_output_that_cannot_be_written(output, code, error):
    run = subprocess.run(f"{shlex.quote(BK)} completion bash {output}", shell=True, capture_output=True, text=True)
    assert (run.returncode, run.stderr.strip()) == (code, error)


def test_a_terminal_without_unicode(tmp_path):
    words = [BK, *RUN, "--out", "Größe.nc"]
    environment = {**os.environ, "PYTHONIOENCODING": "ascii"}
    run = subprocess.run(words, cwd=tmp_path, capture_output=True, text=True, env=environment)
    assert (run.returncode, run.stderr) == (0, "")
    assert run.stdout.startswith(r"Gr\xf6\xdfe.nc: <J> = ")


def test_start_up_imports_no_heavy_library(tmp_path):
    """A point job loads only the interpreter, numpy and netCDF4, and no other command."""
    code = (
        "import sys; from burridge_knopoff.cli import main; "
        f"main({[*RUN, '--out', str(tmp_path / 'x.nc')]!r}); "
        "print(sorted({'xarray', 'pandas', 'scipy', 'matplotlib', 'jsonschema', 'snakemake', 'yaml'} "
        "& set(sys.modules))); "
        "print(sorted(name for name in sys.modules if name.startswith('burridge_knopoff.cli.'))); "
        "heavy = tuple(f'burridge_knopoff.{name}' for name in ('check', 'figures', 'show', 'stability', 'summaries')); "
        "print([name for name in sys.modules if name.startswith((*heavy, 'burridge_knopoff.study.'))])"
    )
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    modules = [f"burridge_knopoff.cli.{name}" for name in ("options", "output", "simulate")]
    assert run.stdout.splitlines()[1:] == ["[]", f"{modules}", "['burridge_knopoff.study.formatting']"]
