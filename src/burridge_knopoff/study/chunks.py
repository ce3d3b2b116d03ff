"""Chunks: consecutive points of a study that one job simulates."""

from __future__ import annotations

from pathlib import Path

from burridge_knopoff.study.paths import CHUNK
from burridge_knopoff.study.study import Study, all_points

#: Fewest and most points of a chunk: a job takes a second to start, and a job that is killed has finished some of its
#: points. Between these limits a study has JOBS chunks.
FEWEST, MOST, JOBS = 20, 1000, 100


def chunks(study: Study) -> dict[str, list[dict[str, str]]]:
    """Return {number of a chunk in file names: wildcards of its points}; none unless several parameters vary."""
    points = all_points(study) if study.is_plane else []
    size = min(max(-(-len(points) // JOBS), FEWEST), MOST)
    return {f"{first // size:04d}": points[first : first + size] for first in range(0, len(points), size)}


def incomplete_chunks(study: Study, results: Path) -> list[Path]:
    """Return the marks of finished chunks of which a point is missing, or was written after the mark."""
    marks = []
    for chunk, points in chunks(study).items():
        mark = results / CHUNK.format(chunk=chunk)
        if mark.exists():
            finished = mark.stat().st_mtime
            paths = (results / study.run_file(**point) for point in points)
            if not all(path.is_file() and path.stat().st_mtime <= finished for path in paths):
                marks.append(mark)
    return marks
