"""The progress display: its text, the plan that the Snakefile gives it, and that no message is lost."""

import io
import os
import re
import sys
import time
from inspect import getsource, signature
from logging import ERROR, INFO, WARNING, makeLogRecord
from types import SimpleNamespace

import pytest
from snakemake.logging import DefaultFilter, DefaultFormatter
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

import snakemake_logger_plugin_study as plugin
from burridge_knopoff.study.job_log import SILENT
from burridge_knopoff.study.load import load_study
from snakemake_logger_plugin_study.display import (
    Lines,
    dry_run_lines,
    first_line,
    format_elapsed,
    format_estimate,
    progress_line,
)
from snakemake_logger_plugin_study.plan import Plan
from snakemake_logger_plugin_study.refusal import cores_of_command_line, replacement
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, WAITING, Job, Run


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
        "stage       jobs  CPU time",
        "points        10  about 30 s",
        "attractors     1  about 3 min",
        "all           11  about 4 min",
        "a run takes about 2 min on 2 cores and 46 MB of disk space (snakemake -n -p lists the jobs)",
    ]
    told = "a run takes a few seconds on 1 core and 2.5 GB of disk space (snakemake -n -p lists the jobs)"
    assert dry_run_lines(Run("", {0: Job("", "", "huge")}))[-1] == told


def test_a_line_at_the_begin_and_now_and_then(monkeypatch):
    monkeypatch.setattr(Run, "forecast", lambda self, now: 180.0)
    points = [Job("", "points", state=DONE if number < 120 else WAITING) for number in range(484)]
    jobs = [*points, *(Job("", "summary", needs=frozenset({120})) for _ in range(46))]
    run = Run("", dict(enumerate(jobs)))
    assert first_line(run, 1.0) == "530 jobs: points 484, summary 46; about 3 min on 1 core"
    points[120].state, points[120].begin = RUNNING, 1.0
    assert progress_line(run, 1.0) == "points 120 of 484, all 120 of 530 jobs; 22 % done, about 3 min left"
    points[120].state = FAILED
    told = "all 120 of 530 jobs; 22 % done, 1 failed, 46 cannot run, about 3 min left"
    assert progress_line(run, 1.0) == told


def test_the_pace_of_lines():
    run = Run("", {number: Job("", "points") for number in range(100)})
    lines = Lines(run, print)
    lines.close()
    begin, due = lines._time, []
    for done, after in ((50, 9.9), (50, 10.0), (54, 69.9), (56, 69.9), (56, 129.8), (56, 130.0), (100, 300.0)):
        for number in range(done):
            run.jobs[number].state = DONE
        due.append(lines.is_due(begin + after))
    assert due == [False, True, False, True, False, True, False]


def test_the_cores_of_a_command_line():
    expected = {"-c2": 2, "--cores 4": 4, "-j 3": 3, "--cores all": 0, "-j": 0, "-n points": 0}
    assert {line: cores_of_command_line(line.split()) for line in expected} == expected


class AJob(SimpleNamespace):
    __hash__ = object.__hash__


class Dag:
    """Three jobs: `orbits` after `simulate`, and after `edges` that is up to date; `points` makes no file."""

    def __init__(self):
        names = ("orbits", "simulate", "points", "bifurcations")
        self.rules = [SimpleNamespace(name=name, output=["x"] if name != "points" else []) for name in names]
        options = {"wildcards_dict": {}, "threads": 1, "priority": 0, "benchmark": None}
        self.jobs = [AJob(rule=rule, output=rule.output, **options) for rule in self.rules]
        orbits, simulate, points, edges = self.jobs
        simulate.wildcards_dict = {"a": "0.05"}
        self.dependencies = {orbits: [simulate, edges], simulate: [], points: [simulate]}

    def needrun_jobs(self, exclude_finished):
        assert not exclude_finished
        return iter(self.jobs[:3])

    def jobid(self, job):
        return 7 + self.jobs.index(job)


