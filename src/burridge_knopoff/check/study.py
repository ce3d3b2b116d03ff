"""`bk check`: files of a study that are missing, corrupt, stale, or of failed runs."""

from __future__ import annotations

import os
import shlex
from collections import Counter
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.check.leftovers import leftovers, run_files, unmade
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.jobs.checked import check_file
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.record import NAME, remake_command
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.running.status import STATUS_WORDS
from burridge_knopoff.study.formatting import counted
from burridge_knopoff.study.job_log import last_words
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.stretches import stretches
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml
from burridge_knopoff.summaries.points import check_run

KINDS = ("missing", "corrupt", "stale", "failed")
#: Suffixes of logs and benchmarks, which are not results.
LOGS = (".log", ".tsv")
#: Maximum number of files in a printed command; more are left to --paths.
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

    files : description of the checked files
    findings : problems with these files
    others : files that rerunning the last config does not fix: leftover, of unknown name, or of another config
    notes : further remarks, in lines
    """

    results: Path
    files: str
    findings: list[Finding]
    others: list[Finding]
    notes: list[str]

    @property
    def exit_code(self) -> int:
        """0 if nothing is wrong, 3 if runs have failed only, else 1."""
        stale = any(finding.kind == "stale" for finding in self.others)
        return 1 if stale or self.paths else 3 if self.findings else 0

    @property
    def paths(self) -> list[str]:
        """Paths of the files to remake."""
        return [str(finding.path) for finding in self.findings if finding.kind != "failed"]

    def lines(self) -> list[str]:
        """Return all findings and their totals, a line each, and the command that remakes the files."""
        counts = Counter(finding.kind for finding in (*self.findings, *self.others))
        numbers = ", ".join(f"{counts[kind]} {kind}" for kind in KINDS)
        lines = [*map(str, (*self.findings, *self.others)), f"{self.results}: {self.files}: {numbers}", *self.notes]
        return [*lines, f"remake: {self._remake()}"] if self.paths else lines

    def _remake(self) -> str:
        listed = shlex.join(["bk", "check", "--paths", os.path.relpath(self.results, root_of(self.results))])
        return remake_command(self.results / NAME, *self.paths, listed=listed * (len(self.paths) > MOST_IN_COMMAND))


def root_of(results: Path) -> Path:
    """Return the folder from which `snakemake` was called for results/<study>."""
    return results.absolute().parents[1]


def check_study(results: str | Path) -> Check:
    """Check every file of a study against its seal, its config and the current sources.

    A summary, figure or report that does not exist is missing only if its job has started, see `unmade`.
    Raises ValueError, one line, if the folder holds no study.
    """
    results = Path(results)
    record, study = recorded_study(results)
    jobs = Jobs(study)
    points = _points(results, jobs)
    left = leftovers(results, jobs)
    notes = []
    if study.name != results.resolve().name:
        notes.append(f"this is study {study.name} under another name: Snakemake looks for it in a folder {study.name}")
    # A user who requests points alone does not expect those of other solvers.
    if not ((results / "solvers").is_dir() or (results / "logs/simulate_solver").is_dir()):
        unasked = [points.pop(path) for path in list(points) if path.is_relative_to(results / "solvers")]
        runs = counted(len(unasked), "run")
        notes += [f"not counted: {runs} of other solvers, none of which was asked for yet"] if unasked else []
    if left:
        files = counted(len(left), "file")
        notes.append(f"left over, with logs and benchmarks: {files}; delete: bk prune {results}")
    others = {path for path in results.rglob("*.nc") if not path.name.startswith(".")} - points.keys() - set(left)
    named = {results / name for name in jobs.all_files}
    missing = unmade(results, jobs)
    rest = [*(path.relative_to(results).as_posix() for path in named if path.is_file()), *missing]
    found = [
        *(_of_point(path, *run) for path, run in points.items()),
        *(_of_file(jobs, results, name, missing.get(name, Path())) for name in rest),
    ]
    return Check(
        results,
        f"{counted(len(points), 'point')} and {counted(len(rest), 'other file')}",
        sorted(filter(None, found), key=lambda finding: (KINDS.index(finding.kind), finding.path)),
        [
            *(Finding("leftover", path, "not part of this study") for path in left if path.suffix not in LOGS),
            *(Finding("unknown", path, "no file of a study has that name") for path in sorted(others - named)),
            *filter(None, [changed(results, record)]),
        ],
        notes,
    )


def _points(results: Path, jobs: Jobs) -> dict[Path, tuple[str, Path]]:
    """Return {point file: (command, log)} of all runs of a study."""
    study = jobs.study
    points = {results / name: (study.command(**run), results / log) for name, run, log in run_files(jobs)}
    for stretch, runs in stretches(study).items():
        for run in runs:
            path = results / "points" / study.point_file.format(**run)
            command, log = points[path]
            points[path] = command, log if log.exists() else results / f"logs/stretch/{stretch}.log"
    return points


def _of_point(path: Path, command: str, log: Path) -> Finding | None:
    """Return the problem with the point file of a run, or None."""
    try:
        status = check_run(path, command)
    except BadFile as error:
        return _problem(path, error, log)
    return None if status == "completed" else Finding("failed", path, f"ended with status {status}")


def _of_file(jobs: Jobs, results: Path, name: str, log: Path) -> Finding | None:
    """Return the problem with another file, by its name in the results, or None."""
    path = results / name
    try:
        check_file(jobs, results, name)
        ended = open_summary(path).get("status") if path.suffix == ".nc" else None
    except BadFile as error:
        return _problem(path, error, log)
    # A catalogue is of a single run.
    if ended is None or ended.dims or STATUS_WORDS[ended.item()] == "completed":
        return None
    return Finding("failed", path, f"ended with status {STATUS_WORDS[ended.item()]}")


def _problem(path: Path, error: BadFile, log: Path) -> Finding:
    reason = error.reason if error.path == path else f"was made from {error.path}, which is {error.kind}"
    if error.kind == "missing":
        words = last_words(log)
        reason = f"its job failed: {words} (log {log})" if words else "not made yet"
    return Finding(error.kind, path, reason)


def changed(results: Path, record: dict[str, Any]) -> Finding | None:
    """Return the finding if the config file differs from that of the last run: stale, or a note if it is missing."""
    # The record only has the path of the config file.
    file, path = Path(record["config_file"]), root_of(results) / record["config_file"]
    if not path.exists():
        return Finding("note", file, "is not there; what is checked is the config of the last run")
    try:
        if read_yaml(path) != record["given"]:
            return Finding("stale", file, "has changed since the last run, whose config is checked")
    except ConfigError as error:
        reason = str(error).partition(": ")[2]
        return Finding("stale", file, f"{reason}; what is checked is the config of the last run")
    return None
