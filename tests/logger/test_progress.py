"""The progress display: counts and time left from hand-made events, its words, and that no message is lost."""

import io
import logging
import os
import sys
from inspect import getsource, signature
from types import SimpleNamespace

import pytest
from snakemake.logging import DefaultFilter, DefaultFormatter
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

import snakemake_logger_plugin_study as plugin
from burridge_knopoff.study import load_study
from burridge_knopoff.study.job_log import SILENT
from snakemake_logger_plugin_study.durations import shipped
from snakemake_logger_plugin_study.forecast import Cost, PlannedJob
from snakemake_logger_plugin_study.past import write_past
from snakemake_logger_plugin_study.plain import PlainDisplay
from snakemake_logger_plugin_study.plan import Plan
from snakemake_logger_plugin_study.refusal import reworded
from snakemake_logger_plugin_study.tally import DONE, FAILED, Job, Rule, Tally
from snakemake_logger_plugin_study.wording import cost, duration, progress_line, time_left


def tally(*done, cores=2, running=(), failed=(), **rules):
    """Return a tally of these rules after (rule, begin, end) were done, (rule, begin) run, and these rules failed."""
    made = Tally(rules, cores)
    begun = [*((*job, DONE) for job in done), *((*job, 0.0, "running") for job in running)]
    begun += [(rule, 0.0, 0.0, FAILED) for rule in failed]
    for number, (rule, begin, end, state) in enumerate(begun):
        made.start(number, rule, Job(rule, begin))
        made.end(number, state, end)
    return made


def needing(stage, total, *needs):
    return Rule(stage, total, frozenset(needs))


def test_the_time_left_is_told_from_the_state_of_all_jobs():
    made = tally(("simulate", 0.0, 2.0), running=[("simulate", 2.0)], simulate=Rule("points", 3))
    assert made.time_left(3.0) is None
    asked = []
    made.forecast = SimpleNamespace(time_left=lambda *state: asked.append(state) or 30.0)
    made.start(2, "simulate", Job("simulate", 2.5, timed=False))
    made.end(2, DONE, 2.6)
    assert made.time_left(3.0) == 30.0
    assert asked == [(3.0, 2, {1: 2.0}, {0: 2.0, 2: float("inf")}, [])]
    # It is counted down until it is worked out again.
    assert made.time_left(3.5) == 29.5
    made.end(1, FAILED)
    assert made.time_left(5.5) == 30.0
    assert asked[1:] == [(5.5, 2, {}, {0: 2.0, 2: float("inf")}, [1])]


def test_what_a_failed_job_blocks_is_not_waited_for():
    rules = {
        "simulate": Rule("points", 2),
        "mean_distance": needing("summary", 1, "simulate"),
        "figure": needing("figures", 1, "mean_distance"),
        "orbits": Rule("orbits", 1),
    }
    made = tally(failed=["simulate"], running=[("simulate", 0.0)], **rules)
    assert made.blocked() == {"mean_distance": 1, "figure": 1}
    made.end(0, FAILED)
    assert len(made.jobs(FAILED)) == 2
    # Tried again, as on a cluster; and a job that needed none of the failed ones.
    for number in (0, 1):
        made.start(number, "simulate", Job("simulate", 20.0))
    assert (made.jobs(FAILED), made.blocked()) == ([], {})
    made.end(0, FAILED)
    made.start(2, "mean_distance", Job("mean_distance", 20.0))
    assert made.blocked() == {"mean_distance": 0, "figure": 1}


def test_a_job_that_was_not_planned_is_added():
    made = tally()
    made.start(7, "other", Job("other", 0.0))
    assert made.counts() == [("other", 0, 1, 1), ("all", 0, 1, 1)]
    for number in (7, 7, 8):
        made.end(number, DONE, 1.0)
    assert made.counts()[-1] == ("all", 1, 1, 0)


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        *((0, "a few seconds"), (12, "10 s"), (48, "50 s"), (56, "1 min"), (170, "3 min")),
        *((5300, "88 min"), (9000, "2.5 h")),
    ],
)
def test_durations_in_words(seconds, words):
    assert duration(seconds) == words


