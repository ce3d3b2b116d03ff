"""Progress of a study for people: `snakemake --logger study`, set in workflow/profiles/default.

It displays a run while it lasts, and closes it with what it made. A dry run ends with a table of its stages. Of
Snakemake's own messages, those of a run are shown if they are warnings or errors, and all with -p or --verbose.
"""

from __future__ import annotations

import sys
import time
from collections.abc import Collection, Sequence
from dataclasses import replace
from functools import partial
from logging import WARNING, LogRecord
from typing import Any

from rich.console import Console
from rich.live import Live
from rich.text import Text
from snakemake.settings.enums import Quietness
from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from burridge_knopoff.messages import escape_unprintable
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import SILENT, failure_line, failure_reason, is_interrupted
from burridge_knopoff.study.yaml_file import ConfigError
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.command_line import check_command_line
from snakemake_logger_plugin_study.display import dry_run_lines, first_line, newer_lines, picture, progress_line
from snakemake_logger_plugin_study.durations import measured_seconds
from snakemake_logger_plugin_study.plan import Plan
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Run
from snakemake_logger_plugin_study.targets import target_error

#: Least time in seconds between two progress lines, if there is no terminal.
PACE = 30.0
#: Snakemake's own words.
NOTHING = "Nothing to be done (all requested files are present and up to date)."


class LogHandler(LogHandlerBase):
    """Follows a run by Snakemake's events and displays it; other messages are those of Snakemake."""

    writes_to_stream = True
    writes_to_file = has_filter = has_formatter = needs_rulegraph = False

    def __post_init__(self) -> None:
        try:
            check_command_line(sys.argv[1:])
        except ConfigError as error:
            sys.exit(escape_unprintable(f"{error}"))
        settings = self.common_settings
        stream = sys.stdout if settings.stdout else sys.stderr
        # The terminal wraps long lines, so that a command in a message can be copied.
        self._console = Console(file=stream, force_terminal=stream.isatty(), no_color=settings.nocolor, soft_wrap=True)
        self._quiet: Collection[Quietness] = settings.quiet or ()
        self._shows_all = settings.verbose or settings.printshellcmds or settings.debug_dag
        #: Whether Snakemake has begun to execute a study, whether it found jobs, and whether it ended with an error.
        self._is_study = self._has_jobs = self._has_stopped = False
        #: The capacity of a cluster, in place of the cores of this machine.
        self._cluster: dict[str, Any] = {}
        self._plan: Plan | None = None
        self._begin, self._run = 0.0, Run()
        self._picture: Live | None = None
        self._next_line = 0.0

    def set_plan(self, plan: Plan) -> None:
        """Take the plan of the study, before its run begins."""
        self._plan = plan

    def filter(self, record: LogRecord) -> Any:
        """Follow the run by each record, also by those that are not shown."""
        try:
            self._follow(record)
        except Exception:
            # A defect of the display must neither end the thread of the log nor hide a message.
            self.handleError(record)
        return super().filter(record)

    def emit(self, record: LogRecord) -> None:
        """Write a message of Snakemake, unless the display has replaced it."""
        try:
            event, exception = getattr(record, "event", None), getattr(record, "exception", None)
            is_failure = event == LogEvent.JOB_ERROR or exception == "RuleException"
            is_hidden = is_failure and self._run.jobs and not self.common_settings.show_failed_logs
            plan = self._plan if event == LogEvent.ERROR and not self._has_jobs else None
            if plan and (error := target_error(plan)):
                self._write(error)
            elif self._shows_all or not self._is_study or (record.levelno >= WARNING and not is_hidden):
                self._write(self.format(record))
        except Exception:
            self.handleError(record)

    def _follow(self, record: Any) -> None:
        run = self._run
        match getattr(record, "event", None):
            case LogEvent.WORKFLOW_STARTED:
                self._is_study = self._plan is not None
            # Without a limit it is sys.maxsize.
            case LogEvent.RESOURCES_INFO if 0 < (nodes := getattr(record, "nodes", None) or 0) < sys.maxsize:
                self._cluster = {"cores": nodes, "capacity": f"with {format_count(nodes, 'job')} at a time"}
            case LogEvent.RUN_INFO:
                self._has_jobs = True
            # The log does not have the ends of jobs with --quiet progress.
            case LogEvent.JOB_STARTED if not (run.jobs or Quietness.PROGRESS in self._quiet):
                self._begin_display()
            case LogEvent.JOB_INFO if job := run.jobs.get(record.jobid):
                job.begin, job.since, job.message = time.monotonic(), time.time(), record.rule_msg or ""
                job.output, job.log, job.state = record.output, record.log or [], RUNNING
                if not (self._picture or run.touching or job.begin < self._next_line):
                    self._next_line = job.begin + PACE
                    self._write(progress_line(run, job.begin))
            case LogEvent.JOB_FINISHED if job := run.jobs.get(record.job_id):
                job.seconds, job.state = measured_seconds(job.benchmark, job.cores), DONE
            # Snakemake 9.22 reports each failure twice.
            case LogEvent.JOB_ERROR if (job := run.jobs.get(record.jobid)) and job.state != FAILED:
                job.state, job.log = FAILED, record.log or []
                # Ctrl-C ends jobs before Snakemake reports it, some before their log has a word; the last lines tell.
                if not is_interrupted(job.log) and failure_reason(job.log) != SILENT:
                    self._write(failure_line(job.name, job.log))
            case LogEvent.ERROR if record.exception != "RuleException":
                self._has_stopped = True

    def _begin_display(self) -> None:
        """Begin to display a run whose first jobs start."""
        run = self._run = replace(self._plan.run if self._plan else Run(), **self._cluster)
        self._begin = time.monotonic()
        self._next_line = self._begin + PACE
        if not run.jobs:
            # As without hooks, Snakemake's own messages are all there is.
            self._shows_all = True
        elif not run.touching:
            for line in (*newer_lines(run), first_line(run, self._begin)):
                self._write(line)
            if self._console.is_interactive:
                draw = partial(picture, run, self._begin)
                self._picture = Live(get_renderable=draw, console=self._console, refresh_per_second=1, transient=True)
                self._picture.start()

    def _write(self, text: str) -> None:
        if text and (Quietness.ALL not in self._quiet or self.common_settings.dryrun):
            self._console.print(Text("\n".join(map(escape_unprintable, text.expandtabs().split("\n")))))

    def close(self) -> None:
        """Remove the picture and write the last lines; Snakemake calls this at the end, also after Ctrl-C."""
        if self._picture:
            self._picture.stop()
        # Snakemake may close its handlers more than once.
        is_end, self._is_study = self._is_study, False
        for line in self._last_lines() if is_end else ():
            self._write(line)
        super().close()

    def _last_lines(self) -> Sequence[str]:
        assert self._plan is not None
        if not self._has_jobs and not self._has_stopped:
            # No hook of the Snakefile runs then; `bk check` would use the config of an earlier run.
            if not self.common_settings.dryrun:
                self._plan.record()
            return [NOTHING]
        if self.common_settings.dryrun and not self._has_stopped:
            plan = self._plan.look_ahead()
            # A rule such as `points`, named by --until, is a job that makes nothing.
            return dry_run_lines(plan) if plan.jobs else [NOTHING]
        if not self._run.jobs:
            return []
        return closing_lines(self._run, time.monotonic() - self._begin, self._has_stopped, sys.argv[1:])
