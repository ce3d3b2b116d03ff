"""Run time and memory of each stage of a study, from Snakemake's benchmark files."""

from __future__ import annotations

import csv
from collections.abc import Iterator
from contextlib import suppress
from dataclasses import dataclass
from pathlib import Path

from burridge_knopoff.provenance.files import read_regular

#: The job that writes the report has not ended when the report is written.
SKIPPED = ("report",)

#: Prefixes of files that form one stage, with its name.
JOINED = {"figure_": "figures"}

#: Snakemake's unit of memory, in MB.
MEBIBYTE = 1.048576


@dataclass
class Stage:
    """The measured jobs of one stage.

    wall, cpu : sums over the jobs, in seconds; cpu_jobs : number of jobs with a known CPU time
    memory : largest memory of a job, in MB, at least that of its largest process; 0 if it was not measured. What its
        processes share counts once if the system reports it, and otherwise for each process
    """

    name: str
    jobs: int = 0
    wall: float = 0.0
    cpu: float = 0.0
    cpu_jobs: int = 0
    memory: float = 0.0


def read_stages(folder: str | Path) -> list[Stage]:
    """Return the stages in a folder of benchmark files, longest wall time first; none if there is no folder.

    The files of a subfolder form one stage, together with the file of the same name; those of all figures form one.
    """
    stages: dict[str, Stage] = {}
    for path in sorted(Path(folder).rglob("*.tsv")):
        name = path.relative_to(folder).with_suffix("").parts[0]
        name = next((whole for start, whole in JOINED.items() if name.startswith(start)), name)
        for wall, cpu, memory in job_costs(path) if name not in SKIPPED else ():
            stage = stages.setdefault(name, Stage(name))
            stage.jobs += 1
            stage.wall += wall
            stage.cpu += cpu
            stage.cpu_jobs += cpu > 0.0
            stage.memory = max(stage.memory, memory)
    return sorted(stages.values(), key=lambda stage: (-stage.wall, stage.name))


def job_costs(path: Path) -> Iterator[tuple[float, float, float]]:
    """Yield wall time and CPU time in seconds and memory in MB of the jobs in a file, except unreadable lines."""
    with suppress(OSError, ValueError, KeyError, csv.Error):
        for row in csv.DictReader(read_regular(path).decode().splitlines(), delimiter="\t", restval=""):
            # A job that ends before it is first measured has NA or -.
            rest = (row.get(key, "") for key in ("cpu_time", "max_pss", "max_rss"))
            cpu, shared_once, resident = (float(text) if text[:1].isdigit() else 0.0 for text in rest)
            yield float(row["s"]), cpu, MEBIBYTE * (shared_once or resident)
