"""Run time and memory of jobs, from the files that Snakemake's benchmark directive writes."""

from __future__ import annotations

import csv
from collections.abc import Iterable, Iterator
from contextlib import suppress
from pathlib import Path
from typing import NamedTuple


class JobCost(NamedTuple):
    """Wall and CPU time in seconds and the largest resident set in MB of a job; CPU and memory are 0 if unknown."""

    path: Path
    wall: float
    cpu: float
    memory: float


def read_costs(paths: Iterable[str | Path]) -> Iterator[JobCost]:
    """Yield the costs of the jobs in benchmark files; what cannot be read is left out: it is no result."""
    for path in map(Path, paths):
        with suppress(OSError, ValueError, KeyError, csv.Error), path.open(encoding="utf-8") as file:
            for row in csv.DictReader(file, delimiter="\t", restval=""):
                # A job that ends before the first look at it has NA or -.
                rest = (row.get(key, "") for key in ("cpu_time", "max_rss"))
                yield JobCost(path, float(row["s"]), *(float(text) if text[:1].isdigit() else 0.0 for text in rest))
