"""Which files of a study are missing, corrupt, stale, or of a run that failed: `bk check`."""

from __future__ import annotations

import shlex
from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.check.leftovers import leftovers
from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.record import NAME, read_study_record, remake_command
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.study import ConfigError, Study, all_points, solver_points
from burridge_knopoff.study.job_log import last_words
from burridge_knopoff.study.paths import POINT
from burridge_knopoff.study.words import counted
from burridge_knopoff.study.yaml_file import read_yaml
from burridge_knopoff.summaries.points import check_run

KINDS = ("missing", "corrupt", "stale", "failed")
#: Files that a command is printed with; more are left to --paths.
MOST_IN_COMMAND = 8


@dataclass(frozen=True)
class Finding:
    """A file that is not as it should be: what it is, and why, in a line."""

    kind: str
    path: Path
    reason: str

    def __str__(self) -> str:
        return f"{self.kind:8} {self.path}: {self.reason}"


@dataclass(frozen=True)
class Check:
    """What was found in the results of a study.

    points, summaries : numbers of point files that should be there, and of other netCDF files that are
    findings : what is wrong with these files
    others : what no run of the config of the last run mends: what is left over, of an unknown name, or another config
    unasked : number of runs of other solvers, none of which has been asked for
    leftover_logs : number of logs and benchmarks that belong to no point of the study; see `leftovers`
    """

    results: Path
    points: int
    summaries: int
    findings: tuple[Finding, ...]
    others: tuple[Finding, ...]
    unasked: int
    leftover_logs: int

    @property
    def exit_code(self) -> int:
        """0 if nothing is wrong, 3 if runs have failed only, else 1."""
        changed = any(finding.kind == "stale" for finding in self.others)
        return 1 if changed or self.paths else 3 if self.findings else 0

    @property
    def paths(self) -> list[str]:
        """Paths of the files that are to be made again."""
        return [str(finding.path) for finding in self.findings if finding.kind != "failed"]

    def lines(self) -> list[str]:
        """Return all findings and their sum, a line each."""
        counts = Counter(finding.kind for finding in self.findings)
        left = sum(finding.kind == "leftover" for finding in self.others) + self.leftover_logs
        files = f"{counted(self.points, 'point')} and {counted(self.summaries, 'other file')}"
        lines = [str(finding) for finding in (*self.findings, *self.others)]
        lines.append(f"{self.results}: {files}: {', '.join(f'{counts[kind]} {kind}' for kind in KINDS)}")
        if self.unasked:
            runs = counted(self.unasked, "run")
            lines.append(f"not counted: {runs} of other solvers, none of which was asked for yet")
        if left:
            files = counted(left, "file")
            lines.append(f"left over, with logs and benchmarks: {files}; delete: bk prune {self.results}")
        if self.paths:
            lines.append(f"remake: {self._remake()}")
        return lines

    def _remake(self) -> str:
        """Return the command that makes what is listed again, from wherever it is called."""
        root, here = root_of(self.results), self.results.absolute()
        place = "" if root.resolve() == Path.cwd() else f"cd {shlex.quote(str(root))} && "
        below = here.relative_to(root)
        named: list[str] = [f"$(bk check --paths {below})"]
        if len(self.paths) <= MOST_IN_COMMAND:
            named = [str(Path(path).absolute().relative_to(root)) for path in self.paths]
        return place + remake_command(self.results / NAME, *named)


def root_of(results: Path) -> Path:
    """Return the folder in which `snakemake` was called for results/<study>."""
    return results.absolute().parents[1]


def check_study(results: str | Path) -> Check:
    """Hold every point and every other netCDF file of a study against its config and the sources of now.

    Raises ValueError, one line, if the folder holds no study.
    """
    results = Path(results)
    record, study = recorded_study(results)
    runs = list(_runs(study))
    # Nobody who asks for points only asks for them by other solvers.
    asked = (results / "solvers").is_dir() or (results / "logs/simulate_solver").is_dir()
    wanted = [run for run in runs if asked or not run[0].startswith("solvers/")]
    points = {results / place: (results / log, command) for place, log, command in wanted}
    left, logs = leftovers(results, study)
    known = {*points, *left}
    files = sorted(path for path in results.rglob("*.nc") if not path.name.startswith("."))
    others = [path for path in files if path not in known]
    unknown = [path for path in others if path.relative_to(results).parts[0] in ("points", "solvers")]
    summaries = [path for path in others if path not in unknown]
    found = [*(_look(path, command, log) for path, (log, command) in points.items()), *map(_look, summaries)]
    findings = sorted(filter(None, found), key=lambda finding: (KINDS.index(finding.kind), finding.path))
    elsewhere = [
        *(Finding("leftover", path, "belongs to no point of the study") for path in left),
        *(Finding("unknown", path, "no point of a study has that name") for path in unknown),
        *filter(None, [changed(results, record)]),
    ]
    numbers = len(points), len(summaries)
    return Check(results, *numbers, tuple(findings), tuple(elsewhere), len(runs) - len(wanted), len(logs))


def recorded_study(results: Path) -> tuple[dict[str, Any], Study]:
    """Return the record of a folder of results and the study that it describes.

    Raises ValueError, one line, if the folder holds no study, or one that this version cannot read.
    """
    record = read_study_record(results)
    study = Study(record["config"], record["grid"])
    try:
        # All of the config that matters here is looked at.
        list(_runs(study))
    except (LookupError, TypeError, AttributeError, ValueError) as error:
        raise ValueError(f"{results / NAME}: not a study of this version ({error}); run snakemake again") from None
    return record, study


def _runs(study: Study) -> Iterator[tuple[str, str, str]]:
    """Yield file, log and command of every run of a study, the paths below its results."""
    points = [(law, None, initial, a) for law, initial, a in all_points(study)]
    for law, solver, initial, a in (*points, *solver_points(study)):
        place = POINT.format(law=law, initial=initial, a=a)
        folder, rule = (f"solvers/{solver}", f"simulate_solver/{solver}") if solver else ("points", "simulate")
        log = f"logs/{rule}/{place.removesuffix('.nc')}.log"
        yield f"{folder}/{place}", log, study.command(law, initial, a, solver)


def _look(path: Path, command: str = "", log: Path = Path()) -> Finding | None:
    """Return what is wrong with the point file of a run, or with a summary if there is no command, or None."""
    try:
        if not command:
            open_summary(path)
        elif (status := check_run(path, command).status) != "completed":
            return Finding("failed", path, f"ended with status {status}")
    except BadFile as error:
        reason = error.reason
        if error.kind == "missing":
            words = last_words(log)
            reason = f"its job failed: {words} (log {log})" if words else "not made yet"
        return Finding(error.kind, path, reason)
    return None


def changed(results: Path, record: dict[str, Any]) -> Finding | None:
    """Return that the config file is not that of the last run: stale, or a note if it is not there to be compared."""
    file = record["config_file"]
    path = root_of(results) / file
    # Which file it was can be told from where it lay only.
    if not path.exists():
        return Finding("note", Path(file), "is not there; what is checked is the config of the last run")
    try:
        if read_yaml(path) != record["given"]:
            return Finding("stale", Path(file), "has changed since the last run, whose config is checked")
    except ConfigError as error:
        file, _, reason = str(error).partition(": ")
        return Finding("stale", Path(file), f"{reason}; what is checked is the config of the last run")
    return None
