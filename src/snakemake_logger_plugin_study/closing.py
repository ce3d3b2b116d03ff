"""The last words of a run: what was made, where, how long it took, what it says, and what failed."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Sequence
from pathlib import Path

import numpy as np

from burridge_knopoff.claims.formats import group_untestable
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, READING
from burridge_knopoff.study.formatting import counted
from burridge_knopoff.study.job_log import failure, interrupted, remedies
from snakemake_logger_plugin_study.display import elapsed
from snakemake_logger_plugin_study.run import DONE, FAILED, Run

#: Names in a line, failed jobs with a line each, and files that are named one by one, at most.
MOST_NAMES, MOST_FAILED, FEW_FILES = 8, 10, 3


def closing_lines(run: Run, seconds: float, *, stopped: bool = False) -> list[str]:
    """Return the last lines of a run that took so many seconds.

    stopped : whether Snakemake ended with an error, as after a signal that came when the last job was done
    """
    results, ended, done = Path(run.results), run.of(FAILED), run.of(DONE)
    missed = len(run.jobs) - len(ended) - len(done)
    failed = [job for job in ended if not interrupted(job.log, stopping=run.stopping)]
    made = _made(results, [path for job in done for path in job.output])
    if ended or missed or stopped:
        counts = ((len(failed), "failed"), (len(ended) - len(failed), "interrupted"), (missed, "did not run"))
        reasons = ", ".join(f"{counted(count, 'job')} {what}" for count, what in counts if count)
        told = sorted((job.name, job.log) for job in failed)
        return [
            f"study {results.name}: stopped after {elapsed(seconds)}: {reasons or 'not at its end'}",
            *(failure(*job) for job in told[:MOST_FAILED]),
            *([f"failed: and {len(told) - MOST_FAILED} more"] if len(told) > MOST_FAILED else []),
            made,
            *(_continuing(remedies(path for job in failed for path in job.log))),
        ]
    lines = [f"study {results.name}: done in {elapsed(seconds)}", made]
    # Older summaries say nothing about the run.
    for rule, (name, read) in _READERS.items():
        if rule in run.wanted:
            try:
                lines += read(results / name)
            except Exception as error:
                lines.append(f"{results / name}: cannot be read ({error})")
    return lines


def _continuing(remedies: Sequence[str]) -> list[str]:
    """Return how to continue: the command of the run would stop at the same bad files again."""
    if not remedies:
        return ["the same command goes on where this run stopped"]
    return [f"this command recreates the bad files and continues: {command}" for command in remedies]


def _made(results: Path, made: Sequence[str]) -> str:
    if len(made) <= FEW_FILES:
        return f"made: {', '.join(made) or 'nothing'}"
    inside = [Path(path).relative_to(results).parts for path in made if Path(path).is_relative_to(results)]
    folders = Counter(parts[0] for parts in inside if len(parts) > 1)
    names = [parts[0] for parts in inside if len(parts) == 1]
    return f"files made in {results}: {', '.join([*(f'{name} {count}' for name, count in folders.items()), *names])}"


def _claims(path: Path) -> list[str]:
    read = json.loads(path.read_text(encoding="utf-8"))
    ledger, reasons = path.with_suffix(".md"), group_untestable(read["claims"])
    if list(reasons.values()) == [read["claims"]]:
        return [f"claims of the paper: none is judged ({ledger})", f"  {next(iter(reasons))}"]
    independent = read["independent_counts"]
    counts = ", ".join(f"{verdict} {count}" for verdict, count in independent.items())
    lines = [f"claims of the paper, {sum(independent.values())} independent ones: {counts} ({ledger})"]
    for verdict in (FAILS, CONVENTION, READING):
        names = [claim["name"] for claim in read["claims"] if claim["verdict"] == verdict]
        more = f" and {len(names) - MOST_NAMES} more" if len(names) > MOST_NAMES else ""
        lines += [f"  {verdict}: {', '.join(names[:MOST_NAMES])}{more}"] if names else []
    return lines


def _flags(path: Path, name: str) -> Counter[str]:
    """Return how often each meaning of a flag variable occurs."""
    import netCDF4

    with netCDF4.Dataset(path) as dataset:
        dataset.set_auto_mask(False)
        variable = dataset[name]
        meanings = dict(zip(np.atleast_1d(variable.flag_values), variable.flag_meanings.split(), strict=True))
        return Counter(meanings[value] for value in variable[:].flat)


def _incomplete(path: Path, what: str = "points") -> list[str]:
    counts = _flags(path, "status")
    total, completed = counts.total(), counts.pop("completed", 0)
    reasons = ", ".join(f"{name} {count}" for name, count in sorted(counts.items()))
    words = f"{total - completed} of {total} did not complete: {reasons} (status in {path})"
    return [f"{what}: {words if reasons else f'all {total} completed'}"]


def _catalogues(path: Path) -> list[str]:
    import netCDF4

    with netCDF4.Dataset(path) as dataset:
        count = np.asarray(dataset["event_count"][:])
    empty = int((count == 0).sum())
    words = f"catalogues: {empty} of {count.size} without events (event_count in {path})"
    return [*_incomplete(path, "catalogues"), *([words] if empty else [])]


def _undetermined(path: Path, kind: str = "kind") -> list[str]:
    counts = _flags(path, kind)
    said = f"kind of motion undetermined at {counts['undetermined']} of {counts.total()} ({kind} in {path})"
    return [f"points: {said}"] if counts["undetermined"] else []


#: {rule: (its file below results, the lines about it)}
_READERS: dict[str, tuple[str, Callable[[Path], list[str]]]] = {
    "claims": ("summary/claims.json", _claims),
    "mean_distance": ("summary/mean_distance.nc", _incomplete),
    "grid": ("summary/grid.nc", lambda path: [*_incomplete(path), *_undetermined(path, "run_kind")]),
    "agreement": ("summary/agreement.nc", _undetermined),
    "catalogue": ("summary/catalogue.nc", _catalogues),
    "report": ("report.html", lambda path: [f"report: {path}"]),
}