def test_time_left_in_words():
    assert [time_left(seconds) for seconds in (None, 170.0, 3.0)] == ["", "about 3 min left", "a few seconds left"]


def test_a_cost_in_words():
    told = "a run takes about 3 min on 2 cores: about 5 min of CPU time, and 41 MB of disk"
    assert cost(Cost(170.0, 300.0, 4.1e7), 2) == told
    assert (
        cost(Cost(3.0, 3.0, 2.5e9), 1)
        == "a run takes a few seconds on 1 core: a few seconds of CPU time, and 2.5 GB of disk"
    )


def test_a_progress_line():
    rules = {"simulate": Rule("points", 484), "mean_distance": needing("summary", 46, "simulate")}
    done = [("simulate", 0.0, 1.0)] * 120
    made = tally(*done, running=[("simulate", 0.0)], **rules)
    assert progress_line(made, 1.0) == "points 120 of 484, all 120 of 530 (22 %)"
    made = tally(*done, failed=["simulate"], **rules)
    made.forecast = SimpleNamespace(time_left=lambda *state: 180.0)
    assert progress_line(made, 1.0) == "all 120 of 530 (22 %), 1 failed, 46 cannot run, about 3 min left"


def test_the_pace_of_plain_lines():
    made = tally(simulate=Rule("points", 100))
    display = PlainDisplay(made, SimpleNamespace(__enter__=None), print)
    display.close()
    begin = display._time
    due = []
    for done, after in ((50, 9.9), (50, 10.0), (54, 69.9), (55, 69.9), (55, 129.8), (55, 129.9), (100, 300.0)):
        for number in range(done):
            made.start(number, "simulate", Job("x", 0.0, state=DONE))
        due.append(bool(display.line(begin + after)))
    assert due == [False, True, False, True, False, True, False]


def test_a_defect_of_the_plan_is_only_told(caplog):
    plan = Plan()
    plan.describe("results/x", SimpleNamespace(rules=[SimpleNamespace(name="simulate")]), None)
    plan.announce()
    assert (plan.results, plan.stages, plan.forecast) == ("results/x", {}, None)
    assert caplog.messages[0].startswith("the stages of this run, and its time, cannot be told: ")


STUDY = load_study({"study": "x", "a": [0.05, 0.08], "initial": {"minus": {}}}, "x.yaml")


class Dag:
    """Two jobs, the second after the first; a third that makes no file."""

    def __init__(self):
        self.made = [job("simulate", "x.nc", a="0.05"), job("orbits", "y.nc"), job("points")]
        self.dependencies = {self.made[0]: [], self.made[1]: [self.made[0]], self.made[2]: self.made[:1]}

    def needrun_jobs(self, exclude_finished):
        assert not exclude_finished
        return iter(self.made)

    def jobid(self, job):
        return 7 + self.made.index(job)


class AJob(SimpleNamespace):
    __hash__ = object.__hash__


def job(name, *output, **wildcards):
    rule = SimpleNamespace(name=name)
    return AJob(rule=rule, output=output, wildcards_dict=wildcards, params={}, threads=1, priority=0)