def test_what_the_snakefile_announces(tmp_path):
    """Jobs are those that make files, each with its stage, with what they need and with what they took before."""
    study = load_study({"study": "x", "a": [0.05, 0.08], "initial": {"minus": {}}}, "x.yaml")
    dag = Dag()
    rules = {"orbits": SimpleNamespace(stage="summary"), "simulate": SimpleNamespace(stage="points")}
    plan = Plan(str(tmp_path), SimpleNamespace(rules=dag.rules, dag=dag), study, rules=rules)
    plan.announce()
    assert list(plan.run.jobs.items()) == [
        (7, Job("orbits", "summary", "orbits", needs=frozenset({8}))),
        (8, Job("simulate a=0.05", "points", "simulate")),
    ]
    assert plan.run.wanted == {"simulate", "orbits", "points", "bifurcations"}
    assert plan.run.durations.last == {}
    # The second time it is known what they take.
    for number, job in enumerate(dag.jobs):
        job.benchmark = tmp_path / f"{number}.tsv"
        job.benchmark.write_text(f"s\n{number + 1}.5\n")
    plan.announce()
    assert plan.run.durations.last == {"orbits": [1.5], "simulate": [2.5], "points": [3.5], "bifurcations": [4.5]}
    assert plan.run.forecast(0.0) == 4.0


def test_a_defect_of_the_plan_is_only_told(caplog):
    plan = Plan("results/x", SimpleNamespace(rules=[SimpleNamespace(name="simulate")]), "study")
    plan.announce()
    assert plan.run == Run("results/x")
    assert caplog.messages[0].startswith("the stages and the duration of this run cannot be determined: ")


FLAGS = ("printshellcmds", "debug_dag", "verbose", "show_failed_logs", "stdout", "dryrun")
SETTINGS = {**dict.fromkeys(FLAGS, False), "nocolor": True, "quiet": None}


@pytest.fixture
def written(monkeypatch):
    """Return a function: records given to a handler with these settings -> the lines that it wrote; no terminal.

    results, wanted, planned : of the run that the Snakefile announces, and the number of its jobs
    study, cores : the study's jobs, if it has a plan, and arguments of the command line
    """

    def write(*records, results="", wanted=(), planned=2, recording=lambda: None, study=None, cores="", **settings):
        stream, settings = io.StringIO(), {**SETTINGS, **settings}
        monkeypatch.setattr(sys, "stderr", stream)
        monkeypatch.setattr(sys, "argv", ["snakemake", *cores.split()])
        of_run = {number: Job("simulate a=0.0800", "points", "simulate") for number in range(1, planned + 1)}
        plan = Plan(study=study, run=Run(results, of_run, wanted), record=recording)
        monkeypatch.setattr(plugin, "PLAN", plan)
        handler = plugin.LogHandler(common_settings=SimpleNamespace(**settings), settings=None)
        # As Snakemake does it.
        handler.addFilter(DefaultFilter(**{name: settings[name] for name in signature(DefaultFilter).parameters}))
        handler.setFormatter(DefaultFormatter(settings["quiet"], settings["show_failed_logs"]))
        for record in records:
            handler.handle(record)
        handler.close()
        return stream.getvalue().splitlines()

    return write


def record(message, event=None, level=INFO, **extra):
    return makeLogRecord({"msg": message, "levelno": level, **({"event": event} if event else {}), **extra})


JOB = {"rule_name": "simulate", "input": [], "output": ["x.nc"], "reason": "", "indent": False, "shellcmd": "bk"}


def start(number):
    told = {**JOB, "jobid": number, "rule_msg": "simulate it", "log": ["x.log"]}
    return record("Rule: simulate", LogEvent.JOB_INFO, **told)


def end(number):
    return record(f"Finished jobid: {number}", LogEvent.JOB_FINISHED, job_id=number)


def error(log):
    extra = {**JOB, "jobid": 1, "rule_msg": None, "log": [log], "conda_env": None, "aux": {}}
    return record("Error in rule simulate", LogEvent.JOB_ERROR, ERROR, **extra)


BEGUN = (
    record("Job stats:", LogEvent.RUN_INFO, stats={"simulate": 2, "all": 1, "total": 3}),
    record("Select jobs to execute..."),
    record("Execute 1 jobs...", LogEvent.JOB_STARTED, jobs=[1]),
    start(1),
    record("Shell command: bk simulate", LogEvent.SHELLCMD, shellcmd="bk simulate"),
)
ROUTINE = (*BEGUN, end(1), record("None", LogEvent.PROGRESS, done=1, total=1))
FAILURE = error("x.log")
BEGIN = "2 jobs: points 2; a few seconds on 1 core"
TOLD = f"failed: simulate a=0.0800: {SILENT} (log x.log)"


