"""Which files of a study are missing, corrupt, stale, or of a run that failed: `bk check`."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

from burridge_knopoff.dataset.summary import open_summary
from burridge_knopoff.provenance.record import NAME, read_study_record, remake_command
from burridge_knopoff.provenance.seal import BadFile
from burridge_knopoff.study import ConfigError, Study, all_points
from burridge_knopoff.study.job_log import last_words
from burridge_knopoff.study.paths import POINT
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


@dataclass(frozen=True)
class Check:
    """What was found in the results of a study.

    points, summaries : numbers of point files that should be there, and of other netCDF files that are
    unused : number of point files of no point of the study
    changed : what has changed in the config since the last run, in a line, or nothing
    """

    results: Path
    points: int
    summaries: int
    findings: tuple[Finding, ...]
    unused: int
    changed: str

    @property
    def exit_code(self) -> int:
        """0 if there is nothing to list, 3 if runs have failed only, else 1."""
        return 1 if self.changed or self.paths else 3 if self.findings else 0

    @property
    def paths(self) -> list[str]:
        """Paths of the files that are to be made again."""
        return [str(finding.path) for finding in self.findings if finding.kind != "failed"]

    def lines(self) -> list[str]:
        """Return all findings and their sum, a line each."""
        counts = Counter(finding.kind for finding in self.findings)
        lines = [f"{finding.kind:8} {finding.path}: {finding.reason}" for finding in self.findings]
        lines += [self.changed] if self.changed else []
        sums = ", ".join(f"{counts[kind]} {kind}" for kind in KINDS)
        lines.append(f"{self.results}: {self.points} points and {self.summaries} other files: {sums}")
        if self.unused:
            lines.append(f"{self.unused} point files belong to no point of the study")
        if self.paths:
            named = self.paths if len(self.paths) <= MOST_IN_COMMAND else [f"$(bk check --paths {self.results})"]
            lines.append(f"remake: {remake_command(self.results / NAME, *named)}")
        return lines


def check_study(results: str | Path) -> Check:
    """Hold every point and every other netCDF file of a study against its config and the sources of now.

    Raises ValueError, one line, if the folder holds no study.
    """
    results = Path(results)
    record = read_study_record(results)
    points = {results / place: run for place, *run in _runs(Study(record["config"], record["grid"]))}
    others = [path for path in sorted(results.rglob("*.nc")) if path not in points and not path.name.startswith(".")]
    summaries = [path for path in others if path.relative_to(results).parts[0] not in ("points", "solvers")]
    found = [_look(path, command, results / log) for path, (log, command) in points.items()]
    findings = sorted(
        filter(None, [*found, *map(_look, summaries)]), key=lambda finding: (KINDS.index(finding.kind), finding.path)
    )
    unused = len(others) - len(summaries)
    return Check(results, len(points), len(summaries), tuple(findings), unused, _changed(record))


def _runs(study: Study) -> Iterator[tuple[str, str, str]]:
    """Yield file, log and command of every run of a study, the paths below its results."""
    for law, initial, a in all_points(study):
        place = POINT.format(law=law, initial=initial, a=a)
        solvers = study.other_solvers(law) if study.grid[a] in study.config["solvers"]["a"] else []
        for solver, folder, rule in (
            (None, "points", "simulate"),
            *((name, f"solvers/{name}", f"simulate_solver/{name}") for name in solvers),
        ):
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


def _changed(record: dict) -> str:
    file = record["config_file"]
    try:
        same = read_yaml(file) == record["given"]
    except ConfigError as error:
        return f"stale    {error}; what is checked is the config of the last run"
    return "" if same else f"stale    {file}: has changed since the last run, whose config is checked"
