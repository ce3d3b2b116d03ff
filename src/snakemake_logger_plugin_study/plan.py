"""The plan of a run, which is not in Snakemake's log: its jobs, their dependencies and stages, its results folder."""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Callable, Mapping
from dataclasses import dataclass, field
from typing import Any

from snakemake.logging import logger

from burridge_knopoff.running.cores import available_cores
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.study import Study
from snakemake_logger_plugin_study.durations import Durations, measured_seconds, work_of
from snakemake_logger_plugin_study.run import Job, Run


@dataclass
class Plan:
    """The plan of a study, which the Snakefile fills in, and its run once it begins.

    results : folder of its results
    workflow : Snakemake's own object: no event contains the dependencies of jobs
    study : the study itself; None in another workflow
    files : {file that the workflow makes, except points: its rule}; empty if another workflow imports the study
    refusals : {rule or file that the study does not have: why}
    stages : {rule: its stage}
    record : records that the study was run with its config, even if there is nothing to do
    """

    results: str = ""
    workflow: Any = None
    study: Study | None = None
    files: Mapping[str, str] = field(default_factory=dict)
    refusals: Mapping[str, str] = field(default_factory=dict)
    stages: Mapping[str, str] = field(default_factory=dict)
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
        assert self.study is not None
        dag, last = self.workflow.dag, defaultdict(list)
        requested = self.workflow.resource_settings.cores or 1
        available = available_cores() if self.workflow.local_exec else sys.maxsize
        cores = min(requested, available)
        # If more are requested than there are, each thread of a busy run has a share of a core.
        share = cores / requested
        for job in dag.jobs:
            if job.benchmark and (seconds := measured_seconds(job.benchmark, share * job.threads)) is not None:
                last[job.rule.name].append(seconds)
        order = {rule.name: place for place, rule in enumerate(self.workflow.rules)}
        numbers = {job: dag.jobid(job) for job in dag.needrun_jobs(exclude_finished=False) if job.output}
        jobs = {
            numbers[job]: Job(
                " ".join([job.rule.name, *(f"{name}={value}" for name, value in job.wildcards_dict.items())]),
                self.stages.get(job.rule.name, job.rule.name),
                job.rule.name,
                threads=min(int(job.threads), available),
                cores=share * job.threads,
                needs=frozenset(numbers[need] for need in dag.dependencies[job] if need in numbers),
                benchmark=str(job.benchmark or ""),
            )
            for job in sorted(numbers, key=lambda job: (order[job.rule.name], numbers[job]))
        }
        return Run(
            self.results,
            jobs,
            {job.rule.name for job in dag.jobs},
            Durations(work_of(self.study), last),
            cores,
            f"on {format_count(cores, 'core')}",
            self.workflow.touch,
            # Inputs that other jobs are about to make are not among them.
            sorted({file for why in map(dag.reason, numbers) for file in why.updated_input - why.updated_input_run}),
        )


#: Shared by the Snakefile and the display, which are in one process.
PLAN = Plan()
