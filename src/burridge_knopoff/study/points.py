"""Making some points of a study, those that are not there yet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.dataset.point_identity import point_identity
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.provenance.seal import BadFile, check_seal
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.runner import LOCKSTEP_RUNS, run_together
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import prepare
from burridge_knopoff.study.formatting import counted
from burridge_knopoff.study.study import Study


def make_points(study: Study, points: Sequence[Mapping[str, str]], folder: Path) -> int:
    """Make those of some points that are missing, damaged or out of date; return how many were made.

    points : their wildcards; folder : `points` of the results
    Raises RuntimeError, one line that names the first point that failed and its command, when all others are made.
    """
    wanted, failed = [], []
    for point in points:
        path = folder / study.point_file.format(**point)
        run = study.run_of(**point)
        command = simulate_command(*run)
        try:
            check_seal(path, point_identity(command))
        except BadFile:
            wanted.append((path, command, run))
    for first in range(0, len(wanted), LOCKSTEP_RUNS):
        failed += _make_together(wanted[first : first + LOCKSTEP_RUNS])
    if failed:
        more = f"; {counted(len(failed) - 1, 'more point')} of this stretch failed" if len(failed) > 1 else ""
        raise RuntimeError(f"{failed[0]}{more}")
    return len(wanted) - len(failed)


def _make_together(wanted: Sequence[tuple[Path, str, tuple[Model, InitialState, Settings]]]) -> list[str]:
    """Make points, given by their files, commands and runs; return for each that failed a line that says why."""
    failed, prepared = [], []
    for path, command, run in wanted:
        try:
            prepared.append((path, command, prepare(*run)))
        except (ValueError, MemoryError) as error:
            failed.append(_failure(path, error, command))
    for how, (path, command, one) in zip(run_together([one.runner for *_, one in prepared]), prepared, strict=True):
        try:
            write_point(one.result(one.runner.status_of(how)), path)
        except (ValueError, MemoryError) as error:
            failed.append(_failure(path, error, command))
    return failed


def _failure(path: Path, error: Exception, command: str) -> str:
    return f"{path}: {error} ({command} --out {path})"
