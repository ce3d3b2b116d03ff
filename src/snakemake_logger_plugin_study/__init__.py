"""Progress of a study for people: `snakemake --logger study`, set in workflow/profiles/default.

It displays a run while it lasts, and closes it with what it made. A dry run ends with a table of its stages. All other
messages go through Snakemake's own handler, filter and format.
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

from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import failure_line, failure_reason, is_interrupted
from burridge_knopoff.study.yaml_file import ConfigError
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.display import Lines, Picture, dry_run_lines, first_figures_line, first_line
from snakemake_logger_plugin_study.durations import measured_seconds
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import (
    cores_of_command_line,
    is_ctrl_c,
    is_nothing_to_do,
    is_touch,
    provide_cache,
    replacement,
)
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Run

#: Events that the display replaces; -p and --verbose show them.
_ROUTINE = (
    *(LogEvent.RUN_INFO, LogEvent.RESOURCES_INFO, LogEvent.PROGRESS, LogEvent.SHELLCMD),
    *(LogEvent.JOB_INFO, LogEvent.JOB_STARTED, LogEvent.JOB_FINISHED, LogEvent.GROUP_INFO),
)


class LogHandler(LogHandlerBase):
    """Follows the jobs in Snakemake's log, displays them, and passes all other records to Snakemake's own handler."""

    writes_to_stream = True
    # Snakemake provides its own filter and formatter, as for its own handler.
    writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def __post_init__(self) -> None:
        try:
            self._given_cores = cores_of_command_line(sys.argv[1:])
        except ConfigError as error:
            sys.exit(str(error))
        provide_cache()
        from snakemake.logging import ColorizingTextHandler, is_quiet_about

        settings = self.common_settings
        self._text = ColorizingTextHandler(settings.nocolor, sys.stdout if settings.stdout else sys.stderr)
        # Records that are filtered out count as well.
        self.addFilter, self.setFormatter = self._text.addFilter, self._text.setFormatter  # type: ignore[method-assign]
        self._shows_routine = settings.verbose or settings.printshellcmds or settings.debug_dag
        self._quiet = is_quiet_about(settings.quiet or set(), "progress")
        self._begin, self._run = time.monotonic(), Run()
        #: Whether there is something to do, also in a dry run, and whether Snakemake ended with an error.
        self._has_begun = self._has_stopped = False
        self._display: Lines | Picture | None = None
        #: Failed jobs with an empty log, and their logs: a job may fail by Ctrl-C before Snakemake reports the signal.
        self._silent_jobs: list[tuple[str, list[str]]] = []
        #: {reason of a failure that has been written: first job that failed for it}
        self._reasons: dict[str, str] = {}

    def emit(self, record: LogRecord) -> None:
        """Take a record of Snakemake's log."""
        message = self._replacement(record)
        try:
            self._update(record)
        except Exception:
            # A defect of the display must neither end the thread of the log nor hide a message.
            self.handleError(record)
        if getattr(record, "event", None) not in (LogEvent.JOB_ERROR, LogEvent.ERROR):
            self._report_silent_jobs()
        self._write(message, record)

    def _report_silent_jobs(self) -> None:
        """Report the jobs with an empty log as failed, unless Ctrl-C has ended them."""
        for job, logs in [] if self._run.stopping else self._silent_jobs:
            self._write(self._failure(job, logs))
        self._silent_jobs.clear()

    def _failure(self, job: str, logs: list[str]) -> str:
        """Return the line that reports a failed job; a reason, and its remedy, is written once."""
        reason = failure_reason(logs)
        if reason in self._reasons:
            first = self._reasons[reason]
            cause = "again, for the same reason" if first == job else f"for the same reason as {first}"
            return f"failed: {job}: {cause} (log {', '.join(map(str, logs)) or 'none'})"
        self._reasons[reason] = job
        return failure_line(job, logs)

    def _replacement(self, record: Any) -> str | None:
        """Return the text that replaces a record, empty to hide it; None to write the record itself."""
        event = getattr(record, "event", None)
        # Without a plan, as in another workflow, Snakemake's own messages are all there is.
        shows_routine = self._shows_routine or (self.common_settings.dryrun and PLAN.study is None)
        if event == LogEvent.JOB_ERROR and (job := self._run.jobs.get(record.jobid)):
            # Snakemake's own block lists all input, up to 10,000 files; version 9.22 reports each failure twice.
            is_whole = shows_routine or self.common_settings.show_failed_logs
            logs = record.log or []
            if job.state == FAILED or (not is_whole and is_interrupted(logs)):
                return ""
            if not is_whole and is_interrupted(logs, stopping=True):
                self._silent_jobs.append((job.name, logs))
                return ""
            return None if is_whole else self._failure(job.name, logs)
        if event in _ROUTINE:
            return None if shows_routine else ""
        text = replacement(record.getMessage()) if event in (None, LogEvent.ERROR) else None
        return None if text == "" and shows_routine else text

    def _update(self, record: Any) -> None:
        """Follow the jobs by a record."""
        is_dry_run = self.common_settings.dryrun
        match getattr(record, "event", None):
            case LogEvent.RESOURCES_INFO:
                # `nodes` with jobs on a cluster; without a limit it is sys.maxsize.
                if cores := record.__dict__.get("cores"):
                    self._run.cores, self._run.capacity = cores, f"on {format_count(cores, 'core')}"
                elif 0 < (nodes := record.__dict__.get("nodes") or 0) < sys.maxsize:
                    self._run.cores, self._run.capacity = nodes, f"with {format_count(nodes, 'job')} at a time"
            case LogEvent.RUN_INFO:
                self._has_begun = self._has_begun or is_dry_run
            case LogEvent.JOB_STARTED if not self._has_begun:
                self._begin_display()
            case LogEvent.JOB_INFO if record.output and not is_dry_run:
                job = self._run.job(record.jobid, record.rule_name)
                job.begin, job.since, job.message = time.monotonic(), time.time(), record.rule_msg or ""
                job.output, job.log = record.output, record.log or []
                job.state = RUNNING
            case LogEvent.JOB_FINISHED if done := self._run.jobs.get(record.job_id):
                done.seconds, done.state = measured_seconds(done.benchmark, done.threads), DONE
                if (
                    not self._run.touching
                    and done.name in PLAN.first
                    and (line := first_figures_line(self._run, PLAN.first))
                ):
                    self._write(line)
            case LogEvent.JOB_ERROR if failed := self._run.jobs.get(record.jobid):
                failed.state = FAILED
            case LogEvent.ERROR:
                self._has_stopped = True
        if is_nothing_to_do(record.getMessage()) and not is_dry_run:
            # No hook of the Snakefile runs then; `bk check` and `bk prune` would use the config of an earlier run.
            with suppress(OSError):
                PLAN.record()
        self._run.stopping = self._run.stopping or is_ctrl_c(record.getMessage())

    def _begin_display(self) -> None:
        """Begin to display a run whose first jobs start."""
        self._has_begun, self._begin = True, time.monotonic()
        cores, capacity = self._run.cores, self._run.capacity
        run = self._run = PLAN.run
        run.cores, run.capacity = cores, capacity
        if not run.jobs:
            # Without a plan, as without hooks, Snakemake's own messages are all there is.
            self._shows_routine = True
            return
        if run.touching:
            return
        self._write(first_line(run, self._begin))
        if self._quiet:
            return
        self._display = Picture(run, self._text) if self._text.can_color_tty() else Lines(run, self._write)

    def _write(self, text: str | None, record: LogRecord | None = None) -> None:
        """Write a line, at the level of a record, or the record itself if there is no text."""
        if text is not None:
            kept = record.__dict__ if record else {"levelno": INFO, "levelname": "INFO"}
            record = makeLogRecord({**kept, "event": None, "msg": text, "args": None})
        try:
            self._text.handle(record)
        except BrokenPipeError:
            # The reader has ended, as `head` does: the run continues, and its output is discarded.
            devnull = os.open(os.devnull, os.O_WRONLY)
            os.dup2(devnull, self._text.stream.fileno())
            os.close(devnull)

    def close(self) -> None:
        """Remove the display and write the closing lines; Snakemake calls this at the end, also after Ctrl-C."""
        if self._display:
            self._display.close()
        self._report_silent_jobs()
        for line in self._closing_lines() if self._has_begun else ():
            self._write(line)
        # Snakemake may close its handlers more than once.
        self._has_begun, self._display = False, None
        super().close()

    def _closing_lines(self) -> list[str]:
        run = self._run
        try:
            if self.common_settings.dryrun:
                run = Run() if self._has_stopped else PLAN.look_ahead()
                run.cores = self._given_cores or os.cpu_count() or 1
                run.capacity = f"on {format_count(int(run.cores), 'core')}"
                if run.jobs and is_touch(sys.argv[1:]):
                    return [f"{format_count(len(run.jobs), 'job')} would not run: --touch only marks existing files"]
                return dry_run_lines(run) if run.jobs else []
            if not (run.results and run.jobs):
                return []
            # With `--quiet progress` the log does not contain the ends of jobs, but their files exist.
            for job in run.jobs_in(RUNNING) if self._quiet else ():
                job.state = DONE if all(Path(path).exists() for path in job.output) else RUNNING
            return closing_lines(run, time.monotonic() - self._begin, stopped=self._has_stopped)
        except Exception as error:
            what = "the time of a run" if self.common_settings.dryrun else "the results of the run"
            return [f"{what} cannot be determined: {error}"]
