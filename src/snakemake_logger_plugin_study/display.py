"""The display of a run: stages at the bottom of a terminal, or a line from time to time; and the text of both."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import Any

from rich.console import Console, Group
from rich.file_proxy import FileProxy
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from burridge_knopoff.study.formatting import format_count
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Run

#: Least time in seconds between two lines; time after which a line is due in any case; share of the run after which one
#: is due.
SHORTEST, LONGEST, STEP = 10.0, 60.0, 0.05
#: Seconds after which the picture names a running job, and the largest number of jobs that it names.
LONG_JOB, LONG_JOBS = 5.0, 4
#: Rules whose jobs keep what they find in the cache of the study.
CACHING = ("attractors_of_law", "bifurcations_of_law")
#: Width of a bar, and of a terminal without room for bars.
BAR_WIDTH, NARROW = 30, 64


def format_estimate(seconds: float) -> str:
    """Return an estimated duration: a few seconds, about 40 s, about 3 min, about 2.5 h."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 55:
        return f"about {round(seconds, -1):.0f} s"
    if seconds < 90 * 60:
        return f"about {max(round(seconds / 60), 1)} min"
    return f"about {seconds / 3600:.1f} h"


def format_elapsed(seconds: float) -> str:
    """Return a measured duration: 12 s, 5 min 12 s or 2 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def dry_run_lines(run: Run) -> list[str]:
    """Return the jobs of a planned run by stage as a table, and the time and the disk space that it takes."""
    *stages, total = run.stages(0.0)
    head = "stage", "jobs", "CPU time"
    rows = [head, *((stage.name, str(stage.jobs), format_estimate(stage.work)) for stage in (*stages, total))]
    name_width, count_width = (max(len(row[column]) for row in rows) for column in (0, 1))
    size = sum(run.durations.shipped_cost(job.rule)[1] for job in run.jobs.values())
    disk = f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(round(size / 1e6), 1)} MB"
    has_cache = any(job.rule in CACHING for job in run.jobs.values())
    cache = ", in addition to the cache of the searches (.snakemake/study_cache, about 300 MB in the default study)"
    return [
        *(f"{name:{name_width}}  {count:>{count_width}}  {cpu}" for name, count, cpu in rows),
        f"a run takes {format_estimate(run.forecast(0.0))} {run.capacity} and {disk} of disk space{cache * has_cache} "
        "(snakemake -n -p lists the jobs)",
    ]


def first_line(run: Run, now: float) -> str:
    """Return the first line of a run: its jobs by stage, and the time that it takes."""
    *stages, total = run.stages(now)
    words = ", ".join(f"{stage.name} {stage.jobs}" for stage in stages)
    return f"{format_count(total.jobs, 'job')}: {words}; {format_estimate(run.time_left(now))} {run.capacity}"


def progress_line(run: Run, now: float) -> str:
    """Return a line about a run: the running stages, the jobs done, the share of the time, and the outlook."""
    *stages, total = run.stages(now)
    words = [f"{stage.name} {stage.counts[DONE]} of {stage.jobs}" for stage in stages if stage.counts[RUNNING]]
    jobs = ", ".join([*words, f"all {total.counts[DONE]} of {format_count(total.jobs, 'job')}"])
    return f"{jobs}; {int(100 * total.share_done)} % done, {outlook(run, now)}"


def outlook(run: Run, now: float) -> str:
    """Return the number of failed jobs, of jobs that therefore cannot run, and the time left."""
    counts = ((len(run.jobs_in(FAILED)), "failed"), (len(run.blocked()), "cannot run"))
    failures = [f"{count} {what}" for count, what in counts if count]
    return ", ".join([*failures, f"{format_estimate(run.time_left(now))} left"])


def first_figures_line(run: Run, rules: Sequence[str]) -> str:
    """Return where the figures of some rules are once all of them are drawn, and an empty text before."""
    jobs = [job for job in run.jobs.values() if job.name in rules]
    if any(job.state != DONE for job in jobs):
        return ""
    names = sorted({Path(path).stem for job in jobs for path in job.output})
    return f"the figures of the paper are in {run.results}/figures: {', '.join(names)}"


class Lines(threading.Thread):
    """Writes progress lines from its own thread, since long jobs leave nothing in the log."""

    def __init__(self, run: Run, write: Callable[[str], None]) -> None:
        super().__init__(daemon=True)
        self._run, self._write = run, write
        self._time, self._share = time.monotonic(), 0.0
        self._closed = threading.Event()
        self.start()

    def run(self) -> None:
        """Write a line whenever one is due."""
        while not self._closed.wait(1.0):
            if self.is_due(now := time.monotonic()):
                self._write(progress_line(self._run, now))

    def is_due(self, now: float) -> bool:
        """Return whether a line is due, which then counts as written."""
        total, waited = self._run.stages(now)[-1], now - self._time
        has_advanced = total.share_done - self._share >= STEP or waited >= LONGEST
        due = has_advanced and waited >= SHORTEST and total.counts[DONE] < total.jobs
        if due:
            self._time, self._share = now, total.share_done
        return due

    def close(self) -> None:
        """End the thread; no line follows."""
        self._closed.set()
        self.join()


class Picture:
    """Draws a line for each stage at the bottom of a terminal; the output of the log handler scrolls above it."""

    def __init__(self, run: Run, text: Any) -> None:
        self._run, self._text, self._stream, self._begin = run, text, text.stream, time.monotonic()
        # The terminal wraps long lines, so that a command in a message can be copied.
        self._console = Console(file=text.stream, no_color=text.nocolor, highlight=False, soft_wrap=True)
        self._live = Live(
            get_renderable=self.picture,
            console=self._console,
            refresh_per_second=2,
            transient=True,
            redirect_stdout=False,
            redirect_stderr=False,
        )
        self._live.start()
        text.setStream(FileProxy(self._console, text.stream))

    def picture(self) -> Group:
        """Return the current picture: stages, all jobs with the time left, and the jobs that have run for long."""
        now, table = time.monotonic(), Table.grid(padding=(0, 1))
        stages = self._run.stages(now)
        for stage in stages:
            is_all = stage is stages[-1]
            running = f"{stage.counts[RUNNING]} running" if stage.counts[RUNNING] and not is_all else ""
            words = stage.name, f"{stage.counts[DONE]} of {stage.jobs}", running
            name, *cells = (Text(word, "bold" if running or is_all else "dim") for word in words)
            bar = [ProgressBar(1.0, stage.share_done, BAR_WIDTH)] if self._console.width >= NARROW else []
            table.add_row(name, *bar, *cells)
        table.columns[-2].justify = "right"
        so_far = f"{outlook(self._run, now)}, {format_elapsed(now - self._begin)} so far"
        lines = [(so_far, "bold red" if self._run.jobs_in(FAILED) else "bold")]
        jobs = sorted(self._run.jobs_in(RUNNING), key=lambda job: (job.begin, job.name))[:LONG_JOBS]
        for job in (job for job in jobs if now - job.begin > LONG_JOB):
            done = f", {int(100 * share)} % done" if (share := job.progress) else ""
            lines.append((f"{job.message or job.name}: {format_elapsed(now - job.begin)}{done}", "dim"))
        return Group(table, *(Text(*line, no_wrap=True, overflow="ellipsis") for line in lines))

    def close(self) -> None:
        """Remove the picture and restore the cursor."""
        self._live.stop()
        self._text.setStream(self._stream)
