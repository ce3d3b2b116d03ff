"""The plan of a run, which is not in Snakemake's log: its jobs, their dependencies and stages, its results folder."""

from __future__ import annotations

from collections import defaultdict
from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any

from snakemake.logging import logger

from burridge_knopoff.outputs import benchmark_of, outputs, stage_of
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study
from snakemake_logger_plugin_study import internals
from snakemake_logger_plugin_study.durations import Durations, measured_seconds, run_seconds_of, work_of
from snakemake_logger_plugin_study.run import Job, Run


@dataclass
class Plan:
    """The plan of a study, which its Snakefile gives to the display, and its run once it begins.

    study : the study; results : folder of its results
    workflow : Snakemake's own object
    is_imported : whether another workflow imports the study, and may make files that are not of the study
    record : records that the study was run with its config, even if there is nothing to do
    """

    study: Study
    results: str
    workflow: Any
    is_imported: bool = False
    record: Callable[[], None] = lambda: None
    run: Run = field(default_factory=Run)

    def announce(self) -> None:
        """Plan the run that begins; if Snakemake's internals have changed, log a warning and plan nothing."""
        try:
            self.run = self.look_ahead()
        except Exception as error:
            logger.warning(f"the stages and the duration of this run cannot be determined: {error}")

    def look_ahead(self) -> Run:
        """Return the run of the planned jobs, those that make files, with their known durations."""
        stages = {rule: stage_of(self.study, rule) for rule in outputs()}
        requested, available = internals.requested_cores(self.workflow), internals.usable_cores(self.workflow)
        wanted, last = internals.requested_jobs(self.workflow), defaultdict(list)
        cores = min(requested, available)
        # If more are requested than there are, each thread of a busy run has a share of a core.
        share = cores / requested
        for job in wanted:
            if (seconds := measured_seconds(self._benchmark(job), share * job.threads)) is not None:
                last[job.rule.name].append(seconds)
        jobs = {
            number: Job(
                " ".join([job.rule.name, *(f"{name}={value}" for name, value in job.wildcards_dict.items())]),
                stages.get(job.rule.name, job.rule.name),
                job.rule.name,
                threads=min(int(job.threads), available),
                cores=share * job.threads,
                needs=frozenset(needs),
                benchmark=self._benchmark(job),
            )
            for number, job, needs in internals.planned_jobs(self.workflow)
        }
        return Run(
            self.results,
            jobs,
            {job.rule.name for job in wanted},
            Durations(work_of(self.study), last, run_seconds_of(self.study)),
            cores,
            f"on {format_count(cores, 'core')}",
            internals.is_touching(self.workflow),
            internals.newer_inputs(self.workflow),
        )

    def _benchmark(self, job: Any) -> str:
        """Return the file with the duration of a job of the study, by Snakemake or, for a point, by the job itself."""
        logs = [log.removeprefix(f"{self.results}/") for log in job.log if log.startswith(f"{self.results}/")]
        return str(job.benchmark or next((f"{self.results}/{benchmark_of(log)}" for log in logs), ""))
