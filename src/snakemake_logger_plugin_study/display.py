"""The text of the display: stages at the bottom of a terminal, or a line from time to time; the table of a dry run."""

from __future__ import annotations

import time

from rich.console import Group
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import progress_of
from snakemake_logger_plugin_study.run import DONE, FAILED, RUNNING, Run

#: Seconds after which the picture names a running job, and the largest number of jobs that it names.
LONG_JOB, LONG_JOBS = 5.0, 4
#: Width of a bar.
BAR_WIDTH = 30


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
    rows = [("stage", "jobs", "CPU time")]
    rows += [(stage.name, str(stage.jobs), format_estimate(stage.work)) for stage in run.stages(0.0)]
    width = max(len(name) for name, *_ in rows)
    size = sum(run.durations.shipped_cost(job.rule)[1] for job in run.jobs.values())
    disk = f"{size / 1e9:.1f} GB" if size >= 1e9 else f"{max(round(size / 1e6), 1)} MB"
    return [
        *newer_lines(run),
        *(f"{name:{width}}  {count:>6}  {cpu}" for name, count, cpu in rows),
        f"a run takes {format_estimate(run.time_left(0.0))} {run.capacity} and {disk} of disk space "
        "(snakemake -n -p lists the jobs)",
    ]


def newer_lines(run: Run) -> list[str]:
    """Return a line about files that are newer than files made from them, if there are any: a reason for many jobs."""
    if not run.newer:
        return []
    files = format_count(len(run.newer), "file")
    return [
        f"newer than files made from them: {files}, such as {next(iter(run.newer))} "
        "(cp -r gives all copied files new times, cp -a keeps the times)"
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
    return f"{jobs}; {int(100 * total.work_done / total.work)} % done, {outlook(run, now)}"


def outlook(run: Run, now: float) -> str:
    """Return the number of failed jobs, of jobs that therefore cannot run, and the time left."""
    counts = ((len(run.jobs_in(FAILED)), "failed"), (len(run.blocked()), "cannot run"))
    failures = [f"{count} {what}" for count, what in counts if count]
    return ", ".join([*failures, f"{format_estimate(run.time_left(now))} left"])


def picture(run: Run, begin: float) -> Group:
    """Return a line for each stage, one for all jobs with the time left, and the jobs that have run for long."""
    now, table = time.monotonic(), Table.grid(padding=(0, 1))
    stages = run.stages(now)
    for stage in stages:
        is_all = stage is stages[-1]
        running = f"{stage.counts[RUNNING]} running" if stage.counts[RUNNING] and not is_all else ""
        words = stage.name, f"{stage.counts[DONE]} of {stage.jobs}", running
        name, *cells = (Text(word, "bold" if running or is_all else "dim") for word in words)
        table.add_row(name, ProgressBar(stage.work, stage.work_done, BAR_WIDTH), *cells)
    table.columns[-2].justify = "right"
    so_far = f"{outlook(run, now)}, {format_elapsed(now - begin)} so far"
    lines = [(so_far, "bold red" if run.jobs_in(FAILED) else "bold")]
    jobs = sorted(run.jobs_in(RUNNING), key=lambda job: (job.begin, job.name))[:LONG_JOBS]
    for job in (job for job in jobs if now - job.begin > LONG_JOB):
        done = f", {int(100 * share)} % done" if (share := progress_of(job.log, job.since)) else ""
        lines.append((f"{job.message or job.name}: {format_elapsed(now - job.begin)}{done}", "dim"))
    return Group(table, *(Text(*line, no_wrap=True, overflow="ellipsis") for line in lines))
