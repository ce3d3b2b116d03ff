"""Progress of a study for people: `snakemake --logger study`, set in workflow/profiles/default.

On a terminal a display with a line for each stage, elsewhere a progress line now and then. Everything that is not
progress goes through Snakemake's own handler, with its own filter and format.
"""

from __future__ import annotations

import re
import sys
import threading
from logging import ERROR, INFO, LogRecord, makeLogRecord
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from burridge_knopoff.study import ConfigError
from burridge_knopoff.study.job_log import failure
from snakemake_logger_plugin_study.command_line import check_command_line
from snakemake_logger_plugin_study.refusal import one_line
from snakemake_logger_plugin_study.tally import Tally
from snakemake_logger_plugin_study.wording import job_name

#: Records that the display replaces; -p and --verbose bring them back.
_REPLACED = {
    LogEvent.JOB_INFO,
    LogEvent.GROUP_INFO,
    LogEvent.JOB_STARTED,
    LogEvent.JOB_FINISHED,
    LogEvent.PROGRESS,
    LogEvent.RUN_INFO,
    LogEvent.RESOURCES_INFO,
    LogEvent.SHELLCMD,
}
# The one message without an event that comes with every few jobs.
_ROUTINE = "Select jobs to execute"
# What Snakemake says of a script that ended with an error.
_FAILED_COMMAND = re.compile(r"RuleException:\s+CalledProcessError ")


class LogHandler(LogHandlerBase):
    """Counts what the log tells of jobs, shows it, and hands the rest to Snakemake's own handler."""

    def __post_init__(self) -> None:
        try:
            check_command_line(sys.argv[1:])
        except ConfigError as error:
            sys.exit(str(error))
        from snakemake.logging import ColorizingTextHandler, DefaultFilter, DefaultFormatter, is_quiet_about

        settings: Any = self.common_settings
        quiet = settings.quiet or set()
        self._stream = sys.stdout if settings.stdout else sys.stderr
        self._text = ColorizingTextHandler(
            nocolor=settings.nocolor,
            stream=self._stream,
            formatter=DefaultFormatter(quiet, settings.show_failed_logs),
        )
        self._text.addFilter(
            DefaultFilter(quiet, settings.debug_dag, settings.verbose, settings.dryrun, settings.printshellcmds)
        )
        self._whole_logs = settings.show_failed_logs
        self._everything = settings.dryrun or settings.verbose or settings.printshellcmds or settings.debug_dag
        self._silent = settings.dryrun or is_quiet_about(quiet, "progress")
        self._tally = Tally()
        self._grouped: set[int] = set()
        self._names: dict[int, str] = {}
        self._display: Any = None
        # Two displays read the tally from threads of their own.
        self._state = threading.RLock()

    writes_to_stream = True
    writes_to_file = False
    has_filter = True
    has_formatter = True
    needs_rulegraph = False

    def emit(self, record: LogRecord) -> None:
        """Take a record of Snakemake's log."""
        try:
            with self._state:
                self._count(record)
        except Exception:
            # A defect of the display must neither end the thread of the log nor hide a message.
            self.handleError(record)
        if not self._replaced(record):
            self._text.handle(self._in_a_line(record) if self._short(record) else one_line(record))

    def _replaced(self, record: LogRecord) -> bool:
        if self._everything:
            return False
        if record.levelno == ERROR:
            # The failed job itself is told of right after, with what its log says.
            return bool(_FAILED_COMMAND.match(record.getMessage()))
        if record.levelno != INFO:
            return False
        event = getattr(record, "event", None)
        return event in _REPLACED or (event is None and record.getMessage().startswith(_ROUTINE))

    def _short(self, record: LogRecord) -> bool:
        """Tell whether a line is enough for a failed job: its block lists all input, which may be 10,000 files."""
        if self._everything or self._whole_logs or getattr(record, "event", None) != LogEvent.JOB_ERROR:
            return False
        return getattr(record, "jobid", None) in self._names

    def _in_a_line(self, record: Any) -> LogRecord:
        """Return the record of a failed job as one line: job, reason, log."""
        line = failure(self._names[record.jobid], record.log or [])
        return makeLogRecord({**record.__dict__, "event": None, "msg": line, "args": None})

    def _count(self, record: Any) -> None:
        event = getattr(record, "event", None)
        if event == LogEvent.RESOURCES_INFO:
            # `nodes` with jobs on a cluster; without a limit it is a number too large to tell anything.
            limit = getattr(record, "cores", None) or getattr(record, "nodes", None)
            if limit is not None and limit < sys.maxsize:
                self._tally.cores = limit
        elif event == LogEvent.RUN_INFO:
            self._tally.expect_counts({name: count for name, count in record.stats.items() if name != "total"})
        elif hasattr(record, "plan"):
            self._tally.expect(*record.plan)
            self._show()
        elif event == LogEvent.JOB_INFO and (record.output or record.rule_name in self._tally.rules):
            # The plan shows the display already, unless --no-hooks keeps it away.
            self._show()
            self._names[record.jobid] = job_name(record.rule_name, record.wildcards)
            if record.indent:
                self._grouped.add(record.jobid)
            self._tally.start(record.jobid, record.rule_name, record.created, record.threads, record.rule_msg or "")
        elif event == LogEvent.JOB_FINISHED:
            # Jobs of a group start and end together: that tells no duration of each.
            self._tally.finish(record.job_id, record.created, timed=record.job_id not in self._grouped)
        elif event == LogEvent.JOB_ERROR:
            self._tally.fail(record.jobid)

    def _show(self) -> None:
        if self._silent or self._display is not None:
            return
        if self._text.can_color_tty():
            # Only a terminal needs rich, which takes a while to import.
            from snakemake_logger_plugin_study.live import LiveDisplay

            self._display = LiveDisplay(self._tally, self._state, self._stream, self._text.nocolor)
            self._text.setStream(self._display.above)
        else:
            from snakemake_logger_plugin_study.plain import PlainDisplay

            self._display = PlainDisplay(self._tally, self._state, self._text)

    def close(self) -> None:
        """Take the display away; Snakemake calls this at the end, also after an error or Ctrl-C."""
        display, self._display = self._display, None
        if display is not None:
            display.close()
            self._text.setStream(self._stream)
        super().close()
