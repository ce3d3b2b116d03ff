"""The last words of a run."""

import json
from pathlib import Path

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.variables import flag
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.study.job_log import SILENT
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.tally import DONE, FAILED, Job, Rule, Tally
from snakemake_logger_plugin_study.wording import elapsed

STATUSES = dict(enumerate(STATUS_FLAG["flag_meanings"].split()))
RULES = {"claims": "claims.json", "mean_distance": "mean_distance.nc", "lyapunov": "lyapunov.nc"}


@pytest.fixture
def summary(tmp_path, monkeypatch):
    """The folder of summaries, below the current folder."""
    monkeypatch.chdir(tmp_path)
    folder = Path("results/paper/summary")
    folder.mkdir(parents=True)
    return folder


def write(summary, claims=None, statuses=None, kinds=None):
    if claims is not None:
        (summary / "claims.json").write_text(json.dumps(claims))
    for name, variable, meanings, values in (
        ("mean_distance.nc", "status", STATUSES, statuses),
        ("lyapunov.nc", "kind", MotionKind, kinds),
    ):
        if values is not None:
            dataset = xr.Dataset({variable: ("a", np.array(values, dtype="i1"), flag("i1", meanings))})
            dataset.to_netcdf(summary / name)


def claim(name, verdict, reason="It is so."):
    return {"name": name, "verdict": verdict, "reason": reason}


def lines(*jobs, total=None, wanted=(), seconds=1.0):
    """Return the last lines of a run of these (name, state, output, log); the files of jobs that are done are there."""
    begun = {
        number: Job(name, 0.0, "", output, log, state=state) for number, (name, state, output, log) in jobs_of(jobs)
    }
    for job in begun.values():
        for path in map(Path, job.output if job.state == DONE else ()):
            path.parent.mkdir(parents=True, exist_ok=True)
            path.touch()
    tally = Tally({"rule": Rule("stage", len(jobs) if total is None else total, jobs=begun)})
    return closing_lines("results/paper", seconds, tally, wanted)


def jobs_of(jobs):
    return enumerate((*job, (), ())[:4] for job in jobs)


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.4, "0 s"), (59.6, "1 min 0 s"), (312, "5 min 12 s"), (7500, "2 h 5 min")]
)
def test_elapsed(seconds, words):
    assert elapsed(seconds) == words


def test_a_whole_study(summary):
    fails = [claim(f"claim_{n}", "fails") for n in range(10)]
    claims = [*fails, claim("plus", "depends on convention"), claim("x", "holds")]
    counts = {"holds": 1, "holds loosely": 0, "depends on convention": 1, "fails": 10, "not testable": 0}
    write(summary, {"counts": counts, "claims": claims}, [0, 3, 0, 1, 3], [-1, 3, 0, -1, 2])
    made = [f"results/paper/{path}" for path in ("points/a.nc", "points/b.nc", "summary/claims.json", "report.html")]
    assert lines(*(("x", DONE, (path,)) for path in made), wanted=(*RULES, "report"), seconds=312.0) == [
        "study paper: done in 5 min 12 s",
        "files made in results/paper: points 2, summary 1, report.html",
        "claims of the paper: holds 1, holds loosely 0, depends on convention 1, fails 10, not testable 0 "
        f"({summary}/claims.md)",
        "  fails: claim_0, claim_1, claim_2, claim_3, claim_4, claim_5, claim_6, claim_7 and 2 more",
        "  depends on convention: plus",
        f"points: 3 of 5 did not complete: diverged 2, step_limit 1 (status in {summary}/mean_distance.nc)",
        f"points: kind of motion undetermined at 2 of 5 (kind in {summary}/lyapunov.nc)",
        "report: results/paper/report.html",
    ]


def test_claims_that_a_study_cannot_judge_at_all(summary):
    reason = "Not testable here: the paper's driver has v = 0.1, that of the study v = 0.2."
    claims = [claim(f"claim_{n}", "not testable", reason) for n in range(5)]
    write(summary, {"counts": {"holds": 0, "not testable": 5}, "claims": claims})
    expected = [f"claims of the paper: none is judged ({summary}/claims.md)", f"  {reason}"]
    assert lines(wanted=["claims"])[2:] == expected


def test_all_points_completed(summary):
    write(summary, statuses=[0, 0], kinds=[3, 2])
    expected = ["study paper: done in 1 s", "made: nothing", "points: all 2 completed"]
    assert lines(wanted=["mean_distance", "lyapunov"]) == expected


def test_a_single_point_says_nothing_of_summaries(summary):
    write(summary, statuses=[0, 3])
    made = "results/paper/points/a.nc"
    assert lines(("simulate", DONE, (made,)), wanted=["simulate"]) == ["study paper: done in 1 s", f"made: {made}"]


@pytest.mark.parametrize("content", [b"", b"{", b'{"counts": 3}', b'{"counts": {}}', b"[]", b"\xff\xfe"])
def test_a_damaged_summary_gives_a_line_and_no_error(summary, content):
    for name in RULES.values():
        (summary / name).write_bytes(content)
    said = lines(wanted=RULES)[2:]
    assert [line.partition(": cannot be read (")[0] for line in said] == [str(summary / n) for n in RULES.values()]


def test_a_run_that_failed(summary):
    error = "Traceback (most recent call last):\n  raise\nburridge_knopoff.provenance.seal.BadFile: x.nc: is empty\n\n"
    Path("mean.log").write_text(error)
    failed = [("mean", FAILED, (), ("mean.log",)), *((f"simulate a={n}", FAILED, (), (f"{n}.log",)) for n in range(10))]
    said = lines(*failed, ("simulate a=x", DONE, ("x.nc",)), total=18, wanted=RULES, seconds=5.0)
    assert said[:3] == [
        "study paper: stopped after 5 s: 11 jobs failed, 6 jobs did not run",
        "failed: mean: x.nc: is empty (log mean.log)",
        f"failed: simulate a=0: {SILENT} (log 0.log)",
    ]
    assert said[-3:] == ["failed: and 1 more", "made: x.nc", "the same command goes on where this run stopped"]
    assert len(said) == 14


def test_a_run_that_was_interrupted(summary):
    """A job of which the log tells no end did not run to its end, even if its file is there."""
    Path("x.nc").touch()
    said = lines(("x", "running", ("x.nc",)))
    assert said[:2] == ["study paper: stopped after 1 s: 1 job did not run", "made: nothing"]


def test_a_run_that_is_stopped_when_its_last_job_was_done(summary):
    tally = Tally()
    assert closing_lines("results/paper", 3.0, tally, (), stopped=True) == [
        "study paper: stopped after 3 s: not at its end",
        "made: nothing",
        "the same command goes on where this run stopped",
    ]
