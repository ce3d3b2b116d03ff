"""Files of a study that are missing, and files left over from an earlier config, by the record of its runs."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.check.file_names import is_of_workflow
from burridge_knopoff.study.study import Study, run_files


def run_logs(study: Study) -> dict[str, str]:
    """Return {point file: log of the job that simulates it alone}, by their names in the results."""
    folders = {"points": "simulate", "solvers": "simulate_solver"}
    parts = ((name, *name.partition("/")[::2]) for name in run_files(study))
    return {name: f"logs/{folders[folder]}/{rest.removesuffix('.nc')}.log" for name, folder, rest in parts}


def leftovers(results: Path, study: Study, record: Mapping[str, Any]) -> list[Path]:
    """Return results, logs and benchmarks of jobs that the study no longer has; record : of its last run.

    Files of other names than those of the workflow are never among them, nor are files that a link leads to. There are
    none by a record of an earlier version, which lists no files.
    """
    if not record["files"]:
        return []
    files, whole = {**record["files"], **run_logs(study)}, results.resolve()
    expected_names = {*files, *_logs(files.values())}
    names = {path: path.relative_to(results).as_posix() for path in sorted(results.rglob("*"))}
    return [
        path
        for path, name in names.items()
        if name not in expected_names
        and is_of_workflow(name)
        # The target of a link does not belong to the study.
        and path.resolve() == whole / name
        and path.is_file()
    ]


def _logs(logs: Iterable[str]) -> set[str]:
    """Return logs, and the benchmarks of the same jobs."""
    names = set(logs)
    return names | {f"benchmarks{log.removeprefix('logs').removesuffix('.log')}.tsv" for log in names}


def missing_files(results: Path, record: Mapping[str, Any]) -> dict[str, Path]:
    """Return {name: log} of the missing files, except those of runs, whose job has started; record : of the last run.

    The job of a file without a log was not requested yet, or waits for other missing files.
    """
    logs = {name: results / log for name, log in record["files"].items()}
    return {name: log for name, log in logs.items() if log.exists() and not (results / name).exists()}


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study and the folders that become empty; raises OSError if a file cannot be deleted."""
    for path in paths:
        path.unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
