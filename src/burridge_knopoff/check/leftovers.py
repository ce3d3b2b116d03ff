"""Files of a study that are missing, and files left over from an earlier config."""

from __future__ import annotations

from pathlib import Path

from burridge_knopoff.check.file_names import is_of_workflow
from burridge_knopoff.outputs import benchmark_of, log_of, study_files
from burridge_knopoff.study.study import Study, run_files


def run_logs(study: Study) -> dict[str, str]:
    """Return {point file: log of the job that simulates it alone}, by their names in the results."""
    return {name: log_of(name) for name in run_files(study)}


def file_logs(study: Study) -> dict[str, str]:
    """Return {file of a study, except point files: log of its job}, by their names in the results."""
    return {name: file.log for name, file in study_files(study).items()}


def leftovers(results: Path, study: Study) -> list[Path]:
    """Return results, logs and benchmarks of jobs that a study does not have.

    Files of other names than those of the workflow are never among them, nor are files that a link leads to.
    """
    logs, whole = {**file_logs(study), **run_logs(study)}, results.resolve()
    expected_names = {*logs, *logs.values(), *map(benchmark_of, logs.values())}
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


def missing_files(results: Path, study: Study) -> dict[str, Path]:
    """Return {name: log} of the missing files, except those of runs, whose job has started.

    The job of a file without a log was not requested yet, or waits for other missing files.
    """
    logs = {name: results / log for name, log in file_logs(study).items()}
    return {name: log for name, log in logs.items() if log.exists() and not (results / name).exists()}


def delete(results: Path, paths: list[Path]) -> None:
    """Delete files of a study and the folders that become empty; raises OSError if a file cannot be deleted."""
    for path in paths:
        path.unlink(missing_ok=True)
        for folder in path.parents:
            if folder == results or any(folder.iterdir()):
                break
            folder.rmdir()
