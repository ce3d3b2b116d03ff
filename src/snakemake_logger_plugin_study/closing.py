"""The closing lines of a run: what it made, where, how long it took, its main results, and what failed."""

from __future__ import annotations

import json
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from burridge_knopoff.claims.formats import group_untestable
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, READING
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import SILENT, failure_line, failure_reason, is_interrupted, remedies
from snakemake_logger_plugin_study.display import format_elapsed
from snakemake_logger_plugin_study.run import DONE, FAILED, Job, Run

#: Largest numbers of names in a line, of lines about failures, and of files that are named one by one.
MOST_NAMES, MOST_FAILURES, FEW_FILES = 8, 10, 3


def closing_lines(run: Run, seconds: float, *, stopped: bool = False) -> list[str]:
    """Return the last lines of a run that took so many seconds.

    stopped : whether Snakemake ended with an error, as after a signal that came when the last job was done
    """
    results, ended, done = Path(run.results), run.jobs_in(FAILED), run.jobs_in(DONE)
    missed = len(run.jobs) - len(ended) - len(done)
    failed = [job for job in ended if not is_interrupted(job.log, stopping=run.stopping)]
    files_line = _made_files(results, [path for job in done for path in job.output])
    if ended or missed or stopped:
        counts = ((len(failed), "failed"), (len(ended) - len(failed), "interrupted"), (missed, "did not run"))
        reasons = ", ".join(f"{format_count(count, 'job')} {what}" for count, what in counts if count)
        return [
            f"study {results.name}: stopped after {format_elapsed(seconds)}: {reasons or 'before its end'}",
            *_failures(failed),
            files_line,
            *_remedies(failed),
        ]
    if run.touching:
        return _touched(results, [path for job in done for path in job.output])
    lines = [f"study {results.name}: done in {format_elapsed(seconds)} {run.capacity}", files_line]
    # Older summaries say nothing about the run.
    for rule, (name, read) in _READERS.items():
        if rule in run.wanted:
            try:
                lines += read(results / name)
            except Exception as error:
                lines.append(f"{results / name}: cannot be read ({error})")
    return lines


def _failures(failed: Sequence[Job]) -> list[str]:
    """Return a line for each reason why jobs failed, with the first of these jobs and its log."""
    alike: dict[str, list[Job]] = defaultdict(list)
    for job in sorted(failed, key=lambda job: job.name):
        alike[failure_reason(job.log)].append(job)
    lines = []
    for first, *others in list(alike.values())[:MOST_FAILURES]:
        lines.append(failure_line(f"{first.name}{f' and {len(others)} more' if others else ''}", first.log))
    count = len(alike) - MOST_FAILURES
    return [*lines, f"failed: for {count} more reasons"] if count > 0 else lines


def _remedies(failed: Sequence[Job]) -> list[str]:
    """Return how to continue; the command of the run helps only if it would not fail again."""
    if commands := remedies(path for job in failed for path in job.log):
        return [f"this command recreates the bad files and continues: {command}" for command in commands]
    if all(failure_reason(job.log) == SILENT for job in failed):
        return ["Run the same command again to continue."]
    return ["Finished results are kept; the same command would fail again until the cause is removed."]


def _touched(results: Path, paths: Sequence[str]) -> list[str]:
    """Return what `snakemake --touch` did: it sets the times of files that exist, and makes none."""
    missing = [path for path in paths if not Path(path).exists()]
    what = "no file needed touching"
    if touched := len(paths) - len(missing):
        what = f"{format_count(touched, 'file')} marked as up to date, whatever their content"
    lines = [f"study {results.name}: {what}; bk check {results} says whether they are"]
    if missing:
        lines.append(f"not made yet, and left so: {_listed(results, missing)}; run the command without --touch")
    return lines


def _made_files(results: Path, paths: Sequence[str]) -> str:
    if len(paths) <= FEW_FILES:
        return f"made: {_listed(results, paths)}"
    return f"files made in {results}: {_listed(results, paths)}"


