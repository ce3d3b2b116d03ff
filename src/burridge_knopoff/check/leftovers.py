"""Files of a study that are missing, and files left over from an earlier config, by their names."""

from __future__ import annotations

import re
from collections.abc import Iterator
from pathlib import Path

from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.jobs.rule import Rule, Wildcards


def leftovers(results: Path, jobs: Jobs) -> list[Path]:
    """Return results, logs and benchmarks of jobs that the study no longer has."""
    point = jobs.study.point_file.removesuffix(".nc")
    patterns: list[str] = []
    known: set[str] = set()
    for rule in jobs.rules.values():
        for form in (*rule.files, f"logs/{rule.log_name}.log", f"benchmarks/{rule.log_name}.tsv"):
            # A point of another config may have other parameters.
            patterns.append(jobs.pattern(form.replace(point, "{law}/{initial}/{values}")))
            known.update(form.format(**job) for job in rule.each if rule.name in jobs.existing)
    # Each pattern has groups of the same names.
    pattern, whole = re.compile(re.sub(r"\?P<\w+>", "?:", "|".join(patterns))), results.resolve()
    names = {path: path.relative_to(results).as_posix() for path in sorted(results.rglob("*"))}
    return [
        path
        for path, name in names.items()
        if pattern.fullmatch(name)
        and name not in known
        # The target of a link does not belong to the study.
        and path.resolve() == whole / name
        and path.is_file()
    ]


def missing_files(results: Path, jobs: Jobs) -> dict[str, Path]:
    """Return {name: log} of the missing files, except those of runs, whose job has started.

    The job of a file without a log was not requested yet, or waits for other missing files.
    """
    logs = {name: results / log_path(*made) for name, made in jobs.all_files.items()}
    return {name: log for name, log in logs.items() if log.exists() and not (results / name).exists()}


def log_path(rule: Rule, job: Wildcards) -> str:
    """Return the log of a job."""
    return f"logs/{rule.log_name}.log".format(**job)


def run_files(jobs: Jobs) -> Iterator[tuple[str, Wildcards, str]]:
    """Yield the point file of each run, its wildcards, and its log."""
    for rule in jobs.runs():
        for job in rule.each:
            yield rule.files[0].format(**job), job, log_path(rule, job)


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study and the folders that become empty; raises OSError if a file cannot be deleted."""
    for path in paths:
        path.unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
