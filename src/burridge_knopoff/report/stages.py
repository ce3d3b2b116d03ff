"""Run time and memory of each stage of a study."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from burridge_knopoff.study.job_costs import read_costs

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

    All files of a subfolder are one stage, and so is the file that has its name.
    """
    stages: dict[str, Stage] = {}
    for job in read_costs(sorted(Path(folder).rglob("*.tsv"))):
        name = job.path.relative_to(folder).with_suffix("").parts[0]
        name = next((whole for start, whole in JOINED.items() if name.startswith(start)), name)
        if name not in SKIPPED:
            stage = stages.setdefault(name, Stage(name))
            stage.jobs += 1
            stage.wall += job.wall
            stage.cpu += job.cpu
            stage.cpu_jobs += job.cpu > 0.0
            stage.memory = max(stage.memory, job.memory)
    return sorted(stages.values(), key=lambda stage: (-stage.wall, stage.name))
