"""The display of a run: its text, and what it does with the messages of Snakemake."""

import io
import re
import sys
from inspect import signature
from logging import ERROR, INFO, WARNING, makeLogRecord
from types import SimpleNamespace

import pytest
from snakemake.logging import DefaultFilter, DefaultFormatter
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

import snakemake_logger_plugin_study as plugin
from burridge_knopoff.study.job_log import INTERRUPTED
from burridge_knopoff.study.load import load_study
from snakemake_logger_plugin_study.display import (
    dry_run_lines,
    first_line,
    format_elapsed,
    format_estimate,
    progress_line,
)
from snakemake_logger_plugin_study.plan import Plan
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, WAITING, Job, Run

SMALL = load_study({"study": "x", "a": [0.05], "initial": {"minus": {}}}, "x.yaml")


def test_durations_in_words():
    told = {0: "a few seconds", 12: "about 10 s", 48: "about 50 s", 56: "about 1 min", 170: "about 3 min"}
    told |= {5300: "about 88 min", 9000: "about 2.5 h"}
    assert {seconds: format_estimate(seconds) for seconds in told} == told
    told = {0.4: "0 s", 59.6: "1 min 0 s", 312: "5 min 12 s", 7500: "2 h 5 min"}
    assert {seconds: format_elapsed(seconds) for seconds in told} == told


def test_a_cost_in_words(monkeypatch):
    rows = {"short": [[0.0, 3.0, 5e5]], "long": [[0.0, 203.0, 40.6e6]], "huge": [[0.0, 3.0, 2.5e9]]}
    monkeypatch.setattr("snakemake_logger_plugin_study.durations.SHIPPED", rows)
    jobs = {number: Job("", "points", "short") for number in range(10)}
    jobs[10] = Job("", "attractors", "long", threads=2)
    assert dry_run_lines(Run("", jobs, cores=2, capacity="on 2 cores")) == [
        "stage         jobs  CPU time",
        "points          10  about 30 s",
        "attractors       1  about 3 min",
        "all             11  about 4 min",
        "a run takes about 2 min on 2 cores and 46 MB of disk space (snakemake -n -p lists the jobs)",
    ]
    told = "a run takes a few seconds on 1 core and 2.5 GB of disk space (snakemake -n -p lists the jobs)"
    assert dry_run_lines(Run("", {0: Job("", "", "huge")}))[-1] == told


def test_a_line_at_the_begin_and_now_and_then(monkeypatch):
    monkeypatch.setattr(Run, "time_left", lambda self, now: 180.0)
    points = [Job("", "points", state=DONE if number < 120 else WAITING) for number in range(484)]
    jobs = [*points, *(Job("", "summary", needs=frozenset({120})) for _ in range(46))]
    run = Run("", dict(enumerate(jobs)))
    assert first_line(run, 1.0) == "530 jobs: points 484, summary 46; about 3 min on 1 core"
    points[120].state, points[120].begin = RUNNING, 1.0
    assert progress_line(run, 1.0) == "points 120 of 484, all 120 of 530 jobs; 22 % done, about 3 min left"
    points[120].state = FAILED
    told = "all 120 of 530 jobs; 22 % done, 1 failed, 46 cannot run, about 3 min left"
    assert progress_line(run, 1.0) == told


def test_a_defect_of_the_plan_is_only_told(caplog):
    plan = Plan(SMALL, "results/x", SimpleNamespace())
    plan.announce()
    assert plan.run == Run()
    assert caplog.messages[0].startswith("the stages and the duration of this run cannot be determined: ")


FLAGS = ("printshellcmds", "debug_dag", "verbose", "show_failed_logs", "stdout", "dryrun")
SETTINGS = {**dict.fromkeys(FLAGS, False), "nocolor": True, "quiet": {Quietness.HOST}}


@pytest.fixture
def written(monkeypatch, tmp_path):
    """Return a function: records given to a handler with these settings -> the lines that it wrote; no terminal.

    planned : number of jobs of the run that the Snakefile announces
    """
    monkeypatch.chdir(tmp_path)
    (tmp_path / "x.log").write_text("because\n")

    def write(*records, planned=2, study=SMALL, recording=lambda: None, **settings):
        stream, settings = io.StringIO(), {**SETTINGS, **settings}
        monkeypatch.setattr(sys, "stderr", stream)
        monkeypatch.setattr(sys, "argv", ["snakemake"])
        of_run = {number: Job("simulate a=0.0800", "points", "simulate") for number in range(1, planned + 1)}
        handler = plugin.LogHandler(common_settings=SimpleNamespace(**settings), settings=None)
        if study:
            run = Run("results/x", of_run, ["report"])
            handler.set_plan(Plan(study, "results/x", SimpleNamespace(), record=recording, run=run))
        # As Snakemake does it.
        handler.addFilter(DefaultFilter(**{name: settings[name] for name in signature(DefaultFilter).parameters}))
        handler.setFormatter(DefaultFormatter(settings["quiet"], settings["show_failed_logs"]))
        for record in records:
            handler.handle(record)
        # Snakemake may do so more than once.
        handler.close()
        handler.close()
        return stream.getvalue().splitlines()

    return write


def record(message, event=None, level=INFO, **extra):
    return makeLogRecord({"msg": message, "levelno": level, **({"event": event} if event else {}), **extra})


JOB = {
    "rule_name": "simulate",
    "input": [],
    "output": ["results/x/points/x.nc"],
    "reason": "",
    "indent": False,
    "shellcmd": "bk",
}


