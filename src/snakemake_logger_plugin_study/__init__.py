"""Progress of a study for people: `snakemake --logger study`, set in workflow/profiles/default.

A display while it runs and, at its end, what it left. All else goes through Snakemake's own handler, filter and format.
"""

from __future__ import annotations

import os
import sys
import time
from contextlib import suppress
from logging import INFO, LogRecord, makeLogRecord
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from burridge_knopoff.study.job_log import failure_line, is_interrupted
from burridge_knopoff.study.yaml_file import ConfigError
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.display import Lines, Picture, beginning, cost, first_figures
from snakemake_logger_plugin_study.durations import measured
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import (
    checked_cores,
    is_end_by_hand,
    provide_cache,
    reworded,
    says_nothing_to_do,
)
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Run

#: Events that the display replaces; -p and --verbose bring them back.
_ROUTINE = (
    *(LogEvent.RUN_INFO, LogEvent.RESOURCES_INFO, LogEvent.PROGRESS, LogEvent.SHELLCMD),
    *(LogEvent.JOB_INFO, LogEvent.JOB_STARTED, LogEvent.JOB_FINISHED, LogEvent.GROUP_INFO),
)


class LogHandler(LogHandlerBase):
    """Counts what the log tells of jobs, shows it, and hands the rest to Snakemake's own handler."""

    writes_to_stream = True
    # Snakemake gives its own filter and formatter, as it does to its own handler.
    writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def __post_init__(self) -> None:
        try:
            self._given_cores = checked_cores(sys.argv[1:])
        except ConfigError as error:
            sys.exit(str(error))
        provide_cache()
        from snakemake.logging import ColorizingTextHandler, is_quiet_about

        settings = self.common_settings
        self._text = ColorizingTextHandler(settings.nocolor, sys.stdout if settings.stdout else sys.stderr)
        # Also what is not to be shown counts.
        self.addFilter, self.setFormatter = self._text.addFilter, self._text.setFormatter  # type: ignore[method-assign]
        self._everything = settings.dryrun or settings.verbose or settings.printshellcmds or settings.debug_dag
        self._quiet = is_quiet_about(settings.quiet or set(), "progress")
        self._begin, self._cores, self._run = time.monotonic(), 1, Run()
        #: Whether there is something to do, also in a dry run, and whether Snakemake ended with an error.
        self._begun = self._stopped = False
        self._display: Lines | Picture | None = None
        #: Jobs that left no word, with their logs: of Ctrl-C jobs may tell before Snakemake does.
        self._wordless: list[tuple[str, list[str]]] = []

    def emit(self, record: LogRecord) -> None:
        """Take a record of Snakemake's log."""
        words = self._instead(record)
        try:
            self._take(record)
        except Exception:
            # A defect of the display must neither end the thread of the log nor hide a message.
            self.handleError(record)
        if getattr(record, "event", None) not in (LogEvent.JOB_ERROR, LogEvent.ERROR):
            self._tell_wordless()
        self._say(words, record)

    def _tell_wordless(self) -> None:
        """Tell of the jobs that left no word as failed, unless it was Ctrl-C that ended them."""
        for job, logs in [] if self._run.stopping else self._wordless:
            self._say(failure_line(job, logs))
        self._wordless.clear()

    def _instead(self, record: Any) -> str | None:
        """Return what is said instead of a record, "" for nothing; None if it is said as it is."""
        event = getattr(record, "event", None)
        if event == LogEvent.JOB_ERROR and (job := self._run.jobs.get(record.jobid)):
            # Snakemake's own block lists all input, which may be 10,000 files; version 9.22 tells of a failure twice.
            whole = self._everything or self.common_settings.show_failed_logs
            logs = record.log or []
            if job.state == FAILED or (not whole and is_interrupted(logs)):
                return ""
            if not whole and is_interrupted(logs, stopping=True):
                self._wordless.append((job.name, logs))
                return ""
            return None if whole else failure_line(job.name, logs)
        words = "" if event in _ROUTINE else reworded(record.getMessage()) if event in (None, LogEvent.ERROR) else None
        return None if words == "" and self._everything else words

    def _take(self, record: Any) -> None:
        match getattr(record, "event", None):
            case LogEvent.RESOURCES_INFO:
                # `nodes` with jobs on a cluster; without a limit it is a number too large to tell anything.
                if (cores := record.__dict__.get("cores") or record.__dict__.get("nodes", 0)) and cores < sys.maxsize:
                    self._cores = cores
            case LogEvent.RUN_INFO:
                self._begun = self._begun or self.common_settings.dryrun
            case LogEvent.JOB_STARTED if not self._begun:
                self._expect()
            case LogEvent.JOB_INFO if record.output:
                job = self._run.job(record.jobid, record.rule_name)
                job.begin, job.message = time.monotonic(), record.rule_msg or ""
                job.output, job.log = record.output, record.log or []
                job.state = RUNNING
            case LogEvent.JOB_FINISHED if done := self._run.jobs.get(record.job_id):
                done.seconds, done.state = measured(done.benchmark, done.threads), DONE
                if done.name in PLAN.first and (words := first_figures(self._run, PLAN.first)):
                    self._say(words)
            case LogEvent.JOB_ERROR if failed := self._run.jobs.get(record.jobid):
                failed.state = FAILED
            case LogEvent.ERROR:
                self._stopped = True
        if says_nothing_to_do(record.getMessage()) and not self.common_settings.dryrun:
            # No hook of the Snakefile runs then; `bk check` and `bk prune` would go by the config of an older run.
            with suppress(OSError):
                PLAN.record()
        self._run.stopping = self._run.stopping or is_end_by_hand(record.getMessage())

    def _expect(self) -> None:
        """Begin to show a run, whose first jobs start."""
        self._begun = True
        run = self._run = PLAN.run
        run.cores = self._cores
        if not run.jobs:
            # Without a plan, as without hooks, Snakemake's own messages are all there is.
            self._everything = True
            return
        self._say(beginning(run, time.monotonic()))
        if self._quiet:
            return
        self._display = Picture(run, self._text) if self._text.can_color_tty() else Lines(run, self._say)

    def _say(self, words: str | None, record: LogRecord | None = None) -> None:
        """Write a line, at the level of a record, or the record itself if there are no words."""
        if words is not None:
            kept = record.__dict__ if record else {"levelno": INFO, "levelname": "INFO"}
            record = makeLogRecord({**kept, "event": None, "msg": words, "args": None})
        try:
            self._text.handle(record)
        except BrokenPipeError:
            # Whoever read has gone, as `head` does: the run goes on, and what follows goes nowhere.
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._text.stream.fileno())
            os.close(nowhere)

    def close(self) -> None:
        """Take the display away and say what the run left; Snakemake calls this at the end, also after Ctrl-C."""
        if self._display:
            self._display.close()
        self._tell_wordless()
        for line in self._last_words() if self._begun else ():
            self._say(line)
        # Snakemake may close its handlers more than once.
        self._begun, self._display = False, None
        super().close()

    def _last_words(self) -> list[str]:
        run = self._run
        try:
            if self.common_settings.dryrun:
                run = Run() if self._stopped else PLAN.look_ahead()
                run.cores = self._given_cores or os.cpu_count() or 1
                return [cost(run)] if run.jobs else []
            if not (run.results and run.jobs):
                return []
            # `--quiet progress` keeps from the log which jobs were done, but their files are there.
            for job in run.of(RUNNING) if self._quiet else ():
                job.state = DONE if all(Path(path).exists() for path in job.output) else RUNNING
            return closing_lines(run, time.monotonic() - self._begin, stopped=self._stopped)
        except Exception as error:
            what = "the time of a run" if self.common_settings.dryrun else "what the run left"
            return [f"{what} cannot be told: {error}"]
