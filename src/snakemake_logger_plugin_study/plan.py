"""The plan of a run, which is not in Snakemake's log: its jobs, their dependencies and stages, its results folder."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from snakemake.logging import logger

from burridge_knopoff.study.study import Study
from snakemake_logger_plugin_study.durations import Durations, measured_seconds, work_of
from snakemake_logger_plugin_study.private import all_jobs, is_touching, needs, planned_jobs
from snakemake_logger_plugin_study.run import Job, Run


@dataclass
class Plan:
    """The plan of a study, which the Snakefile fills in, and its run once it begins.

    results, config, checkout : folder of its results, config file, and checkout of the workflow
    study : the study itself; None in another workflow
    files : {file of the study that the workflow makes, except points: its rule}
    rules : {rule: params function of its jobs, with their `stage`, and the `refusal` if the study does not have them}
    first : rules of the figures that are announced as soon as they are drawn
    record : records that the study was run with its config, even if there is nothing to do
    workflow : Snakemake's own object: no event contains the dependencies of jobs
    """

    results: str = ""
    workflow: Any = None
    study: Study | None = None
    files: Mapping[str, str] = field(default_factory=dict)
    rules: Mapping[str, Any] = field(default_factory=dict)
    record: Callable[[], None] = lambda: None
    first: list[str] = field(default_factory=list)
    run: Run = field(default_factory=Run)
    config: str = ""
    checkout: Path = Path()

    def announce(self) -> None:
        """Plan the run that begins; if Snakemake's internals have changed, log a warning and plan nothing."""
        try:
            self.run = self.look_ahead()
        except Exception as error:
            self.run = Run(self.results)
            logger.warning(f"the stages and the duration of this run cannot be determined: {error}")

    def look_ahead(self) -> Run:
        """Return the run of the planned jobs, with their known durations."""
        if self.study is None:
            return Run()
        wanted = {job.rule.name for job in all_jobs(self.workflow)}
        durations = Durations(work_of(self.study), self._last())
        return Run(self.results, self._jobs(), wanted, durations, touching=is_touching(self.workflow))

    def _last(self) -> dict[str, list[float]]:
        """Return {rule: seconds of each of its jobs in the last run, times their threads}."""
        last = defaultdict(list)
        for job in all_jobs(self.workflow):
            if job.benchmark and (seconds := measured_seconds(job.benchmark, int(job.threads))) is not None:
                last[job.rule.name].append(seconds)
        return last

    def _jobs(self) -> dict[int, Job]:
        """Return {number: job} of the jobs that make files, in the order of the rules."""
        order = {rule.name: place for place, rule in enumerate(self.workflow.rules)}
        numbers = {job: number for number, job in planned_jobs(self.workflow).items()}
        return {
            numbers[job]: Job(
                " ".join([job.rule.name, *(f"{name}={value}" for name, value in job.wildcards_dict.items())]),
                getattr(self.rules.get(job.rule.name), "stage", job.rule.name),
                job.rule.name,
                threads=int(job.threads),
                priority=float(job.priority),
                needs=frozenset(numbers[need] for need in needs(self.workflow, job) if need in numbers),
                benchmark=str(job.benchmark or ""),
            )
            for job in sorted(numbers, key=lambda job: (order[job.rule.name], numbers[job]))
        }


#: Shared by the Snakefile and the display, which are in one process.
PLAN = Plan()