def test_what_the_snakefile_announces(tmp_path, monkeypatch):
    """Stages are files of rules; jobs are those that make files, with what they need."""

    def rule(name, file, *output):
        return SimpleNamespace(name=name, snakefile=f"workflow/rules/{file}.smk", output=output)

    rules = [rule("points", "simulate"), rule("simulate", "simulate", "x.nc"), rule("orbits", "stability", "y.nc")]
    monkeypatch.setattr("snakemake_logger_plugin_study.plan.calibrate", lambda: 3.0 * shipped().calibration)
    plan = Plan()
    plan.describe(str(tmp_path), SimpleNamespace(rules=[*rules, rule("all", "Snakefile")], dag=Dag()), STUDY)
    plan.announce()
    assert plan.stages == {"simulate": "points", "orbits": "stability"}
    assert plan.speed == pytest.approx(3.0)
    assert plan.forecast.jobs == {
        7: PlannedJob("simulate a=0.05", "simulate", 30000.0),
        8: PlannedJob("orbits", "orbits", 4.0, needs=frozenset({7})),
    }
    # The second time the machine is known.
    done = [(number, Job("", 1.0, state=DONE, end=3.0)) for number in (7, 8)]
    write_past(tmp_path, plan.forecast.jobs, done, cores=2, speed=3.0, begin=1.0)
    plan.speed = 1.0
    assert 2.0 < plan.look_ahead().cost(2).seconds < 5.0
    assert plan.speed == 1.0


SETTINGS = {
    **dict.fromkeys(("printshellcmds", "debug_dag", "verbose", "show_failed_logs", "stdout", "dryrun"), False),
    "nocolor": True,
    "quiet": None,
}


@pytest.fixture
def written(monkeypatch):
    """Return a function: records given to a handler with these settings -> what it wrote; no terminal."""

    def write(*records, **settings):
        stream = io.StringIO()
        monkeypatch.setattr(sys, "stderr", stream)
        settings = {**SETTINGS, **settings}
        handler = plugin.LogHandler(common_settings=SimpleNamespace(**settings), settings=None)
        # As Snakemake does it.
        handler.addFilter(DefaultFilter(**{name: settings[name] for name in signature(DefaultFilter).parameters}))
        handler.setFormatter(DefaultFormatter(settings["quiet"], settings["show_failed_logs"]))
        for record in records:
            handler.handle(record)
        handler.close()
        return stream.getvalue()

    return write


def record(message, event=None, level=logging.INFO, **extra):
    made = logging.LogRecord("snakemake", level, "", 0, message, (), None)
    made.__dict__.update({"event": event} if event else {}, **extra)
    return made


JOB = {
    **{"jobid": 1, "rule_name": "simulate", "rule_msg": "simulate it", "local": False, "input": [], "output": ["x.nc"]},
    **{"log": [], "benchmark": None, "wildcards": {}, "reason": "", "resources": {}, "priority": 0, "threads": 1},
    **{"indent": False, "is_checkpoint": False, "shellcmd": "bk simulate"},
}
GRAPH = {"nodes": [{"rule": name} for name in ("simulate", "all")]}
ROUTINE = (
    record(None, LogEvent.RULEGRAPH, rulegraph={**GRAPH, "links": [{"sourcerule": "simulate", "targetrule": "all"}]}),
    record("Job stats:", LogEvent.RUN_INFO, stats={"simulate": 2, "all": 1, "total": 3}),
    record("Select jobs to execute..."),
    record("Execute 1 jobs...", LogEvent.JOB_STARTED, jobs=[1]),
    record("Rule: simulate", LogEvent.JOB_INFO, **JOB),
    record("Shell command: bk simulate", LogEvent.SHELLCMD, shellcmd="bk simulate"),
    record("Finished jobid: 1", LogEvent.JOB_FINISHED, job_id=1),
    record("None", LogEvent.PROGRESS, done=1, total=1),
)
START = record("Rule: simulate", LogEvent.JOB_INFO, **{**JOB, "log": ["x.log"], "wildcards": {"a": "0.0800"}})


def job_error(log):
    extra = {**JOB, "log": [log], "conda_env": None, "aux": {}, "rule_msg": None}
    return record("Error in rule simulate", LogEvent.JOB_ERROR, logging.ERROR, **extra)


ERROR = job_error("x.log")
TOLD = f"failed: simulate a=0.0800: {SILENT} (log x.log)"


