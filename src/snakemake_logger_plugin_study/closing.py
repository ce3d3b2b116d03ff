"""The closing lines of a run: what it made, where, how long it took, its main results, and what failed."""

from __future__ import annotations

import json
import os
from collections import Counter, defaultdict
from collections.abc import Callable, Sequence
from functools import partial
from pathlib import Path

from burridge_knopoff.dataset.decoding import decode_flags
from burridge_knopoff.dataset.variables import NETCDF_LOCK
from burridge_knopoff.messages import command
from burridge_knopoff.provenance.record import NAME, remake_command
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import SILENT, bad_files, failure_line, failure_reason, is_interrupted
from snakemake_logger_plugin_study.command_line import without_force
from snakemake_logger_plugin_study.display import format_elapsed
from snakemake_logger_plugin_study.run import DONE, FAILED, Job, Run

#: Largest numbers of lines about failures, and of files that are named one by one.
MOST_FAILURES, FEW_FILES = 10, 3


def closing_lines(run: Run, seconds: float, stopped: bool, arguments: Sequence[str]) -> list[str]:
    """Return the last lines of a run that took so many seconds.

    stopped : whether Snakemake ended with an error, as after a signal that came when the last job was done
    arguments : of its command line
    """
    results, ended, done = Path(run.results), run.jobs_in(FAILED), run.jobs_in(DONE)
    missed = len(run.jobs) - len(ended) - len(done)
    # Ctrl-C ends all jobs, some before their log has a word.
    stopping = any(is_interrupted(job.log) for job in ended)
    failed = [job for job in ended if not is_interrupted(job.log, stopping=stopping)]
    # A workflow that imports the study makes other files too.
    paths = [Path(path) for job in done for path in job.output if Path(path).is_relative_to(results)]
    folders = Counter(path.relative_to(results).parts[0] for path in paths)
    counts = ", ".join(name if "." in name else f"{name} {count}" for name, count in folders.items())
    is_few = len(paths) <= FEW_FILES
    made = f"made: {', '.join(map(str, paths)) or 'nothing'}" if is_few else f"files made in {results}: {counts}"
    if ended or missed or stopped:
        ends = ((len(failed), "failed"), (len(ended) - len(failed), "interrupted"), (missed, "did not run"))
        reasons = ", ".join(f"{format_count(count, 'job')} {what}" for count, what in ends if count)
        last = f"study {results.name}: stopped after {format_elapsed(seconds)}: {reasons or 'before its end'}"
        return [last, *_failures(failed), made, *_remedies(results, failed, arguments)]
    if run.touching:
        check = command("bk", "check", results)
        return [f"study {results.name}: its files are marked as up to date; {check} says whether they are"]
    lines = [f"study {results.name}: done in {format_elapsed(seconds)} {run.capacity}", made]
    # Older summaries say nothing about the run.
    for rule, (name, read) in _READERS.items():
        if rule in run.wanted:
            try:
                lines.append(read(results / name))
            except Exception as error:
                lines.append(f"{results / name}: cannot be read ({error})")
    return lines


def _failures(failed: Sequence[Job]) -> list[str]:
    """Return a line for each reason why jobs failed, with the first of these jobs, and for each job without reason."""
    alike: dict[str, list[Job]] = defaultdict(list)
    for job in sorted(failed, key=lambda job: job.name):
        reason = failure_reason(job.log)
        alike[job.name if reason == SILENT else reason].append(job)
    lines = [
        failure_line(f"{first.name}{f' and {len(others)} more' if others else ''}", first.log)
        for first, *others in alike.values()
    ]
    count = len(lines) - MOST_FAILURES
    return [*lines[:MOST_FAILURES], *[f"failed: {count} more"] * (count > 0)]


def _remedies(results: Path, failed: Sequence[Job], arguments: Sequence[str]) -> list[str]:
    """Return how to continue; the command of the run helps only if it would not fail again."""
    # A log may be that of whoever sent the results.
    files = [file for file in bad_files(path for job in failed for path in job.log) if _is_in(results, file)]
    if files:
        remake = remake_command(results / NAME, *files, is_own_run=True)
        return [f"this command recreates the bad files and continues: {remake}"]
    if all(failure_reason(job.log) == SILENT for job in failed):
        if (words := without_force(arguments)) == [*arguments]:
            return ["Run the same command again to continue."]
        rest = command("snakemake", *words)
        return [f"The same command would start all over; this one makes what is missing or out of date: {rest}"]
    return ["Finished results are kept; the same command would fail again until the cause is removed."]


def _is_in(results: Path, file: str) -> bool:
    """Return whether a file is in the results, by its path from the folder in which Snakemake runs."""
    return Path(os.path.normpath(file)).is_relative_to(results)


def _verdicts(path: Path) -> str:
    independent = json.loads(path.read_text(encoding="utf-8"))["independent_counts"]
    counts = ", ".join(f"{verdict} {count}" for verdict, count in independent.items())
    return f"{sum(independent.values())} independent claims of the paper: {counts} ({path.with_suffix('.md')})"


def _flags(path: Path, what: str, name: str) -> str:
    """Return how often each meaning of a flag variable of a summary occurs."""
    import xarray

    with NETCDF_LOCK, xarray.open_dataset(path) as dataset:
        counts = Counter(decode_flags(dataset[name]).values.flat)
    return f"{what}: {', '.join(f'{word} {count}' for word, count in counts.most_common())} ({name} in {path})"


#: {rule: (its file in the results, function that returns a line about it)}
_READERS: dict[str, tuple[str, Callable[[Path], str]]] = {
    "claims": ("summary/claims.json", _verdicts),
    "mean_distance": ("summary/mean_distance.nc", partial(_flags, what="points", name="status")),
    "agreement": ("summary/agreement.nc", partial(_flags, what="motion of the points", name="kind")),
    "catalogue": ("summary/catalogue.nc", partial(_flags, what="catalogues", name="status")),
    "report": ("report.html", "report: {}".format),
}