def start(number):
    told = {**JOB, "jobid": number, "rule_msg": "simulate it", "log": ["x.log"]}
    return record("Rule: simulate", LogEvent.JOB_INFO, **told)


def end(number):
    return record(f"Finished jobid: {number}", LogEvent.JOB_FINISHED, job_id=number)


STARTED = record("Workflow has started!", LogEvent.WORKFLOW_STARTED, quietness=Quietness.HOST)
BEGUN = (
    record("Assuming"),
    STARTED,
    record("Using shell: /bin/bash"),
    record("Singularity containers: ignored"),
    record("Job stats:", LogEvent.RUN_INFO, stats={"simulate": 2, "all": 1, "total": 3}),
    record("Select jobs to execute..."),
    record("Execute 1 jobs...", LogEvent.JOB_STARTED, jobs=[1]),
    start(1),
    record("Touching output file x."),
)
FAILURE = record(
    "Error in rule simulate",
    LogEvent.JOB_ERROR,
    ERROR,
    **JOB,
    jobid=1,
    rule_msg=None,
    log=["x.log"],
    conda_env=None,
    aux={},
)
RAISED = record("RuleException:\nCalledProcessError in file x.smk", LogEvent.ERROR, ERROR, exception="RuleException")
STOPPED = record("WorkflowError:\nNot all jobs", LogEvent.ERROR, ERROR, exception="WorkflowError")
BEGIN = ["Assuming", "2 jobs: points 2; a few seconds on 1 core"]
TOLD = "failed: simulate a=0.0800: because (log x.log)"


def test_quiet_runs(written):
    """With --quiet progress the log does not have the ends of jobs; with --quiet all nothing is written."""
    quiet = {Quietness.PROGRESS, Quietness.HOST}
    assert written(*BEGUN, end(1), quiet=quiet) == ["Assuming"]
    assert "Error in rule simulate:" in written(*BEGUN, FAILURE, quiet=quiet)
    assert written(*BEGUN, FAILURE, quiet={Quietness.ALL}) == []


def test_a_failed_job_has_one_line_and_warnings_and_errors_are_those_of_snakemake(written):
    """Snakemake 9.22 reports each failure twice."""
    said = written(*BEGUN, RAISED, FAILURE, FAILURE, record("careful", level=WARNING), STOPPED)
    last = ["study x: stopped after 0 s: 1 job failed, 1 job did not run", TOLD, "made: nothing"]
    last.append("Finished results are kept; the same command would fail again until the cause is removed.")
    assert said == [*BEGIN, TOLD, "careful", "WorkflowError:", "Not all jobs", *last]
    shown = written(*BEGUN, FAILURE, show_failed_logs=True)
    assert {TOLD, "Error in rule simulate:", "because"} <= set(shown)


def test_a_job_that_ended_without_a_word_is_named_at_the_end(written, tmp_path):
    """Ctrl-C may have ended it, which is known when another job has logged this."""
    (tmp_path / "x.log").write_text("")
    lines = written(*BEGUN, FAILURE)
    assert [line for line in lines if line.startswith("failed")] == [lines[-3]]
    assert lines[-1] == "Run the same command again to continue."
    other = makeLogRecord({**vars(FAILURE), "jobid": 2, "log": ["y.log"]})
    for last in ("Traceback (most recent call last):\n  File\nKeyboardInterrupt\n", f"bk simulate: {INTERRUPTED}\n"):
        (tmp_path / "y.log").write_text(last)
        lines = written(*BEGUN, FAILURE, start(2), other)
        assert lines[len(BEGIN) :][:2] == ["study x: stopped after 0 s: 2 jobs interrupted", "made: nothing"]


@pytest.mark.parametrize("options", [{"planned": 0}, {"study": None}, {"printshellcmds": True}])
def test_what_snakemake_says_is_there_without_a_plan_or_with_an_option(written, options):
    said = written(*BEGUN, end(1), FAILURE, **options)
    assert {"Job 1: simulate it", "Finished jobid: 1", "Error in rule simulate:"} <= set(said)


@pytest.mark.parametrize("dryrun", [False, True])
def test_a_run_with_nothing_to_do_is_recorded_too(written, dryrun):
    """No hook of the Snakefile runs then, and `bk check` goes by the config of the last run."""
    recorded = []
    said = written(STARTED, dryrun=dryrun, recording=lambda: recorded.append(True))
    assert said == ["Nothing to be done (all requested files are present and up to date)."]
    assert bool(recorded) is not dryrun
    assert written(STARTED, STOPPED, recording=lambda: 1 / 0) == ["WorkflowError:", "Not all jobs"]


def test_a_cluster_has_jobs_and_no_cores(written):
    for nodes, told in ((100, "with 100 jobs at a time"), (sys.maxsize, "on 1 core")):
        resources = record("Provided", LogEvent.RESOURCES_INFO, nodes=nodes, cores=None)
        assert re.search(f"^2 jobs: .*; a few seconds {told}$", "\n".join(written(resources, *BEGUN)), re.MULTILINE)


def test_a_defect_of_the_display_hides_no_message(written, monkeypatch):
    monkeypatch.setattr(plugin, "failure_line", lambda *arguments: 1 / 0)
    warning = record("careful", level=WARNING)
    assert {"ZeroDivisionError: division by zero", "careful"} <= set(written(*BEGUN, FAILURE, warning))
