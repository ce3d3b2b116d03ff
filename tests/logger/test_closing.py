"""The closing lines of a run."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.variables import flag
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.study.job_log import SILENT
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, WAITING, Job, Run

STATUSES = dict(enumerate(STATUS_FLAG["flag_meanings"].split()))
FOLDER = Path("results/paper/summary")
RULES = {"claims": "claims.json", "mean_distance": "mean_distance.nc", "agreement": "agreement.nc"}
POINT, AGAIN = "results/paper/points/a.nc", "Run the same command again to continue."


@pytest.fixture(autouse=True)
def summaries(tmp_path, monkeypatch):
    """Summaries below the current folder."""
    monkeypatch.chdir(tmp_path)
    FOLDER.mkdir(parents=True)
    (FOLDER / "claims.json").write_text(json.dumps({"independent_counts": {"holds": 2, "fails": 10}}))
    for name, meanings, values in (("status", STATUSES, [0, 3, 0, 1, 3]), ("kind", MotionKind, [-1, 3, 0, -1, 2])):
        dataset = xr.Dataset({name: ("a", np.array(values, dtype="i1"), flag("i1", meanings))})
        dataset.to_netcdf(FOLDER / RULES["mean_distance" if name == "status" else "agreement"])


def lines(*jobs, wanted=tuple(RULES), seconds=1.0, stopped=False, arguments=()):
    """Return the last lines of a run of these (name, state, output, log)."""
    begun = [Job(name, "", state=state, output=output, log=log) for name, state, output, log in jobs]
    return closing_lines(Run("results/paper", dict(enumerate(begun)), wanted), seconds, stopped, arguments)


def done(*paths):
    return [("x", DONE, [path], []) for path in paths]


def test_a_whole_study():
    paths = [POINT, "results/paper/points/b.nc", "results/paper/summary/claims.json", "results/paper/report.html"]
    assert lines(*done(*paths), wanted=(*RULES, "report"), seconds=312.0) == [
        "study paper: done in 5 min 12 s on 1 core",
        "files made in results/paper: points 2, summary 1, report.html",
        f"12 independent claims of the paper: holds 2, fails 10 ({FOLDER}/claims.md)",
        f"points: completed 2, diverged 2, step_limit 1 (status in {FOLDER}/mean_distance.nc)",
        "motion of the points: undetermined 2, chaotic 1, synchronized 1, quasiperiodic 1 "
        f"(kind in {FOLDER}/agreement.nc)",
        "report: results/paper/report.html",
    ]
    # The lines about a single point do not mention summaries.
    assert lines(*done(POINT), wanted=["simulate"]) == ["study paper: done in 1 s on 1 core", f"made: {POINT}"]


@pytest.mark.parametrize("content", [b"", b"{", b'{"counts": 3}', b'{"counts": {}}', b"[]", b"\xff\xfe"])
def test_a_corrupt_summary_gives_a_line_and_no_error(content):
    for name in RULES.values():
        (FOLDER / name).write_bytes(content)
    said = lines()[2:]
    assert [line.partition(": cannot be read (")[0] for line in said] == [str(FOLDER / n) for n in RULES.values()]


def test_a_run_that_failed():
    error = (
        "Traceback (most recent call last):\n  raise\nburridge_knopoff.provenance.bad_file.BadFile: x.nc: is empty\n\n"
    )
    Path("mean.log").write_text(error)
    failed = [("mean", FAILED, [], ["mean.log"]), *((f"simulate a={n}", FAILED, [], [f"{n}.log"]) for n in range(2))]
    assert lines(*failed, *[("", WAITING, [], [])] * 6, *done(POINT), seconds=5.0) == [
        "study paper: stopped after 5 s: 3 jobs failed, 6 jobs did not run",
        "failed: mean: x.nc: is empty (log mean.log)",
        *(f"failed: simulate a={n}: {SILENT} (log {n}.log)" for n in range(2)),
        f"made: {POINT}",
        "Finished results are kept; the same command would fail again until the cause is removed.",
    ]
    # A job that was killed has no error in its log, and may succeed the next time.
    assert lines(*failed[1:])[-1] == AGAIN


def test_a_log_that_somebody_sent_gives_no_command():
    """A job that was killed at its start leaves the log that was there before."""
    for n, words in enumerate(
        ("touch evil", "snakemake -s evil -R x", "snakemake -R ../x", "x -R 'results/paper/../x'")
    ):
        Path(f"{n}.log").write_text(
            f"Traceback (most recent call last):\n  raise\nBad: a: is empty; remake it: {words}\n"
        )
        assert not any("evil" in line or "recreates" in line for line in lines((f"job {n}", FAILED, [], [f"{n}.log"])))


def test_bad_files_are_remade_by_one_command_and_by_no_other():
    """Seven jobs stop at two bad files: the command of the run would stop there again."""
    head = "snakemake -c2 --configfile 'my study.yaml' -R"
    texts = {"software": "", "git_commit": "", "arguments": "--configfile 'my study.yaml'", "config_file": ""}
    (FOLDER.parent / "study.json").write_text(json.dumps({**texts, "given": {}, "config": {}, "grid": {}}))
    for n in range(7):
        file = f"results/paper/points/{n % 2}.nc"
        error = f"burridge_knopoff.provenance.bad_file.BadFile: {file}: is empty; remake it: {head} {file}"
        Path(f"{n}.log").write_text(f"Traceback (most recent call last):\n  raise\n{error}\n")
    assert lines(*((f"job {n}", FAILED, [], [f"{n}.log"]) for n in range(7))) == [
        "study paper: stopped after 1 s: 7 jobs failed",
        "failed: job 0 and 3 more: results/paper/points/0.nc: is empty (log 0.log)",
        "failed: job 1 and 2 more: results/paper/points/1.nc: is empty (log 1.log)",
        "made: nothing",
        "this command recreates the bad files and continues: "
        f"{head} results/paper/points/0.nc results/paper/points/1.nc",
    ]


def test_a_run_that_was_interrupted():
    """A job whose end is not in the log did not run to its end, even if its file exists."""
    Path("x.nc").touch()
    told = "study paper: stopped after 1 s: 1 job did not run"
    assert lines(("x", RUNNING, ["x.nc"], [])) == [told, "made: nothing", AGAIN]
    # One that is stopped when its last job was done.
    assert lines(stopped=True) == ["study paper: stopped after 1 s: before its end", "made: nothing", AGAIN]


@pytest.mark.parametrize(
    ("arguments", "command"),
    [
        ("-c2 -R agreement runs --configfile x.yaml", "-c2 --configfile x.yaml"),
        ("-c2 -F", "-c2"),
        ("-Fc2 summary", "-c2 summary"),
        ("-kfp -c 2 results/paper/summary/runs.nc", "-kp -c 2 results/paper/summary/runs.nc"),
        ("-c2 --forceall --force-use-threads -k", "-c2 --force-use-threads -k"),
        ("--forcerun=runs -c2 all", "-c2 all"),
        ("-c2 --forcerun runs agreement -- all -F", "-c2 -- all -F"),
        ("-c2 -kRruns --until points -R runs", "-c2 -k --until points"),
    ],
)
def test_an_interrupted_run_does_not_start_over(arguments, command):
    """With -f, -F and -R the same command would make again what is finished."""
    (*_, last) = lines(("x", RUNNING, ["x.nc"], []), arguments=arguments.split())
    assert (
        last
        == f"The same command would start all over; this one makes what is missing or out of date: snakemake {command}"
    )


def test_a_command_that_continues_is_told_in_words():
    for arguments in (["-c2", "summary"], ["-c2", "--configfile", "Force.yaml", "-n"], ["-c2", "--config", "study=-F"]):
        assert lines(("x", RUNNING, ["x.nc"], []), arguments=arguments)[-1] == AGAIN
    (*_, last) = lines(("x", RUNNING, ["x.nc"], []), arguments=["-F", "--configfile", "my study.yaml"])
    assert last.endswith("snakemake --configfile 'my study.yaml'")
