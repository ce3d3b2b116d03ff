"""Progress of a study for people: `snakemake --logger study`, set in workflow/profiles/default.

On a terminal a display with a line for each stage, elsewhere a progress line now and then, and at the end what the run
left. Everything else goes through Snakemake's own handler, filter and format.
"""

from __future__ import annotations

import os
import sys
import threading
import time
from contextlib import suppress
from logging import INFO, Formatter, LogRecord, makeLogRecord
from pathlib import Path
from typing import Any

from snakemake_interface_logger_plugins.base import LogHandlerBase
from snakemake_interface_logger_plugins.common import LogEvent

from burridge_knopoff.study import ConfigError
from burridge_knopoff.study.job_log import failure
from burridge_knopoff.study.words import counted
from snakemake_logger_plugin_study.closing import closing_lines
from snakemake_logger_plugin_study.forecast import downstream, following
from snakemake_logger_plugin_study.past import write_past
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.refusal import check_command_line, given_cores, reworded
from snakemake_logger_plugin_study.tally import DONE, FAILED, RUNNING, Job, Rule, Tally
from snakemake_logger_plugin_study.wording import cost, job_name, time_left

#: Events that the display does not replace; -p and --verbose bring the others back.
_KEPT = (
    *(None, LogEvent.ERROR, LogEvent.JOB_ERROR, LogEvent.GROUP_ERROR),
    *(LogEvent.WORKFLOW_STARTED, LogEvent.DEBUG_DAG),
)


