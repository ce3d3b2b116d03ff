"""Files of a study that are missing, and files left over from an earlier config."""

from __future__ import annotations

import re
from contextlib import suppress
from pathlib import Path

import netCDF4

from burridge_knopoff.dataset.variables import NETCDF_LOCK
from burridge_knopoff.outputs import benchmark_of, job_log, study_files
from burridge_knopoff.provenance.files import check_regular
from burridge_knopoff.provenance.origin import Origin, embedded_origin
from burridge_knopoff.provenance.record import NAME
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.study import Study, run_files

#: Suffixes of the files that name their place themselves. A file with another suffix belongs to one of these that
#: differs in the suffix alone.
_RECORDED = (".nc", ".png", ".json", ".html")
_RUN = re.compile(r"(?:points|solvers/\w+)/(?P<law>[^/]+)/(?P<initial>[^/]+)/(?P<values>[^/]+)\.nc")
_NUMBER = re.compile(rf"([A-Za-z]\w*?)_?({VALUE})(?:_|$)")


def run_logs(study: Study) -> dict[str, str]:
    """Return {point file: log of the job that simulates it alone}, by their names in the results."""
    return {name: job_log(name) for name in run_files(study)}


def file_logs(study: Study) -> dict[str, str]:
    """Return {file of a study, except point files: log of its job}, by their names in the results."""
    return {name: file.log for name, file in study_files(study).items()}


def leftovers(results: Path, study: Study) -> list[Path]:
    """Return the results that jobs of an earlier config have left, with their logs and benchmarks.

    Each result says itself that it was made for its place, so that no copy under another name is among them, nor a file
    that a link leads to.
    """
    logs, whole = {**file_logs(study), **run_logs(study)}, results.resolve()
    others = {
        path: log
        for path in results.rglob("*")
        if (name := path.relative_to(results).as_posix()) not in logs
        and (log := job_log(name))
        and path.resolve() == whole / name
        and path.is_file()
    }
    made = {path for path in others if _names_place(path, path.relative_to(results).as_posix())}
    made |= {path for path in others if any(path.with_suffix(suffix) in made for suffix in _RECORDED)}
    unused = {others[path] for path in made} - {*logs.values()}
    made |= {results / name for log in unused for name in (log, benchmark_of(log)) if (results / name).is_file()}
    return sorted(made)


def _names_place(path: Path, name: str) -> bool:
    """Return whether a file records that it was made as the file of this name in the results of a study."""
    # Whatever netCDF4 and others make of overwritten bytes.
    with suppress(OSError, RuntimeError, SyntaxError, TypeError, ValueError, AttributeError, LookupError):
        if path.suffix != ".nc":
            return Origin(**embedded_origin(path)).file == name
        with NETCDF_LOCK, netCDF4.Dataset(path) as dataset:
            origin = Origin.from_attributes(vars(dataset))
            return origin.file == name if origin else _is_run(dataset, name)
    return False


def _is_run(dataset: netCDF4.Dataset, name: str) -> bool:
    """Return whether a point file holds the run that its name describes."""
    run = _RUN.fullmatch(name)
    if not run or (dataset.law, dataset.initial) != (run["law"], run["initial"]):
        return False
    numbers = {parameter: text for parameter, text in _NUMBER.findall(run["values"]) if parameter in dataset.variables}
    return all(
        f"{float(dataset[parameter][...]):.{len(text.partition('.')[2])}f}" == text
        for parameter, text in numbers.items()
    )


def check_places(results: Path, study: Study) -> None:
    """Refuse folders, named pipes and the like in place of the files, logs and benchmarks of a study.

    Snakemake takes a folder for a result, and its threads wait for the reader of a pipe.

    Raises OSError, one line.
    """
    logs = {**file_logs(study), **run_logs(study)}
    for name in (NAME, *logs, *logs.values(), *map(benchmark_of, logs.values())):
        try:
            check_regular(results / name)
        except OSError as error:
            raise OSError(f"{results / name}: {error.strerror}, expected a file or nothing: remove it") from None


def missing_files(results: Path, study: Study) -> dict[str, Path]:
    """Return {name: log} of the missing files, except those of runs, whose job has started.

    The job of a file without a log was not requested yet, or waits for other missing files.
    """
    logs = {name: results / log for name, log in file_logs(study).items()}
    return {name: log for name, log in logs.items() if log.exists() and not (results / name).is_file()}
