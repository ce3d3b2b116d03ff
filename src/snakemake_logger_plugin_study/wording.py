"""The words of the progress display."""

from __future__ import annotations

from collections.abc import Mapping

from snakemake_logger_plugin_study.tally import Tally, TimeLeft


def duration(seconds: float) -> str:
    """Return a duration no more precise than an estimate is: 40 s, 3 min, 2.5 h."""
    if seconds < 10:
        return "a few seconds"
    if seconds < 55:
        return f"{round(seconds, -1):.0f} s"
    if seconds < 90 * 60:
        return f"{max(round(seconds / 60), 1)} min"
    return f"{seconds / 3600:.1f} h"


def time_left(left: TimeLeft | None) -> str:
    """Return how long a run still takes, or "" if nothing is known; "at least" if a part of it is unknown."""
    if left is None:
        return ""
    if not left.complete:
        return f"at least {duration(left.seconds)} left"
    words = duration(left.seconds)
    return f"{words} left" if left.seconds < 10 else f"about {words} left"


def percentage(done: int, total: int) -> int:
    """Return the whole percents done, 100 only if all is."""
    return 100 * done // total if total else 100


def failures(tally: Tally) -> str:
    """Return how many jobs failed and how many cannot run for that, or ""."""
    if not tally.failed:
        return ""
    return f"{tally.failed} failed" + (f", {tally.blocked} cannot run" if tally.blocked else "")


def progress_line(tally: Tally, now: float) -> str:
    """Return one line: the stages at work, all jobs, the time left."""
    total = tally.total()
    parts = [f"{stage.name} {stage.done} of {stage.total}" for stage in tally.stages() if stage.running]
    parts.append(f"all {total.done} of {total.total} ({percentage(total.done, total.total)} %)")
    parts += [words for words in (failures(tally), time_left(tally.time_left(now))) if words]
    return ", ".join(parts)


def job_name(rule: str, wildcards: Mapping[str, object]) -> str:
    """Return the rule and the wildcards of a job: simulate law=linearized initial=plus a=0.0800."""
    return " ".join([rule, *(f"{name}={value}" for name, value in wildcards.items())])
