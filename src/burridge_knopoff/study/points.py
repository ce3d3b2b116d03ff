"""Making some points of a study, those that are not there yet."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path

from burridge_knopoff.dataset.about import point_about
from burridge_knopoff.dataset.point import write_point
from burridge_knopoff.provenance.seal import BadFile, check_seal
from burridge_knopoff.running.command import simulate_command
from burridge_knopoff.running.simulation import run
from burridge_knopoff.study.formatting import counted
from burridge_knopoff.study.study import Study


def make_points(study: Study, points: Sequence[Mapping[str, str]], folder: Path) -> int:
    """Make those of some points that are missing, damaged or out of date; return how many were made.

    points : their wildcards; folder : `points` of the results
    Raises RuntimeError, one line that names the first point that failed and its command, when all others are made.
    """
    made, failed = 0, []
    for point in points:
        path = folder / study.point_file.format(**point)
        model, state, settings = study.run_of(**point)
        command = simulate_command(model, state, settings)
        try:
            check_seal(path, point_about(command))
        except BadFile:
            try:
                write_point(run(model, state, settings), path)
                made += 1
            except (ValueError, MemoryError) as error:
                failed.append(f"{path}: {error} ({command} --out {path})")
    if failed:
        more = f"; {counted(len(failed) - 1, 'more point')} of this stretch failed" if len(failed) > 1 else ""
        raise RuntimeError(f"{failed[0]}{more}")
    return made
