"""What shows a run while it runs: a picture on a terminal, elsewhere a line now and then; and its words."""

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

#: Seconds between two lines at least, and after which there is one even if no such share of all jobs was done.
SHORTEST, LONGEST, STEP = 10.0, 60.0, 0.05
#: Seconds after which a job is named in the picture, and how many are at most.
LONG_JOB, LONG_JOBS = 5.0, 4
#: Columns of a bar, and of a terminal too narrow for bars.
BAR_WIDTH, NARROW = 30, 64


def about(seconds: float) -> str:
    """Return a duration no more precise than an estimate is: a few seconds, about 40 s, about 3 min, about 2.5 h."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 55:
        return f"about {round(seconds, -1):.0f} s"
    if seconds < 90 * 60:
        return f"about {max(round(seconds / 60), 1)} min"
    return f"about {seconds / 3600:.1f} h"


def elapsed(seconds: float) -> str:
    """Return a duration as 12 s, 5 min 12 s or 2 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def cost(run: Run) -> str:
    """Return in a line what a run would cost that has not begun."""
    expected, jobs = run.expected(), run.jobs.values()
    cpu, size = sum(expected[job.rule] for job in jobs), sum(run.durations.shipped(job.rule)[1] for job in jobs)
    disk = f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(round(size / 1e6), 1)} MB"
    cores = format_count(int(run.cores), "core")
    return f"a run takes {about(run.forecast(0.0))} on {cores}: {about(cpu)} of CPU time, and {disk} of disk"


def beginning(run: Run, now: float) -> str:
    """Return what a run says first: its jobs, and the time that they take."""
    *stages, (_, jobs) = run.counts()
    words = ", ".join(f"{stage} {states.total()}" for stage, states in stages)
    return f"{format_count(jobs.total(), 'job')}: {words}; {outlook(run, now)}"


def progress(run: Run, now: float) -> str:
    """Return a line about a run: the stages at work, all jobs, and the outlook."""
    *stages, (_, jobs) = run.counts()
    words = [f"{stage} {states[DONE]} of {states.total()}" for stage, states in stages if states[RUNNING]]
    percent = 100 * jobs[DONE] // jobs.total()
    return ", ".join([*words, f"all {jobs[DONE]} of {jobs.total()} ({percent} %)", outlook(run, now)])


def outlook(run: Run, now: float) -> str:
    """Return how many jobs failed, how many cannot run for that, and the time left."""
    counts = ((len(run.of(FAILED)), "failed"), (len(run.blocked()), "cannot run"))
    return ", ".join([*(f"{count} {what}" for count, what in counts if count), f"{about(run.time_left(now))} left"])


def first_figures(run: Run, rules: Sequence[str]) -> str:
    """Return where the figures of some rules lie if all of them are made, and nothing if not."""
    jobs = [job for job in run.jobs.values() if job.name in rules]
    if any(job.state != DONE for job in jobs):
        return ""
    names = sorted({Path(path).stem for job in jobs for path in job.output})
    return f"the figures of the paper are in {run.results}/figures: {', '.join(names)}"


class Lines(threading.Thread):
    """Says progress lines from a thread of its own, as long jobs leave nothing in the log."""

    def __init__(self, run: Run, say: Callable[[str], None]) -> None:
        super().__init__(daemon=True)
        self._run, self._say = run, say
        self._time, self._done = time.monotonic(), 0
        self._closed = threading.Event()
        self.start()

    def run(self) -> None:
        """Say a line whenever one is due."""
        while not self._closed.wait(1.0):
            if self.is_due(now := time.monotonic()):
                self._say(progress(self._run, now))

    def is_due(self, now: float) -> bool:
        """Tell whether it is time for a line, and reckon with it."""
        _, jobs = self._run.counts()[-1]
        done, waited = jobs[DONE], now - self._time
        much = done - self._done >= STEP * jobs.total() or waited >= LONGEST
        due = much and waited >= SHORTEST and done < jobs.total()
        if due:
            self._time, self._done = now, done
        return due

    def close(self) -> None:
        """End the thread; no line comes after this."""
        self._closed.set()
        self.join()


class Picture:
    """Draws a line for each stage at the bottom of a terminal; what a handler of the log writes scrolls by over it."""

    def __init__(self, run: Run, text: Any) -> None:
        self._run, self._text, self._stream, self._begin = run, text, text.stream, time.monotonic()
        # Long lines are left to the terminal: a command in a message can be copied.
        self._console = Console(file=text.stream, no_color=text.nocolor, highlight=False, soft_wrap=True)
        self._live = Live(
            get_renderable=self.drawn,
            console=self._console,
            refresh_per_second=2,
            transient=True,
            redirect_stdout=False,
            redirect_stderr=False,
        )
        self._live.start()
        text.setStream(FileProxy(self._console, text.stream))

    def drawn(self) -> Group:
        """Return the picture of now: stages, all jobs with the time left, and the jobs that run long."""
        now, table, counts = time.monotonic(), Table.grid(padding=(0, 1)), self._run.counts()
        for stage, states in counts:
            is_all = states is counts[-1][1]
            at_work = f"{states[RUNNING]} running" if states[RUNNING] and not is_all else ""
            words = stage, f"{states[DONE]} of {states.total()}", at_work
            name, *cells = (Text(word, "bold" if at_work or is_all else "dim") for word in words)
            bar = [ProgressBar(states.total(), states[DONE], BAR_WIDTH)] if self._console.width >= NARROW else []
            table.add_row(name, *bar, *cells)
        table.columns[-2].justify = "right"
        so_far = f"{outlook(self._run, now)}, {elapsed(now - self._begin)} so far"
        lines = [(so_far, "bold red" if self._run.of(FAILED) else "bold")]
        running = sorted((job.begin, job.message or job.name) for job in self._run.of(RUNNING))[:LONG_JOBS]
        lines += [(f"{job}: {elapsed(now - begin)}", "dim") for begin, job in running if now - begin > LONG_JOB]
        return Group(table, *(Text(*line, no_wrap=True, overflow="ellipsis") for line in lines))

    def close(self) -> None:
        """Take the picture away and give the cursor back."""
        self._live.stop()
        self._text.setStream(self._stream)
