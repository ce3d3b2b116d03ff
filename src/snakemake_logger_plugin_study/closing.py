"""The last words of a run: what was made, where, how long it took, what it says, and what failed."""

from __future__ import annotations

import json
from collections import Counter
from collections.abc import Callable, Collection, Sequence
from pathlib import Path

import numpy as np

from burridge_knopoff.claims.verdict import CONVENTION, FAILS, one_reason
from burridge_knopoff.study.job_log import failure

#: Verdicts whose claims are named, not only counted.
NAMED_VERDICTS = (FAILS, CONVENTION)
#: Names in a line, and failed jobs with a line each, at most.
MOST_NAMES, MOST_FAILED = 8, 10
#: So few files are named one by one.
FEW_FILES = 3


def closing_lines(
    results: str | Path,
    seconds: float,
    *,
    success: bool,
    made: Collection[str] = (),
    wanted: Collection[str] = (),
    failed: Sequence[tuple[str, Sequence[str]]] = (),
    missed: int = 0,
) -> list[str]:
    """Return the last lines of a run, plain text.

    results : folder of the study, results/<study>
    seconds : how long the run took
    success : whether it reached its end
    made, wanted : files that the run made; files that it made or found up to date
    failed : (job, its log files) of the jobs that failed
    missed : number of jobs that were to run and did not

    Summaries are read only if they are wanted and the run reached its end: older ones say nothing about it. A file
    that cannot be read gives a line that says so.
    """
    results = Path(results)
    if not success:
        return _stopped(results, seconds, made, failed, missed)
    lines = [f"study {results.name}: done in {elapsed(seconds)}", *_made(results, made)]
    readers: tuple[tuple[str, Callable[[Path], list[str]]], ...] = (
        ("claims.json", _claims),
        ("mean_distance.nc", _incomplete),
        ("lyapunov.nc", _undetermined),
    )
    known = {Path(path) for path in wanted}
    for name, read in readers:
        path = results / "summary" / name
        if path not in known:
            continue
        try:
            lines += read(path)
        except (OSError, RuntimeError, ValueError, KeyError, IndexError, TypeError, AttributeError) as error:
            lines.append(f"{path}: cannot be read ({error})")
    lines += [f"report: {path}" for path in sorted(known) if path.parent == results and path.suffix == ".html"]
    return lines


def elapsed(seconds: float) -> str:
    """Return a duration as 12 s, 5 min 12 s or 2 h 5 min."""
    minutes, rest = divmod(round(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    if hours:
        return f"{hours} h {minutes} min"
    return f"{minutes} min {rest} s" if minutes else f"{rest} s"


def _stopped(
    results: Path, seconds: float, made: Collection[str], failed: Sequence[tuple[str, Sequence[str]]], missed: int
) -> list[str]:
    counts = ((len(failed), "failed"), (missed, "did not run"))
    reasons = [f"{count} {'job' if count == 1 else 'jobs'} {what}" for count, what in counts if count]
    lines = [f"study {results.name}: stopped after {elapsed(seconds)}: {', '.join(reasons) or 'not at its end'}"]
    lines += [failure(job, logs) for job, logs in failed[:MOST_FAILED]]
    if len(failed) > MOST_FAILED:
        lines.append(f"failed: and {len(failed) - MOST_FAILED} more")
    return [*lines, *_made(results, made), "the same command goes on where this run stopped"]


def _made(results: Path, made: Collection[str]) -> list[str]:
    if not made:
        return ["made: nothing"]
    if len(made) <= FEW_FILES:
        return [f"made: {', '.join(made)}"]
    inside = [Path(path).relative_to(results) for path in made if Path(path).is_relative_to(results)]
    folders = Counter(path.parts[0] for path in inside if len(path.parts) > 1)
    alone = [path.name for path in inside if len(path.parts) == 1]
    parts = [*(f"{name} {count}" for name, count in folders.items()), *alone]
    return [f"files made in {results}: {', '.join(parts)}"]


def _claims(path: Path) -> list[str]:
    read = json.loads(path.read_text(encoding="utf-8"))
    counts = ", ".join(f"{verdict} {count}" for verdict, count in read["counts"].items())
    lines = [f"claims of the paper: {counts} ({path.with_suffix('.md')})"]
    if reason := one_reason(read["claims"]):
        return [f"claims of the paper: none is judged ({path.with_suffix('.md')})", f"  {reason}"]
    for verdict in NAMED_VERDICTS:
        names = [claim["name"] for claim in read["claims"] if claim["verdict"] == verdict]
        if names:
            lines.append(f"  {verdict}: {_list(names)}")
    return lines


def _list(names: Sequence[str]) -> str:
    more = len(names) - MOST_NAMES
    return ", ".join(names[:MOST_NAMES]) + (f" and {more} more" if more > 0 else "")


def _flags(path: Path, name: str) -> tuple[int, Counter[str]]:
    """Return the number of values of a flag variable and how often each meaning occurs."""
    import netCDF4

    with netCDF4.Dataset(path) as dataset:
        variable = dataset[name]
        variable.set_auto_mask(False)
        meanings = dict(zip(np.atleast_1d(variable.flag_values), variable.flag_meanings.split(), strict=True))
        values = variable[:].ravel()
    return values.size, Counter(meanings[value] for value in values)


def _incomplete(path: Path) -> list[str]:
    total, meanings = _flags(path, "status")
    completed = meanings.pop("completed", 0)
    if completed == total:
        return [f"points: all {total} completed"]
    reasons = ", ".join(f"{name} {count}" for name, count in sorted(meanings.items()))
    return [f"points: {total - completed} of {total} did not complete: {reasons} (status in {path})"]


def _undetermined(path: Path) -> list[str]:
    total, meanings = _flags(path, "kind")
    count = meanings["undetermined"]
    return [f"points: kind of motion undetermined at {count} of {total} (kind in {path})"] if count else []