def test_a_job_that_ctrl_c_ends_before_it_has_begun_is_interrupted(written, tmp_path):
    """Its log is empty, and Snakemake may report its failure before it reports Ctrl-C."""
    end = record("Terminating processes on user request, this might take some time.")
    for last in ((FAILURE, end), (end, FAILURE)):
        lines = written(*BEGUN, *last, results="results/x")
        assert not [line for line in lines if line.startswith("failed")]
        assert any("1 job interrupted" in line for line in lines)
    assert TOLD in written(*BEGUN, FAILURE, results="results/x")


@pytest.mark.parametrize("dryrun", [False, True])
def test_a_run_with_nothing_to_do_is_recorded_too(written, dryrun):
    """No hook of the Snakefile runs then, and `bk prune` goes by the config of the last run."""
    recorded = []
    nothing = record("Nothing to be done (all requested files are present and up to date).")
    written(nothing, dryrun=dryrun, recording=lambda: recorded.append(True))
    assert bool(recorded) is not dryrun


def test_a_clock_that_jumps_back_makes_no_run_shorter_than_nothing(written, monkeypatch):
    monkeypatch.setattr(time, "time", lambda: 1.0)
    (line,) = [line for line in written(*BEGUN, FAILURE, results="results/x") if "stopped after" in line]
    assert re.search(r"stopped after \d+ s:", line)


def test_routine_is_replaced_and_all_else_is_written(written):
    assert written(*ROUTINE) == [BEGIN]
    plain = (record("Building DAG of jobs..."), record("careful", level=WARNING))
    hidden = record("RuleException:\nCalledProcessError in file x.smk", level=ERROR)
    said = written(*ROUTINE, *plain, hidden, start(1), FAILURE, record("the end"))
    assert said == [BEGIN, "Building DAG of jobs...", "careful", TOLD, "the end"]
    # Snakemake 9.22 reports a failure twice; a repeated job may fail again.
    again = "failed: simulate a=0.0800: again, for the same reason (log x.log)"
    assert written(*BEGUN, FAILURE, FAILURE, start(1), FAILURE) == [BEGIN, TOLD, again]


