"""Simulates those of some points of a study that are missing, corrupt or out of date."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.runner import LOCKSTEP_RUNS, run_together
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import prepare
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study


def make_points(study: Study, points: Sequence[Mapping[str, str]], results: Path) -> int:
    """Simulate those of some points that are missing, corrupt or out of date; return how many there were.

    points : their wildcards; results : folder of the study
    Raises RuntimeError if a point fails, after all others are done: one line with the first such point and its command.
    """
    wanted, failed = [], []
    for point in points:
        path = results / study.run_file(**point)
        run = study.run_of(**point)
        command = simulate_command(*run)
        try:
            with open_run(path, command) as dataset:
                is_current = dataset.source_fingerprint == source_fingerprint("burridge_knopoff.dataset.point")
        except BadFile:
            is_current = False
        if not is_current:
            wanted.append((path, command, run))
    for first in range(0, len(wanted), LOCKSTEP_RUNS):
        failed += _simulate_together(wanted[first : first + LOCKSTEP_RUNS])
    if failed:
        suffix = f"; {format_count(len(failed) - 1, 'more point')} of this chunk failed" if len(failed) > 1 else ""
        raise RuntimeError(f"{failed[0]}{suffix}")
    return len(wanted) - len(failed)


def _simulate_together(wanted: Sequence[tuple[Path, str, tuple[Model, InitialState, Settings]]]) -> list[str]:
    """Simulate points, given by their files, commands and runs; return a line for each failure, with the reason."""
    failed, prepared = [], []
    for path, command, run in wanted:
        try:
            prepared.append((path, command, prepare(*run)))
        except (ValueError, MemoryError) as error:
            failed.append(_failure(path, error, command))
    for how, (path, command, job) in zip(run_together([job.runner for *_, job in prepared]), prepared, strict=True):
        try:
            write_point(job.result(job.runner.status_of(how)), path)
        except (ValueError, MemoryError) as error:
            failed.append(_failure(path, error, command))
    return failed


def _failure(path: Path, error: Exception, command: str) -> str:
    return f"{path}: {error} ({command} --out {path})"
