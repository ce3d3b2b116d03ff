"""Run time and memory of jobs, from the files that Snakemake's benchmark directive writes."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from pathlib import Path


@dataclass(frozen=True)
class JobCost:
    """Wall and CPU time in seconds and the largest resident set in MB of a job; CPU and memory are 0 if unknown."""

    path: Path
    wall: float
    cpu: float
    memory: float


def read_costs(paths: Iterable[str | Path]) -> Iterator[JobCost]:
    """Yield the costs of the jobs in benchmark files; what cannot be read is left out: it is no result."""
    for path in map(Path, paths):
        try:
            with path.open(encoding="utf-8", newline="") as file:
                rows = list(csv.DictReader(file, delimiter="\t"))
        except (OSError, UnicodeDecodeError, csv.Error):
            continue
        for row in rows:
            wall, cpu, memory = (_number(row.get(key)) for key in ("s", "cpu_time", "max_rss"))
            if wall is not None:
                yield JobCost(path, wall, cpu or 0.0, memory or 0.0)


def _number(text: str | None) -> float | None:
    # A job that ends before the first look at it has NA or -.
    try:
        return float(text or "")
    except ValueError:
        return None
