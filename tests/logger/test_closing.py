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
from snakemake_logger_plugin_study.closing import closing_lines, elapsed

STATUSES = dict(enumerate(STATUS_FLAG["flag_meanings"].split()))


@pytest.fixture
def results(tmp_path):
    (tmp_path / "paper" / "summary").mkdir(parents=True)
    return tmp_path / "paper"


def write_flags(path, name, meanings, values):
    values = np.array(values, dtype="i1")
    xr.Dataset({name: ("a", values, flag("i1", meanings))}).to_netcdf(path)


def claim(name, verdict, reason="It is so."):
    return {"name": name, "verdict": verdict, "reason": reason}


def summaries(results):
    return [str(results / "summary" / name) for name in ("claims.json", "mean_distance.nc", "lyapunov.nc")]


def test_claims_that_a_study_cannot_judge_at_all(results):
    reason = "Not testable here: the paper's driver has v = 0.1, that of the study v = 0.2."
    claims = [claim(f"claim_{n}", "not testable", reason) for n in range(5)]
    path = results / "summary" / "claims.json"
    path.write_text(json.dumps({"counts": {"holds": 0, "not testable": 5}, "claims": claims}))
    lines = closing_lines(results, 1.0, success=True, made=[str(path)], wanted=[str(path)])
    assert f"claims of the paper: none is judged ({results}/summary/claims.md)" in lines
    assert f"  {reason}" in lines
    assert not any("holds" in line for line in lines)


@pytest.mark.parametrize(
    ("seconds", "words"), [(0.4, "0 s"), (59.6, "1 min 0 s"), (312, "5 min 12 s"), (7500, "2 h 5 min")]
)
def test_elapsed(seconds, words):
    assert elapsed(seconds) == words


def test_a_whole_study(results):
    claims = [claim(f"claim_{n}", "fails") for n in range(10)] + [
        claim("plus", "depends on convention"),
        claim("x", "holds"),
    ]
    counts = {"holds": 1, "holds loosely": 0, "depends on convention": 1, "fails": 10, "not testable": 0}
    (results / "summary" / "claims.json").write_text(json.dumps({"counts": counts, "claims": claims}))
    write_flags(results / "summary" / "mean_distance.nc", "status", STATUSES, [0, 3, 0, 1, 3])
    write_flags(results / "summary" / "lyapunov.nc", "kind", MotionKind, [-1, 3, 0, -1, 2])
    made = [str(results / path) for path in ("points/a.nc", "points/b.nc", "summary/claims.json", "report.html")]
    wanted = [*summaries(results), str(results / "report.html")]
    assert closing_lines(results, 312.0, success=True, made=made, wanted=wanted) == [
        "study paper: done in 5 min 12 s",
        f"files made in {results}: points 2, summary 1, report.html",
        "claims of the paper: holds 1, holds loosely 0, depends on convention 1, fails 10, not testable 0 "
        f"({results}/summary/claims.md)",
        "  fails: claim_0, claim_1, claim_2, claim_3, claim_4, claim_5, claim_6, claim_7 and 2 more",
        "  depends on convention: plus",
        f"points: 3 of 5 did not complete: diverged 2, step_limit 1 (status in {results}/summary/mean_distance.nc)",
        f"points: kind of motion undetermined at 2 of 5 (kind in {results}/summary/lyapunov.nc)",
        f"report: {results}/report.html",
    ]


def test_all_points_completed(results):
    write_flags(results / "summary" / "mean_distance.nc", "status", STATUSES, [0, 0])
    write_flags(results / "summary" / "lyapunov.nc", "kind", MotionKind, [3, 2])
    lines = closing_lines(results, 1.0, success=True, made=[], wanted=summaries(results)[1:])
    assert lines == ["study paper: done in 1 s", "made: nothing", "points: all 2 completed"]


def test_a_single_point_says_nothing_of_summaries(results):
    write_flags(results / "summary" / "mean_distance.nc", "status", STATUSES, [0, 3])
    point = str(results / "points" / "a.nc")
    lines = closing_lines(results, 1.0, success=True, made=[point], wanted=[point])
    assert lines == ["study paper: done in 1 s", f"made: {point}"]


@pytest.mark.parametrize("content", [b"", b"{", b'{"counts": 3}', b'{"counts": {}}', b"[]", b"\xff\xfe"])
def test_a_damaged_summary_gives_a_line_and_no_error(results, content):
    for path in summaries(results):
        with open(path, "wb") as file:
            file.write(content)
    lines = closing_lines(results, 1.0, success=True, made=[], wanted=summaries(results))
    assert len(lines) == 5
    assert all(f"{path}: cannot be read" in line for path, line in zip(summaries(results), lines[2:], strict=True))


def test_a_run_that_failed(results, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    Path("logs").mkdir()
    error = "Traceback (most recent call last):\n  raise\nburridge_knopoff.provenance.seal.BadFile: x.nc: is empty\n\n"
    Path("logs/mean_distance.log").write_text(error)
    failed = [
        ("mean_distance", ["logs/mean_distance.log"]),
        *((f"simulate a={n}", [f"logs/{n}.log"]) for n in range(10)),
    ]
    lines = closing_lines(
        results, 5.0, success=False, made=["x.nc"], wanted=summaries(results), failed=failed, missed=6
    )
    assert lines[:3] == [
        "study paper: stopped after 5 s: 11 jobs failed, 6 jobs did not run",
        "failed: mean_distance: x.nc: is empty (log logs/mean_distance.log)",
        f"failed: simulate a=0: {SILENT} (log logs/0.log)",
    ]
    assert lines[-3:] == ["failed: and 1 more", "made: x.nc", "the same command goes on where this run stopped"]
    assert len(lines) == 14


def test_a_run_that_was_interrupted(results):
    lines = closing_lines(results, 5.0, success=False, missed=1)
    assert lines[0] == "study paper: stopped after 5 s: 1 job did not run"
