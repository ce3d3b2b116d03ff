"""`bk check`: files of a study that are missing, corrupt, stale, or of failed runs."""

from __future__ import annotations

import os
import shlex
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.check.leftovers import leftovers, missing_files, run_files
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.jobs.checked import check_file
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.record import NAME, remake_command
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.running.status import STATUS_WORDS
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.job_log import logged_error
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from burridge_knopoff.summaries.points import check_run

KINDS = ("missing", "corrupt", "stale", "failed")
#: Suffixes of logs and benchmarks, which are not results.
LOGS = (".log", ".tsv")
#: Maximum number of files in a printed command; for more, the command calls `bk check --paths`.
MOST_IN_COMMAND = 8


@dataclass(frozen=True)
class Finding:
    """A file with a problem: its kind and the reason, in a line."""

    kind: str
    path: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.kind:8} {self.path}: {self.reason}"


@dataclass(frozen=True)
class Check:
    """The findings in the results of a study.

    files : number of checked files, in words
    findings : problems with these files
    others : problems that another run of the last config does not fix: leftovers, unknown names, an edited config
    notes : further remarks, one per line
    is_locked : whether Snakemake has locked the files, as it does during a run
    """

    results: Path
    files: str
    findings: list[Finding]
    others: list[Finding]
    notes: list[str]
    is_locked: bool = False

    @property
    def exit_code(self) -> int:
        """0 if nothing is wrong, 3 if runs have failed only, else 1."""
        stale = any(finding.kind == "stale" for finding in self.others)
        return 1 if stale or self.paths else 3 if self.findings else 0

    @property
    def paths(self) -> list[str]:
        """Paths of the files to recreate."""
        return [str(finding.path) for finding in self.findings if finding.kind != "failed"]

    def lines(self) -> list[str]:
        """Return a line for each finding, their totals, the notes, and the command that recreates the files."""
        counts = Counter(finding.kind for finding in (*self.findings, *self.others))
        numbers = ", ".join(f"{counts[kind]} {kind}" for kind in KINDS)
        lines = [*map(str, (*self.findings, *self.others)), f"{self.results}: {self.files}: {numbers}", *self.notes]
        if self.is_locked:
            return [
                *lines,
                "a run is in progress here and makes missing and stale files; if it was killed, release its lock by "
                "`snakemake --unlock` and run it again",
            ]
        return [*lines, f"remake: {self._remake()}"] if self.paths else lines

    def _remake(self) -> str:
        listed = shlex.join(["bk", "check", "--paths", os.path.relpath(self.results, root_of(self.results))])
        return remake_command(self.results / NAME, *self.paths, listed=listed * (len(self.paths) > MOST_IN_COMMAND))


def root_of(results: Path) -> Path:
    """Return the folder from which `snakemake` was called for results/<study>."""
    return results.absolute().parents[1]


def is_locked(results: Path) -> bool:
    """Return whether Snakemake has locked the results of a study, as it does during a run."""
    root = root_of(results)
    inside = f"{results.absolute().relative_to(root).as_posix()}/"
    locks = (root / ".snakemake/locks").glob("*.lock")
    return any(line.startswith(inside) for lock in locks for line in lock.read_text(encoding="utf-8").splitlines())


def check_study(results: str | Path) -> Check:
    """Check every file of a study against its seal, its config and the current sources.

    A summary, figure or report that does not exist counts as missing only if its job has started, see `missing_files`.
    Raises ValueError, one line, if the folder holds no study.
    """
    results = Path(results)
    record, study = recorded_study(results)
    jobs = Jobs(study)
    points = _points(results, jobs)
    left = leftovers(results, jobs)
    notes = []
    if study.name != results.resolve().name:
        notes.append(f"this is study {study.name} under another name: Snakemake expects it in a folder {study.name}")
    solver_runs = {path: run for path, run in points.items() if path.is_relative_to(results / "solvers")}
    points = {path: run for path, run in points.items() if path not in solver_runs}
    # A user who requested only points does not expect runs of other solvers.
    if not ((results / "solvers").is_dir() or (results / "logs/simulate_solver").is_dir()):
        runs = format_count(len(solver_runs), "run")
        notes += [f"not counted: {runs} of other solvers, none of which was requested yet"] if solver_runs else []
        solver_runs = {}
    if left:
        files = format_count(len(left), "file")
        notes.append(f"left over, with logs and benchmarks: {files}; delete: bk prune {results}")
    others = {path for path in results.rglob("*.nc") if not path.name.startswith(".")} - {*points, *solver_runs, *left}
    named = {results / name for name in jobs.all_files}
    missing = missing_files(results, jobs)
    rest = [*(path.relative_to(results).as_posix() for path in named if path.is_file()), *missing]
    found = [
        *(_point_finding(path, *run) for path, run in {**points, **solver_runs}.items()),
        *(_file_finding(jobs, results, name, missing.get(name, Path())) for name in rest),
    ]
    return Check(
        results,
        ", ".join(
            [
                format_count(len(points), "point"),
                *([f"{format_count(len(solver_runs), 'run')} of other solvers"] if solver_runs else []),
                format_count(len(rest), "other file"),
            ]
        ),
        sorted(filter(None, found), key=lambda finding: (KINDS.index(finding.kind), finding.path)),
        [
            *(Finding("leftover", path, "not part of this study") for path in left if path.suffix not in LOGS),
            *(Finding("unknown", path, "no file of a study has that name") for path in sorted(others - named)),
            *filter(None, [config_change(results, record)]),
        ],
        notes,
        is_locked(results),
    )


