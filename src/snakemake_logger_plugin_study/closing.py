"""The last words of a run: what was made, where, how long it took, what it says, and what failed."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

import numpy as np

from burridge_knopoff.claims.verdict import CONVENTION, FAILS, untestable
from burridge_knopoff.study.job_log import failure
from burridge_knopoff.study.words import counted
from snakemake_logger_plugin_study.tally import DONE, FAILED, Tally
from snakemake_logger_plugin_study.wording import elapsed

#: Verdicts whose claims are named, not only counted.
NAMED_VERDICTS = (FAILS, CONVENTION)
#: Names in a line, and failed jobs with a line each, at most.
MOST_NAMES, MOST_FAILED = 8, 10
#: So few files are named one by one.
FEW_FILES = 3


def closing_lines(
    results: str | Path, seconds: float, tally: Tally, wanted: Collection[str], *, stopped: bool = False
) -> list[str]:
    """Return the last lines of a run, plain text.

    results : folder of the study, results/<study>
    seconds : how long the run took
    wanted : rules of all files that the run was to make or found up to date
    stopped : whether Snakemake ended with an error, as after a signal that came when the last job was done

    Summaries are read only if they are wanted and all jobs were done: older ones say nothing about the run. A file that
    cannot be read gives a line that says so.
    """
    results = Path(results)
    failed, done = tally.jobs(FAILED), tally.jobs(DONE)
    missed = tally.counts()[-1].total - len(failed) - len(done)
    made = _made(results, [path for job in done for path in job.output])
    if failed or missed or stopped:
        counts = ((len(failed), "failed"), (missed, "did not run"))
        reasons = [f"{counted(count, 'job')} {what}" for count, what in counts if count]
        lines = [f"study {results.name}: stopped after {elapsed(seconds)}: {', '.join(reasons) or 'not at its end'}"]
        told = sorted((job.name, job.log) for job in failed)
        lines += [failure(*job) for job in told[:MOST_FAILED]]
        if len(told) > MOST_FAILED:
            lines.append(f"failed: and {len(told) - MOST_FAILED} more")
        return [*lines, made, "the same command goes on where this run stopped"]
    lines = [f"study {results.name}: done in {elapsed(seconds)}", made]
    for rule, (name, read) in _READERS.items():
        path = results / name
        if rule in wanted:
            try:
                lines += read(path)
            except (OSError, RuntimeError, ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
                lines.append(f"{path}: cannot be read ({error})")
    return lines


def _made(results: Path, made: Sequence[str]) -> str:
    if len(made) <= FEW_FILES:
        return f"made: {', '.join(made) or 'nothing'}"
    inside = [Path(path).relative_to(results).parts for path in made if Path(path).is_relative_to(results)]
    folders = Counter(parts[0] for parts in inside if len(parts) > 1)
    names = [parts[0] for parts in inside if len(parts) == 1]
    return f"files made in {results}: {', '.join([*(f'{name} {folders[name]}' for name in folders), *names])}"


def _claims(path: Path) -> list[str]:
    read = json.loads(path.read_text(encoding="utf-8"))
    ledger, reasons = path.with_suffix(".md"), untestable(read["claims"])
    if list(reasons.values()) == [read["claims"]]:
        return [f"claims of the paper: none is judged ({ledger})", f"  {next(iter(reasons))}"]
    counts = ", ".join(f"{verdict} {count}" for verdict, count in read["counts"].items())
    lines = [f"claims of the paper: {counts} ({ledger})"]
    for verdict in NAMED_VERDICTS:
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


def _incomplete(path: Path) -> list[str]:
    counts = _flags(path, "status")
    total, completed = counts.total(), counts.pop("completed", 0)
    if completed == total:
        return [f"points: all {total} completed"]
    reasons = ", ".join(f"{name} {count}" for name, count in sorted(counts.items()))
    return [f"points: {total - completed} of {total} did not complete: {reasons} (status in {path})"]


def _undetermined(path: Path) -> list[str]:
    counts = _flags(path, "kind")
    said = f"kind of motion undetermined at {counts['undetermined']} of {counts.total()} (kind in {path})"
    return [f"points: {said}"] if counts["undetermined"] else []


#: {rule: (its file below results, the lines about it)}
_READERS: dict[str, tuple[str, Callable[[Path], list[str]]]] = {
    "claims": ("summary/claims.json", _claims),
    "mean_distance": ("summary/mean_distance.nc", _incomplete),
    "lyapunov": ("summary/lyapunov.nc", _undetermined),
    "report": ("report.html", lambda path: [f"report: {path}"]),
}