def test_routine_is_replaced_and_all_else_is_written(written):
    assert written(*ROUTINE) == ""
    plain = (
        record("Building DAG of jobs..."),
        record("careful", level=logging.WARNING),
        record("RuleException:\nCalledProcessError in file x.smk", level=logging.ERROR),
        *(START, ERROR, record("the end")),
    )
    assert written(*ROUTINE, *plain).splitlines() == ["Building DAG of jobs...", "careful", TOLD, "the end"]
    # Snakemake 9.22 tells of a failure twice; a job that is tried again may fail again.
    assert written(*ROUTINE, START, ERROR, ERROR, START, ERROR).splitlines() == [TOLD, TOLD]


def test_an_announced_run_is_told_from_its_begin_to_its_end(written, monkeypatch, tmp_path):
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr(plugin, "PLAN", Plan("results/x", {"other": "others", "simulate": "points"}))
    assert written(*ROUTINE[:2], record("the end")) == "the end\n"
    assert written(*ROUTINE, START, ERROR).splitlines() == [
        *("2 jobs: points 2", TOLD, "study x: stopped after 0 s: 1 job failed, 1 job did not run", TOLD),
        *("made: nothing", "the same command goes on where this run stopped"),
    ]
    (tmp_path / "x.nc").touch()
    other = record("Rule: simulate", LogEvent.JOB_INFO, **{**JOB, "jobid": 2})
    end = record("Finished jobid: 2", LogEvent.JOB_FINISHED, job_id=2)
    # `report` comes after the points and does not run: `--until`. With no rule before it that runs it is up to date.
    for link, told in (("simulate", False), ("orbits", True)):
        nodes = [{"rule": name} for name in ("simulate", "orbits", "report")]
        graph = {"nodes": nodes, "links": [{"sourcerule": link, "targetrule": "report"}]}
        said = written(record(None, LogEvent.RULEGRAPH, rulegraph=graph), *ROUTINE[1:], other, end)
        assert ("report: results/x/report.html" in said) is told
    # The end of a job is not in the log with --quiet progress, nor is anything said with --quiet all.
    for quiet, lines in ((Quietness.PROGRESS, 3), (Quietness.ALL, 0)):
        assert len(written(*ROUTINE[:5], other, quiet={quiet}).splitlines()) == lines
    monkeypatch.setattr(plugin, "closing_lines", lambda *given, **options: 1 / 0)
    assert "what the run left cannot be told: division by zero" in written(*ROUTINE)


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


def test_an_unknown_job_that_fails_is_told_of_as_snakemake_does(written):
    assert "Error in rule simulate:" in written(ERROR).splitlines()


def test_settings_of_snakemake_hold(written):
    said = written(*ROUTINE, printshellcmds=True).splitlines()
    assert {"Job stats:", "Select jobs to execute...", "Job 1: simulate it", "Finished jobid: 1"} <= set(said)
    assert "bk simulate" in written(*ROUTINE, printshellcmds=True)
    assert "Job stats:" in written(*ROUTINE, dryrun=True)
    assert written(*ROUTINE, ERROR, quiet={Quietness.ALL}) == ""


def test_a_failed_log_is_shown(written, tmp_path):
    (tmp_path / "x.log").write_text("because\n")
    assert "because" in written(START, job_error(str(tmp_path / "x.log")), show_failed_logs=True)


def test_a_defect_of_the_display_hides_no_message(written, monkeypatch):
    monkeypatch.setattr(Tally, "end", lambda *given, **options: 1 / 0)
    text = written(START, ERROR)
    assert "ZeroDivisionError" in text
    assert TOLD in text


def test_snakemake_says_what_is_reworded():
    """Its own words: here it shows that a version has changed them."""
    from snakemake import exceptions
    from snakemake.scheduling import job_scheduler

    assert reworded("Select jobs to execute...") == ""
    assert '"Select jobs to execute..."' in getsource(job_scheduler)
    missing = exceptions.MissingRuleException("x.nc")
    assert reworded(exceptions.format_exception_to_string(missing)) == "x.nc: neither a rule nor a file of this study"
