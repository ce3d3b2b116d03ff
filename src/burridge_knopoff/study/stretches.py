"""Stretches: runs of consecutive points of a study, each of which is one job."""

from __future__ import annotations

from pathlib import Path

from burridge_knopoff.study.paths import STRETCH
from burridge_knopoff.study.study import Study, all_points

#: Points of a stretch, at least and at most: a job takes a second to start, and one that is killed has made some of
#: them. Between these limits a study has JOBS stretches.
FEWEST, MOST, JOBS = 20, 1000, 100


def stretches(study: Study) -> dict[str, list[dict[str, str]]]:
    """Return {number of a stretch in file names: wildcards of its points}; none unless several parameters vary."""
    points = all_points(study) if study.is_plane else []
    size = min(max(-(-len(points) // JOBS), FEWEST), MOST)
    return {f"{first // size:04d}": points[first : first + size] for first in range(0, len(points), size)}


def incomplete(study: Study, results: Path) -> list[Path]:
    """Return the marks of finished stretches of which a point is missing, or was written after the mark."""
    found = []
    for stretch, points in stretches(study).items():
        mark = results / STRETCH.format(stretch=stretch)
        if mark.exists():
            finished = mark.stat().st_mtime
            paths = (results / "points" / study.point_file.format(**point) for point in points)
            if not all(path.exists() and path.stat().st_mtime <= finished for path in paths):
                found.append(mark)
    return found