class LogHandler(LogHandlerBase):
    """Counts what the log tells of jobs, shows it, and hands the rest to Snakemake's own handler."""

    def __post_init__(self) -> None:
        try:
            check_command_line(sys.argv[1:])
        except ConfigError as error:
            sys.exit(str(error))
        from snakemake.logging import ColorizingTextHandler, is_quiet_about

        settings: Any = self.common_settings
        self._stream = sys.stdout if settings.stdout else sys.stderr
        self._text = ColorizingTextHandler(nocolor=settings.nocolor, stream=self._stream)
        self._everything = settings.dryrun or settings.verbose or settings.printshellcmds or settings.debug_dag
        self._whole_errors = self._everything or settings.show_failed_logs
        self._quiet = is_quiet_about(settings.quiet or set(), "progress")
        self._dryrun = settings.dryrun
        self._begin = time.time()
        self._stopped = False
        self._tally = Tally()
        #: {rule: number of its jobs that are to run}, and {rule of the targets: rules that it needs}.
        self._counts: dict[str, int] = {}
        self._needs: dict[str, set[str]] = {}
        self._display: Any = None
        # Displays read the tally from threads of their own.
        self._lock = threading.RLock()

    writes_to_stream = True
    writes_to_file = False
    # Snakemake gives its own, as it does to its own handler.
    has_filter = False
    has_formatter = False
    needs_rulegraph = True

    def filter(self, record: LogRecord) -> bool:
        """Let each record count, also what is not to be shown."""
        return True

    def setFormatter(self, fmt: Formatter | None) -> None:
        """Hand Snakemake's formatter on."""
        self._text.setFormatter(fmt)

    def emit(self, record: LogRecord) -> None:
        """Take a record of Snakemake's log."""
        repeated = self._is_repeated(record)
        try:
            with self._lock:
                self._take(record)
        except Exception:
            # A defect of the display must neither end the thread of the log nor hide a message.
            self.handleError(record)
        shown = self._shown(record)
        if shown is not None and not repeated:
            self._write(shown)

    def _is_repeated(self, record: Any) -> bool:
        """Tell whether a record tells of a failed job once more, as those of Snakemake 9.22 do."""
        if getattr(record, "event", None) != LogEvent.JOB_ERROR:
            return False
        job = self._tally.job(record.jobid)
        return job is not None and job.state == FAILED

    def _shown(self, record: Any) -> LogRecord | None:
        """Return what is shown of a record: itself, one line in its place, or nothing."""
        event = getattr(record, "event", None)
        if event == LogEvent.JOB_ERROR and not self._whole_errors and (job := self._tally.job(record.jobid)):
            # Snakemake's own block lists all input, which may be 10,000 files.
            return _line(failure(job.name, record.log or []), record)
        if event not in _KEPT and record.levelno == INFO and not self._everything:
            return None
        words = reworded(record.getMessage()) if event in (None, LogEvent.ERROR) else None
        if words is None or (words == "" and self._everything):
            return record
        return _line(words, record) if words else None

    def _take(self, record: Any) -> None:
        event = getattr(record, "event", None)
        if event == LogEvent.RULEGRAPH:
            graph = record.rulegraph
            self._needs = {node["rule"]: set() for node in graph["nodes"]}
            for link in graph["links"]:
                self._needs[link["targetrule"]].add(link["sourcerule"])
        elif event == LogEvent.RESOURCES_INFO:
            # `nodes` with jobs on a cluster; without a limit it is a number too large to tell anything.
            limit = getattr(record, "cores", None) or getattr(record, "nodes", None)
            if limit is not None and limit < sys.maxsize:
                self._tally.cores = limit
        elif event == LogEvent.RUN_INFO:
            self._counts = {name: count for name, count in record.stats.items() if name != "total"}
        elif event == LogEvent.JOB_STARTED and self._display is None:
            self._expect()
        elif event == LogEvent.JOB_INFO and (record.output or record.rule_name in self._tally.rules):
            # Jobs of a group start and end together: that tells no duration of each.
            name, message = job_name(record.rule_name, record.wildcards), record.rule_msg or ""
            files = tuple(record.output), tuple(record.log or ())
            job = Job(name, record.created, message, *files, timed=not record.indent)
            self._tally.start(record.jobid, record.rule_name, job)
        elif event == LogEvent.JOB_FINISHED:
            self._tally.end(record.job_id, DONE, record.created)
        elif event == LogEvent.JOB_ERROR:
            self._tally.end(record.jobid, FAILED)
        elif event == LogEvent.ERROR:
            self._stopped = True

    def _expect(self) -> None:
        """Begin to show a run, whose first jobs start."""
        if not self._tally.rules:
            for name in PLAN.stages or self._counts:
                if name in self._counts:
                    needs = frozenset(self._needs.get(name, ()))
                    stage = PLAN.stages.get(name, name)
                    self._tally.rules[name] = Rule(stage, self._counts[name], needs)
            if PLAN.results:
                self._tally.forecast = PLAN.forecast
                *stages, total = self._tally.counts()
                left = PLAN.forecast.time_left(0.0, self._tally.cores) if PLAN.forecast else None
                words = ", ".join(f"{stage.name} {stage.total}" for stage in stages)
                self._say("; ".join(filter(None, [f"{counted(total.total, 'job')}: {words}", time_left(left)])))
        if self._quiet:
            return
        if self._text.can_color_tty():
            # Only a terminal needs rich, which takes a while to import.
            from snakemake_logger_plugin_study.live import LiveDisplay

            self._display = LiveDisplay(self._tally, self._lock, self._stream, self._text.nocolor)
            self._text.setStream(self._display.above)
        else:
            from snakemake_logger_plugin_study.plain import PlainDisplay

            self._display = PlainDisplay(self._tally, self._lock, self._say)

    def _write(self, record: LogRecord) -> None:
        if not super().filter(record):
            return
        try:
            self._text.handle(record)
        except BrokenPipeError:
            # Whoever read has gone, as `head` does: the run goes on, and what follows goes nowhere.
            nowhere = os.open(os.devnull, os.O_WRONLY)
            os.dup2(nowhere, self._stream.fileno())
            os.close(nowhere)

    def _say(self, line: str) -> None:
        self._write(_line(line))

    def close(self) -> None:
        """Take the display away and say what the run left; Snakemake calls this at the end, also after Ctrl-C."""
        if self._dryrun and self._counts and not self._stopped:
            self._foretell()
        # Snakemake may close its handlers more than once.
        self._dryrun = False
        display, self._display = self._display, None
        if display is not None:
            display.close()
            self._text.setStream(self._stream)
        if PLAN.results and self._tally.rules:
            tally, self._tally = self._tally, Tally()
            # `--quiet progress` keeps from the log which jobs were done, but their files are there.
            for job in tally.jobs(RUNNING) if self._quiet else ():
                job.state = DONE if all(Path(path).exists() for path in job.output) else RUNNING
            # What comes after a rule that runs, and does not run itself, is left out by --until.
            left_out = downstream(self._counts, following(self._needs)) - self._counts.keys()
            try:
                wanted = self._needs.keys() - left_out
                lines = closing_lines(PLAN.results, time.time() - self._begin, tally, wanted, stopped=self._stopped)
            except Exception as error:
                lines = [f"what the run left cannot be told: {error}"]
            for line in lines:
                self._say(line)
            self._remember(tally)
        super().close()

    def _foretell(self) -> None:
        """Say what the jobs of a dry run would cost."""
        try:
            forecast = PLAN.look_ahead()
        except Exception as error:
            self._say(f"the time of a run cannot be told: {error}")
            return
        if forecast and forecast.jobs:
            cores = given_cores(sys.argv[1:]) or os.cpu_count() or 1
            self._say(cost(forecast.cost(cores), cores))

    def _remember(self, tally: Tally) -> None:
        """Record what the jobs took; a folder that cannot be written to fails no run."""
        if PLAN.forecast:
            ran = [(number, job) for rule in tally.rules.values() for number, job in rule.jobs.items()]
            options = {"cores": tally.cores, "speed": PLAN.speed, "begin": self._begin}
            with suppress(OSError):
                write_past(PLAN.results, PLAN.forecast.jobs, ran, **options)


def _line(words: str, record: LogRecord | None = None) -> LogRecord:
    """Return the record of one line, at the level of another record."""
    kept = record.__dict__ if record else {"levelno": INFO, "levelname": "INFO"}
    return makeLogRecord({**kept, "event": None, "msg": words, "args": None})
