"""The words of the progress display."""

from __future__ import annotations

from collections.abc import Mapping

from burridge_knopoff.study.words import counted
from snakemake_logger_plugin_study.forecast import Cost
from snakemake_logger_plugin_study.tally import FAILED, Tally


def duration(seconds: float) -> str:
    """Return a duration no more precise than an estimate is: 40 s, 3 min, 2.5 h."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 55:
        return f"{round(seconds, -1):.0f} s"
    if seconds < 90 * 60:
        return f"{max(round(seconds / 60), 1)} min"
    return f"{seconds / 3600:.1f} h"


def elapsed(seconds: float) -> str:
    """Return a duration as 12 s, 5 min 12 s or 2 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def time_left(seconds: float | None) -> str:
    """Return how long a run still takes, or "" if it is not known."""
    return "" if seconds is None else f"{about(seconds)} left"


def about(seconds: float) -> str:
    """Return an estimated duration: about 3 min, a few seconds."""
    return duration(seconds) if seconds < 10 else f"about {duration(seconds)}"


def cost(forecast: Cost, cores: int) -> str:
    """Return what a run would cost in a line."""
    return (
        f"a run takes {about(forecast.seconds)} on {counted(cores, 'core')}: {about(forecast.cpu)} of CPU time, "
        f"and {size(forecast.size)} of disk"
    )


def size(number: float) -> str:
    """Return a number of bytes: 40 MB, 1.2 GB."""
    return f"{number / 1e9:.1f} GB" if number >= 1e9 else f"{max(round(number / 1e6), 1)} MB"


def failures(tally: Tally) -> str:
    """Return how many jobs failed and how many cannot run for that, or ""."""
    failed, blocked = len(tally.jobs(FAILED)), sum(tally.blocked().values())
    return f"{failed} failed" + (f", {blocked} cannot run" if blocked else "") if failed else ""


def progress_line(tally: Tally, now: float) -> str:
    """Return one line: the stages at work, all jobs, the time left."""
    *stages, total = tally.counts()
    percent = 100 * total.done // total.total if total.total else 100
    parts = [f"{stage.name} {stage.done} of {stage.total}" for stage in stages if stage.running]
    parts.append(f"all {total.done} of {total.total} ({percent} %)")
    parts += [words for words in (failures(tally), time_left(tally.time_left(now))) if words]
    return ", ".join(parts)


def job_name(rule: str, wildcards: Mapping[str, object]) -> str:
    """Return the rule and the wildcards of a job: simulate law=linearized initial=plus a=0.0800."""
    return " ".join([rule, *(f"{name}={value}" for name, value in wildcards.items())])
