"""The progress display: counts and time left from hand-made events, its words, and that no message is lost."""

import io
import logging
import sys
from types import SimpleNamespace

import pytest
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.common import LogEvent

from burridge_knopoff.study.job_log import SILENT
from snakemake_logger_plugin_study import LogHandler
from snakemake_logger_plugin_study.outcome import say_outcome
from snakemake_logger_plugin_study.plain import Pace
from snakemake_logger_plugin_study.plan import announce, mean_duration, stages
from snakemake_logger_plugin_study.tally import Rule, Tally, TimeLeft
from snakemake_logger_plugin_study.wording import duration, progress_line, time_left


def tally(cores=2, dependents=None, **rules):
    """Return a tally of these rules; jobs are numbered in the order of the rules, from 0."""
    made = Tally()
    made.cores = cores
    names = [name for name, rule in rules.items() for _ in range(rule.total)]
    made.expect(rules, dict(enumerate(names)), dependents or {})
    return made


def test_nothing_is_said_while_no_duration_is_known():
    made = tally(simulate=Rule("points", 10))
    made.start(0, "simulate", 0.0)
    assert made.time_left(5.0) is None


def test_jobs_of_this_run_count_more_than_those_of_the_last():
    made = tally(simulate=Rule("points", 10, last=100.0))
    assert made.time_left(0.0) == TimeLeft(500.0, True)
    made.start(0, "simulate", 0.0)
    made.start(1, "simulate", 0.0)
    made.finish(0, 2.0)
    made.finish(1, 4.0)
    assert made.time_left(4.0) == TimeLeft(8 * 3.0 / 2, True)


def test_a_running_job_counts_with_what_is_left_of_it():
    made = tally(simulate=Rule("points", 2, last=10.0))
    made.start(0, "simulate", 100.0)
    made.start(1, "simulate", 104.0)
    assert made.time_left(106.0) == TimeLeft(8.0, True)
    assert made.time_left(200.0) == TimeLeft(0.0, True)


def test_rules_differ_by_a_factor_of_a_thousand():
    """The mean over all jobs would say 242 jobs of 0.9 s each, 109 s."""
    made = tally(simulate=Rule("points", 484, last=0.2), attractors_of_law=Rule("attractors", 2, last=170.0))
    for job in range(242):
        made.start(job, "simulate", 0.2 * job)
        made.finish(job, 0.2 * job + 0.2)
    assert made.time_left(100.0).seconds == pytest.approx((242 * 0.2 + 2 * 170.0) / 2)


def test_a_rule_of_unknown_duration_makes_it_a_lower_bound():
    made = tally(simulate=Rule("points", 4, last=1.0), basins=Rule("basins", 1))
    assert made.time_left(0.0) == TimeLeft(2.0, False)
    made.start(4, "basins", 0.0)
    made.finish(4, 1.0)
    assert made.time_left(1.0) == TimeLeft(2.0, True)


def test_rules_that_need_each_other_take_their_sum_on_any_number_of_cores():
    made = tally(
        cores=8,
        simulate=Rule("points", 8, last=1.0),
        attractors=Rule("attractors", 1, last=30.0),
        basins=Rule("basins", 4, needs=("attractors",), last=5.0),
        figure=Rule("figures", 1, needs=("basins", "simulate"), last=2.0),
    )
    assert made.time_left(0.0) == TimeLeft(37.0, True)


def test_threads_take_their_cores():
    made = tally(simulate=Rule("points", 4, threads=2, last=1.0))
    assert made.time_left(0.0) == TimeLeft(4.0, True)
    made = tally(simulate=Rule("points", 4, threads=16, last=1.0))
    assert made.time_left(0.0) == TimeLeft(4.0, True)


def test_jobs_of_a_group_tell_no_duration():
    made = tally(simulate=Rule("points", 4))
    made.start(0, "simulate", 0.0)
    made.finish(0, 100.0, timed=False)
    assert made.time_left(100.0) is None
    assert made.total().done == 1


def test_what_a_failed_job_blocks_is_not_waited_for():
    made = tally(
        dependents={0: [2], 1: [2], 2: [3]},
        simulate=Rule("points", 2, last=10.0),
        mean_distance=Rule("summary", 1, last=10.0),
        figure=Rule("figures", 1, last=10.0),
    )
    made.start(0, "simulate", 0.0)
    made.start(1, "simulate", 0.0)
    made.fail(0)
    assert (made.failed, made.blocked) == (1, 2)
    assert made.time_left(0.0) == TimeLeft(10.0, True)
    made.fail(1)
    assert (made.failed, made.blocked) == (2, 2)
    assert made.time_left(0.0) is None
    # Tried again, as on a cluster.
    made.start(0, "simulate", 20.0)
    made.start(1, "simulate", 20.0)
    assert (made.failed, made.blocked) == (0, 0)
    made.finish(0, 25.0)
    assert made.total().done == 1


def test_a_job_that_was_not_planned_is_added():
    made = tally()
    made.start(7, "other", 0.0)
    assert [(stage.name, stage.done, stage.total) for stage in made.stages()] == [("other", 0, 1)]
    made.finish(7, 1.0)
    made.finish(7, 1.0)
    made.finish(8, 1.0)
    assert made.total().done == 1


