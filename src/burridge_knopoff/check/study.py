"""`bk check`: files of a study that are missing, corrupt, outdated, or of failed runs."""

from __future__ import annotations

import os
from collections import Counter
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

import netCDF4

from burridge_knopoff.check.leftovers import leftovers, missing_files, run_logs
from burridge_knopoff.messages import command
from burridge_knopoff.outputs import study_files
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.files import read_regular
from burridge_knopoff.provenance.origin import Origin
from burridge_knopoff.provenance.record import CHECKOUT, NAME, OTHER_SNAKEFILE, imports_study, remake_command
from burridge_knopoff.provenance.sources import current_sources
from burridge_knopoff.running.status import STATUS_WORDS
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.integrity import check_file
from burridge_knopoff.study.job_log import logged_error
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import Study, run_files
from burridge_knopoff.study.yaml_file import ConfigError, read_yaml

KINDS = ("missing", "corrupt", "outdated", "failed")
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
    left : files of an earlier config, with their logs and benchmarks
    notes : further remarks, one per line
    is_locked : whether Snakemake has locked the files, as it does during a run
    """

    results: Path
    files: str
    findings: list[Finding]
    others: list[Finding]
    left: list[Path]
    notes: list[str]
    is_locked: bool = False

    @property
    def exit_code(self) -> int:
        """0 if nothing is wrong, 3 if runs have failed only, else 1."""
        outdated = any(finding.kind == "outdated" for finding in self.others)
        return 1 if outdated or self.paths else 3 if self.findings else 0

    @property
    def paths(self) -> list[str]:
        """Paths of the files to recreate."""
        return [str(finding.path) for finding in self.findings if finding.kind != "failed"]

    def lines(self) -> list[str]:
        """Return a line for each finding, their totals, the notes, and the command that recreates or deletes files."""
        counts = Counter(finding.kind for finding in (*self.findings, *self.others))
        numbers = ", ".join(f"{counts[kind]} {kind}" for kind in KINDS)
        lines = [*map(str, (*self.findings, *self.others)), f"{self.results}: {self.files}: {numbers}", *self.notes]
        if self.is_locked:
            return [
                *lines,
                "a run is in progress here and makes missing and outdated files; if it was killed, release its lock by "
                "`snakemake --unlock` and run it again",
            ]
        if self.paths:
            remake = self._remake()
            if f" -s {OTHER_SNAKEFILE} " in remake:
                lines += [f"{OTHER_SNAKEFILE}: the Snakefile of this study, if you trust it; not that of {CHECKOUT}"]
            return [*lines, f"remake: {remake}"]
        # By the record of another study, all files may be left over.
        if self.exit_code == 1 or not self.left:
            return lines
        files = format_count(len(self.left), "file")
        return [*lines, f"left over, with logs and benchmarks: {files}; delete: {command('rm', *self.left)}"]

    def _remake(self) -> str:
        listed = ("bk", "check", "--paths", os.path.relpath(self.results, root_of(self.results)))
        is_long = len(self.paths) > MOST_IN_COMMAND
        return remake_command(self.results / NAME, *self.paths, listed=listed if is_long else ())


def root_of(results: Path) -> Path:
    """Return the folder from which `snakemake` was called for results/<study>."""
    return results.absolute().parents[1]


def is_locked(results: Path) -> bool:
    """Return whether Snakemake has locked the results of a study, as it does during a run."""
    root = root_of(results)
    inside = f"{results.absolute().relative_to(root).as_posix()}/"
    locks = (root / ".snakemake/locks").glob("*.lock")
    return any(line.startswith(inside) for lock in locks for line in read_regular(lock).decode().splitlines())


def check_study(results: str | Path) -> Check:
    """Check every file of a study: that it is whole, made with the params of the last run, and by the current sources.

    Snakemake need not be there, and the results may have been moved. A summary, figure or report that does not exist
    counts as missing only if its job has started, see `missing_files`.

    Raises ValueError, one line, if the folder holds no study.
    """
    results = Path(results)
    record, study = recorded_study(results)
    runs = _runs(results, study)
    left = leftovers(results, study)
    notes = []
    if study.name != results.resolve().name:
        notes.append(f"this is study {study.name} under another name: Snakemake expects it in a folder {study.name}")
    solver_runs = {name: log for name, log in runs.items() if name.startswith("solvers/")}
    points = {name: log for name, log in runs.items() if name not in solver_runs}
    # A user who requested only points does not expect runs of other solvers.
    if not ((results / "solvers").is_dir() or (results / "logs/simulate_solver").is_dir()):
        absent = format_count(len(solver_runs), "run")
        notes += [f"not counted: {absent} of other solvers, none of which was requested yet"] if solver_runs else []
        solver_runs = {}
    missing = missing_files(results, study)
    file_names = [name for name in study_files(study) if not name.endswith(".done")]
    rest = {name: missing.get(name, Path()) for name in file_names if name in missing or (results / name).is_file()}
    unknown = {path.relative_to(results).as_posix() for path in results.rglob("*.nc") if not path.name.startswith(".")}
    unknown -= {*runs, *file_names, *(path.relative_to(results).as_posix() for path in left)}
    return Check(
        results,
        ", ".join(
            [
                format_count(len(points), "point"),
                *([f"{format_count(len(solver_runs), 'run')} of other solvers"] if solver_runs else []),
                format_count(len(rest), "other file"),
            ]
        ),
        sorted(
            _findings(study, results, record, {**points, **solver_runs, **rest}),
            key=lambda finding: (KINDS.index(finding.kind), finding.path),
        ),
        [
            *(Finding("leftover", path, "not part of this study") for path in left if path.suffix not in LOGS),
            *(Finding("unknown", results / name, "no file of a study has that name") for name in sorted(unknown)),
            *filter(None, [config_change(results, record)]),
        ],
        left,
        notes,
        is_locked(results),
    )


def _runs(results: Path, study: Study) -> dict[str, Path]:
    """Return {point file: log} of all runs of a study."""
    logs = {name: results / log for name, log in run_logs(study).items()}
    for chunk, points in chunks(study).items():
        for point in points:
            name = study.run_file(**point)
            if not logs[name].exists():
                logs[name] = results / f"logs/chunk/{chunk}.log"
    return logs


def _findings(study: Study, results: Path, record: Mapping[str, Any], logs: Mapping[str, Path]) -> Iterator[Finding]:
    """Yield the problems with files, given by their names in the results, and the logs of their jobs."""
    bad: dict[str, Finding] = {}
    runs = run_files(study)
    origins: dict[str, Origin] = {}
    checksums: dict[str, str] = {}
    for name, log in logs.items():
        path = results / name
        try:
            origin, checksums[name] = check_file(study, results, name, record, runs.get(name))
            if origin:
                origins[name] = origin
            if finding := _own_finding(path, origin):
                bad[name] = finding
        except BadFile as error:
            words = logged_error(log) if error.kind == "missing" else ""
            reason = f"its job failed: {words} (log {log})" if words else "not made yet"
            bad[name] = Finding(error.kind, path, reason if error.kind == "missing" else error.reason)
    for name, origin in origins.items():
        for other, checksum in origin.inputs.items():
            if name in bad:
                break
            if other in bad and other not in checksums:
                reason = f"was made from {results / other}, which is {bad[other].kind}"
                bad[name] = Finding("outdated", results / name, reason)
            elif other in checksums and checksums[other] != checksum:
                bad[name] = Finding("outdated", results / name, f"was made from another {other}")
    yield from bad.values()


def _own_finding(path: Path, origin: Origin | None) -> Finding | None:
    """Return the problem with an intact file: other sources, or a run that did not complete; or None."""
    sources, status = origin.rule_fingerprint if origin else "", None
    if path.suffix == ".nc":
        with netCDF4.Dataset(path) as dataset:
            sources = sources or f"{dataset.source_module} {dataset.source_fingerprint}"
            # A catalogue is the result of a single run as well.
            if "status" in dataset.variables and not dataset["status"].dimensions:
                status = STATUS_WORDS[int(dataset["status"][...])]
    if sources and (now := current_sources(sources)) not in ("", sources):
        made_by = sources.rpartition(" ")[2]
        return Finding(
            "outdated", path, f"was made by other sources (fingerprint {made_by}, now {now.rpartition(' ')[2]})"
        )
    return Finding("failed", path, f"ended with status {status}") if status not in (None, "completed") else None


def config_change(results: Path, record: dict[str, Any]) -> Finding | None:
    """Return a finding if the config file differs from that of the last run, or a note if it does not exist."""
    # The record contains the path of the config file relative to the folder of the run.
    root = root_of(results)
    file, path = Path(record["config_file"]), root / record["config_file"]
    # Such a workflow passes its config on.
    if imports_study(record, root):
        return Finding("note", file, "imports the study; the config of the last run is checked")
    if not path.exists():
        return Finding("note", file, "does not exist; the config of the last run is checked")
    try:
        config = read_yaml(path)
        if isinstance(config, dict) and config.get("study") != record["given"].get("study"):
            return Finding("outdated", file, f"is not the config of {NAME}; the config of the last run is checked")
        if config != record["given"]:
            return Finding("outdated", file, "has changed since the last run; the config of the last run is checked")
    except ConfigError as error:
        reason = str(error).partition(": ")[2]
        return Finding("outdated", file, f"{reason}; the config of the last run is checked")
    return None