def test_an_announced_run_is_told_from_its_begin_to_its_end(written, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    run = {"results": "results/x", "wanted": ["report"]}
    assert written(*BEGUN[:2], record("the end"), **run) == ["the end"]
    last = ["study x: stopped after 0 s: 1 job failed, 1 job did not run", TOLD]
    last += ["made: nothing", "Run the same command again to continue."]
    assert written(*BEGUN, FAILURE, **run) == [BEGIN, TOLD, *last]
    (tmp_path / "x.nc").touch()
    last = ["study x: done in 0 s on 1 core", "made: x.nc, x.nc", "report: results/x/report.html"]
    assert written(*ROUTINE, start(2), end(2), **run) == [BEGIN, *last]
    # With --quiet progress the log does not contain the ends of jobs; with --quiet all nothing is written.
    assert written(*BEGUN, start(2), quiet={Quietness.PROGRESS}, **run) == [BEGIN, *last]
    assert written(*BEGUN, start(2), quiet={Quietness.ALL}, **run) == []
    monkeypatch.setattr(plugin, "closing_lines", lambda *arguments, **options: 1 / 0)
    assert "the results of the run cannot be determined: division by zero" in written(*ROUTINE, **run)


def test_without_a_plan_snakemake_tells(written):
    said = written(*ROUTINE, start(1), FAILURE, planned=0, results="results/x")
    assert {"Job 1: simulate it", "Finished jobid: 1", "Error in rule simulate:"} <= set(said)
    assert "study x: stopped after 0 s: 1 job failed" in said
    # As of a job that is not known.
    assert "Error in rule simulate:" in written(FAILURE)


def test_a_dry_run_ends_with_its_stages_and_lists_jobs_on_request(written, monkeypatch):
    monkeypatch.setattr(Plan, "look_ahead", lambda self: self.run)
    messages = (record("Reasons:\n    (check)"), record("This was a dry-run (flag -n). The order of jobs does not"))
    plan = (BEGUN[0], start(1), start(2), BEGUN[0], *messages)
    table = written(*plan, dryrun=True, study="study", cores="-c3")
    assert [line.split()[:2] for line in table[:3]] == [["stage", "jobs"], ["points", "2"], ["all", "2"]]
    assert re.fullmatch("a run takes .* on 3 cores and .* of disk space .*", table[3])
    assert len(table) == 4
    listed = written(*plan, dryrun=True, study="study", cores="-c3", printshellcmds=True)
    assert listed[-4:] == table
    assert {"Job stats:", "Job 1: simulate it", "Reasons:"} <= set(listed)


def test_a_cluster_has_jobs_and_no_cores(written):
    resources = record("Provided", LogEvent.RESOURCES_INFO, nodes=100, cores=None)
    assert written(resources, *BEGUN)[0] == "2 jobs: points 2; a few seconds with 100 jobs at a time"
    unlimited = record("Provided", LogEvent.RESOURCES_INFO, nodes=sys.maxsize)
    assert written(unlimited, *BEGUN)[0] == BEGIN


def test_a_reader_that_goes_ends_no_run(monkeypatch):
    """As in `snakemake -n | head`."""
    read, write = os.pipe()
    os.close(read)
    with os.fdopen(write, "w", buffering=1) as stream:
        monkeypatch.setattr(sys, "stderr", stream)
        handler = plugin.LogHandler(common_settings=SimpleNamespace(**SETTINGS), settings=None)
        for _ in range(3):
            handler.handle(record("a line"))
        handler.close()


def test_settings_of_snakemake_hold(written, tmp_path):
    said = written(*ROUTINE, printshellcmds=True)
    routine = {"Job stats:", "Select jobs to execute...", "Job 1: simulate it", "Finished jobid: 1"}
    assert {*routine, "Shell command: bk simulate"} <= set(said)
    assert "Job stats:" in written(*ROUTINE, dryrun=True)
    assert written(*ROUTINE, FAILURE, quiet={Quietness.ALL}) == []
    (tmp_path / "x.log").write_text("because\n")
    assert "because" in written(*BEGUN, error(str(tmp_path / "x.log")), show_failed_logs=True)


def test_a_defect_of_the_display_hides_no_message(written, monkeypatch):
    take = plugin.LogHandler._update
    monkeypatch.setattr(plugin.LogHandler, "_update", lambda self, got: 1 / 0 if got is FAILURE else take(self, got))
    assert {"ZeroDivisionError: division by zero", TOLD} <= set(written(*BEGUN, FAILURE))


def test_snakemake_has_the_messages_that_are_replaced():
    """Its own words: here it shows that a version has changed them."""
    from snakemake import exceptions
    from snakemake.api import Workflow
    from snakemake.scheduling import job_scheduler

    assert replacement("Select jobs to execute...") == ""
    assert '"Select jobs to execute..."' in getsource(job_scheduler)
    assert replacement("Elapsed time: 0:07:00.875591") == ""
    for what in ("missing", "outdated"):
        unrecorded = f"3 jobs have {what} provenance/metadata so that it in part cannot be used to trigger re-runs."
        assert replacement(unrecorded).startswith("3 jobs: .snakemake has no record of ")
    assert "Elapsed time: " in getsource(Workflow)
    missing = exceptions.MissingRuleException("x.nc")
    assert replacement(exceptions.format_exception_to_string(missing)) == "x.nc: unknown target"
    assert '"Target rules may not contain wildcards. "' in getsource(sys.modules["snakemake.dag"])


def test_a_report_before_a_run_is_refused_in_a_line(tmp_path):
    """Snakemake has a warning for each file; that of a file that is there stays."""
    from snakemake import report

    file = tmp_path / "x.nc"
    warning = f"Missing metadata for file {file}. Maybe metadata was deleted or it was created"
    assert replacement(warning) == ""
    file.touch()
    assert replacement(warning) is None
    said = replacement("WorkflowError:\nFile x.png marked for report but does not exist.")
    assert said == "--report: x.png is missing: run the study first, by the same command without --report"
    source = getsource(report)
    assert "Missing metadata for file {}. Maybe metadata " in source
    assert "File {} marked for report but does not exist." in source