@pytest.mark.parametrize(
    ("seconds", "words"),
    [
        (0, "a few seconds"),
        (12, "10 s"),
        (48, "50 s"),
        (56, "1 min"),
        (170, "3 min"),
        (5300, "88 min"),
        (9000, "2.5 h"),
    ],
)
def test_durations_in_words(seconds, words):
    assert duration(seconds) == words


def test_time_left_in_words():
    assert time_left(None) == ""
    assert time_left(TimeLeft(170.0, True)) == "about 3 min left"
    assert time_left(TimeLeft(170.0, False)) == "at least 3 min left"
    assert time_left(TimeLeft(3.0, True)) == "a few seconds left"


def test_a_progress_line():
    made = tally(simulate=Rule("points", 484, last=1.0), mean_distance=Rule("summary", 46, last=1.0))
    for job in range(121):
        made.start(job, "simulate", 0.0)
    for job in range(120):
        made.finish(job, 1.0)
    assert progress_line(made, 1.0) == "points 120 of 484, all 120 of 530 (22 %), about 3 min left"
    made.fail(120)
    assert progress_line(made, 1.0) == "all 120 of 530 (22 %), 1 failed, about 3 min left"


def test_the_pace_of_plain_lines():
    pace = Pace(0.0)
    assert not pace.due(50, 100, 9.9)
    assert pace.due(50, 100, 10.0)
    assert not pace.due(54, 100, 69.9)
    assert pace.due(55, 100, 69.9)
    assert not pace.due(55, 100, 129.8)
    assert pace.due(55, 100, 129.9)


def test_durations_of_the_last_run(tmp_path):
    for name, content in {"a": "s\th:m:s\n1.5\t0:00:01\n", "b": "s\n2.5\n", "c": "s\n", "d": "s\nNA\n"}.items():
        (tmp_path / name).write_text(content)
    assert mean_duration([str(tmp_path / name) for name in "abcdef"]) == 2.0
    assert mean_duration([str(tmp_path / "c"), str(tmp_path / "f")]) is None


def test_a_stage_is_a_file_of_rules():
    def rule(name, file, *output):
        return SimpleNamespace(name=name, snakefile=f"workflow/rules/{file}.smk", output=output)

    rules = [rule("points", "simulate"), rule("simulate", "simulate", "x.nc"), rule("orbits", "stability", "y.nc")]
    assert stages(rules) == {"points": "points", "simulate": "points", "orbits": "stability"}


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
        handler = LogHandler(common_settings=SimpleNamespace(**{**SETTINGS, **settings}), settings=None)
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
ROUTINE = (
    record("Job stats:", LogEvent.RUN_INFO, stats={"simulate": 1, "total": 1}),
    record("Select jobs to execute..."),
    record("Execute 1 jobs...", LogEvent.JOB_STARTED, jobs=[1]),
    record("Rule: simulate", LogEvent.JOB_INFO, **JOB),
    record("Shell command: bk simulate", LogEvent.SHELLCMD, shellcmd="bk simulate"),
    record("Finished jobid: 1", LogEvent.JOB_FINISHED, job_id=1),
    record("None", LogEvent.PROGRESS, done=1, total=1),
)


START = record("Rule: simulate", LogEvent.JOB_INFO, **{**JOB, "wildcards": {"a": "0.0800"}})


def job_error(log):
    extra = {**JOB, "log": [log], "conda_env": None, "aux": {}, "rule_msg": None}
    return record("Error in rule simulate", LogEvent.JOB_ERROR, logging.ERROR, **extra)


ERROR = job_error("x.log")


def test_routine_is_replaced_and_all_else_is_written(written):
    assert written(*ROUTINE) == ""
    plain = (
        record("Building DAG of jobs..."),
        record("careful", level=logging.WARNING),
        record("RuleException:\nCalledProcessError in file x.smk", level=logging.ERROR),
        START,
        ERROR,
        record("the end"),
    )
    text = written(*ROUTINE, *plain)
    lines = text.splitlines()
    assert lines[:2] == ["Building DAG of jobs...", "careful"]
    assert lines[2:4] == [f"failed: simulate a=0.0800: {SILENT} (log x.log)", "the end"]


def test_an_unknown_job_that_fails_is_told_of_as_snakemake_does(written):
    assert "Error in rule simulate:" in written(ERROR).splitlines()


def test_settings_of_snakemake_hold(written):
    assert {"Job stats:", "Job 1: simulate it", "Finished jobid: 1"} <= set(
        written(*ROUTINE, printshellcmds=True).splitlines()
    )
    assert "bk simulate" in written(*ROUTINE, printshellcmds=True)
    assert "Job stats:" in written(*ROUTINE, dryrun=True)
    assert written(*ROUTINE, ERROR, quiet={Quietness.ALL}) == ""


def test_a_failed_log_is_shown(written, tmp_path):
    (tmp_path / "x.log").write_text("because\n")
    assert "because" in written(START, job_error(str(tmp_path / "x.log")), show_failed_logs=True)


def test_a_defect_of_the_display_hides_no_message(written, monkeypatch):
    monkeypatch.setattr(Tally, "fail", lambda self, job: 1 / 0)
    text = written(START, ERROR)
    assert "ZeroDivisionError" in text
    assert "failed: simulate a=0.0800: " in text


def test_a_defect_of_plan_or_outcome_is_only_told(caplog):
    announce(SimpleNamespace())
    say_outcome(SimpleNamespace(), list)
    assert [line.split(":")[0] for line in caplog.messages] == [
        "the stages of this run cannot be told",
        "what the run left cannot be told",
    ]