def _points(results: Path, jobs: Jobs) -> dict[Path, tuple[str, Path]]:
    """Return {point file: (command, log)} of all runs of a study."""
    study = jobs.study
    points = {results / name: (study.command(**run), results / log) for name, run, log in run_files(jobs)}
    for chunk, runs in chunks(study).items():
        for run in runs:
            path = results / "points" / study.point_file.format(**run)
            command, log = points[path]
            points[path] = command, log if log.exists() else results / f"logs/chunk/{chunk}.log"
    return points


def _point_finding(path: Path, command: str, log: Path) -> Finding | None:
    """Return the problem with the point file of a run, or None."""
    try:
        status = check_run(path, command)
    except BadFile as error:
        return _error_finding(path, error, log)
    return None if status == "completed" else Finding("failed", path, f"ended with status {status}")


def _file_finding(jobs: Jobs, results: Path, name: str, log: Path) -> Finding | None:
    """Return the problem with another file, by its name in the results, or None."""
    path = results / name
    try:
        check_file(jobs, results, name)
        ended = open_summary(path).get("status") if path.suffix == ".nc" else None
    except BadFile as error:
        return _error_finding(path, error, log)
    # A catalogue is the result of a single run, which has a status.
    if ended is None or ended.dims or STATUS_WORDS[ended.item()] == "completed":
        return None
    return Finding("failed", path, f"ended with status {STATUS_WORDS[ended.item()]}")


def _error_finding(path: Path, error: BadFile, log: Path) -> Finding:
    reason = error.reason if error.path == path else f"was made from {error.path}, which is {error.kind}"
    if error.kind == "missing":
        words = logged_error(log)
        reason = f"its job failed: {words} (log {log})" if words else "not made yet"
    return Finding(error.kind, path, reason)


def config_change(results: Path, record: dict[str, Any]) -> Finding | None:
    """Return a finding if the config file differs from that of the last run, or a note if it does not exist."""
    # The record contains the path of the config file relative to the folder of the run.
    file, path = Path(record["config_file"]), root_of(results) / record["config_file"]
    if not path.exists():
        return Finding("note", file, "does not exist; the config of the last run is checked")
    try:
        config = read_yaml(path)
        if isinstance(config, dict) and config.get("study") != record["given"].get("study"):
            return Finding("stale", file, f"is not the config of {NAME}; the config of the last run is checked")
        if config != record["given"]:
            return Finding("stale", file, "has changed since the last run; the config of the last run is checked")
    except ConfigError as error:
        reason = str(error).partition(": ")[2]
        return Finding("stale", file, f"{reason}; the config of the last run is checked")
    return None


def check_record(results: Path) -> None:
    """Refuse a folder whose record is not that of its files, since by it all of them could be left over.

    Raises ValueError, one line, if the config file has changed, if the record is of a study of another name, if a file
    was made from another config or other sources, or if a point is missing.
    """
    record, study = recorded_study(results)
    change = config_change(results, record)
    reason = ""
    if change and change.kind == "stale":
        reason = f"{change.path} {change.reason.partition(';')[0]}"
    elif study.name != results.resolve().name:
        reason = f"{NAME} is the record of study {study.name}"
    else:
        for finding in check_study(results).findings:
            is_point = finding.path.is_relative_to(results / "points")
            if finding.kind == "missing" and is_point:
                reason = f"incomplete ({finding.path}: {finding.reason}), so that its record cannot be verified"
                break
            if finding.kind == "stale":
                reason = f"its files are not those of {NAME} ({finding.path}: {finding.reason})"
                break
    if reason:
        raise ValueError(f"{results}: {reason}: run snakemake first")