def _listed(results: Path, paths: Sequence[str]) -> str:
    """Return a few files by name, and more by the number in each folder."""
    if len(paths) <= FEW_FILES:
        return ", ".join(paths) or "nothing"
    inside = [Path(path).relative_to(results).parts for path in paths if Path(path).is_relative_to(results)]
    folders = Counter(parts[0] for parts in inside if len(parts) > 1)
    names = [parts[0] for parts in inside if len(parts) == 1]
    return ", ".join([*(f"{name} {count}" for name, count in folders.items()), *names])


def _verdicts(path: Path) -> list[str]:
    read = json.loads(path.read_text(encoding="utf-8"))
    ledger, reasons = path.with_suffix(".md"), group_untestable(read["claims"])
    if list(reasons.values()) == [read["claims"]]:
        return [f"no claim of the paper could be tested ({ledger})", f"  {next(iter(reasons))}"]
    independent = read["independent_counts"]
    counts = ", ".join(f"{verdict} {count}" for verdict, count in independent.items())
    lines = [f"{sum(independent.values())} independent claims of the paper: {counts} ({ledger})"]
    for verdict in (FAILS, CONVENTION, READING):
        names = [claim["name"] for claim in read["claims"] if claim["verdict"] == verdict and not claim["depends_on"]]
        suffix = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        lines += [f"  {verdict}: {', '.join(names[:MOST_NAMES])}{suffix}"] if names else []
    return lines


def _flag_counts(path: Path, name: str) -> Counter[str]:
    """Return how often each meaning of a flag variable occurs."""
    import netCDF4

    with netCDF4.Dataset(path) as dataset:
        dataset.set_auto_mask(False)
        variable = dataset[name]
        meanings = dict(zip(np.atleast_1d(variable.flag_values), variable.flag_meanings.split(), strict=True))
        return Counter(meanings[value] for value in variable[:].flat)


def _completion(path: Path, what: str = "points") -> list[str]:
    counts = _flag_counts(path, "status")
    total, completed = counts.total(), counts.pop("completed", 0)
    reasons = ", ".join(f"{name} {count}" for name, count in sorted(counts.items()))
    words = f"{total - completed} of {total} did not complete: {reasons} (status in {path})"
    return [f"{what}: {words if reasons else f'all {total} completed'}"]


def _catalogues(path: Path) -> list[str]:
    import xarray

    from burridge_knopoff.summaries.catalogue import empty_catalogues

    with xarray.open_dataset(path) as summary:
        words = empty_catalogues(summary)
    return [*_completion(path, "catalogues"), *([f"catalogues: {words} (event_count in {path})"] if words else [])]


def _undetermined(path: Path, kind: str = "kind") -> list[str]:
    counts = _flag_counts(path, kind)
    count = counts["undetermined"]
    return [f"points: kind of motion undetermined at {count} of {counts.total()} ({kind} in {path})"] if count else []


def _undetermined_runs(path: Path) -> list[str]:
    """Return the number of runs of undetermined kind over several parameters; agreement.nc has those over a."""
    import netCDF4

    with netCDF4.Dataset(path) as dataset:
        over_several = dataset["run_kind"].ndim > 3
    return _undetermined(path, "run_kind") if over_several else []


#: {rule: (its file in the results, function that returns the lines about it)}
_READERS: dict[str, tuple[str, Callable[[Path], list[str]]]] = {
    "claims": ("summary/claims.json", _verdicts),
    "mean_distance": ("summary/mean_distance.nc", _completion),
    "lyapunov": ("summary/lyapunov.nc", _undetermined_runs),
    "agreement": ("summary/agreement.nc", _undetermined),
    "catalogue": ("summary/catalogue.nc", _catalogues),
    "report": ("report.html", lambda path: [f"report: {path}"]),
}
