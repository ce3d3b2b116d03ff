"""Run time and memory of each stage of a study, from the files that Snakemake's benchmark directive writes."""

from __future__ import annotations

import csv
import math
from dataclasses import dataclass
from pathlib import Path

#: The report cannot tell of the job that is writing it.
SKIPPED = ("report",)

#: The first letters of files that are one stage together, and its name.
JOINED = {"figure_": "figures"}


@dataclass
class Stage:
    """The jobs of one stage, as far as they were measured.

    wall, cpu : sums over the jobs, in seconds; cpu_jobs : jobs whose CPU time is known
    memory : the largest resident set of a job in MB, 0 if none is known
    """

    name: str
    jobs: int = 0
    wall: float = 0.0
    cpu: float = 0.0
    cpu_jobs: int = 0
    memory: float = 0.0


def read_stages(folder: str | Path) -> list[Stage]:
    """Return the stages of a folder of benchmark files, the longest wall time first; none if there is no folder.

    All files of a subfolder are one stage, and so is the file that has its name. A file that cannot be read is left
    out: it tells of a run time, not of a result.
    """
    folder = Path(folder)
    stages: dict[str, Stage] = {}
    for path in sorted(folder.rglob("*.tsv")):
        name = path.relative_to(folder).with_suffix("").parts[0]
        name = next((whole for start, whole in JOINED.items() if name.startswith(start)), name)
        if name in SKIPPED:
            continue
        for row in _rows(path):
            wall = _number(row.get("s"))
            if math.isnan(wall):
                continue
            stage = stages.setdefault(name, Stage(name))
            cpu = _number(row.get("cpu_time"))
            stage.jobs += 1
            stage.wall += wall
            # A job that ends before the first look at it has 0 or NA.
            if cpu > 0.0:
                stage.cpu += cpu
                stage.cpu_jobs += 1
            memory = _number(row.get("max_rss"))
            stage.memory = max(stage.memory, 0.0 if math.isnan(memory) else memory)
    return sorted(stages.values(), key=lambda stage: (-stage.wall, stage.name))


def _rows(path: Path) -> list[dict[str, str]]:
    try:
        with path.open(encoding="utf-8", newline="") as file:
            return list(csv.DictReader(file, delimiter="\t"))
    except (OSError, UnicodeDecodeError, csv.Error):
        return []


def _number(text: str | None) -> float:
    try:
        return float(text or "nan")
    except ValueError:
        return math.nan
