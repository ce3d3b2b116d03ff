"""What Snakemake's log does not tell of a run: its jobs and what they take, where its results lie, stages."""

from __future__ import annotations

from collections.abc import Iterable
from contextlib import suppress
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

from burridge_knopoff.study import Study
from snakemake_logger_plugin_study.durations import calibrate, shipped
from snakemake_logger_plugin_study.forecast import Forecast, PlannedJob
from snakemake_logger_plugin_study.past import read_past
from snakemake_logger_plugin_study.wording import job_name
from snakemake_logger_plugin_study.work import work_of


@dataclass
class Plan:
    """What the Snakefile says of the run that begins; empty before, and without hooks.

    results : folder of the study, once a run begins
    stages : {rule that makes files: its stage}, in the order of the rules
    forecast : of the jobs that are to run; None if it is not known
    speed : seconds of the calibration here for one where the shipped durations were measured
    """

    results: str = ""
    stages: dict[str, str] = field(default_factory=dict)
    forecast: Forecast | None = None
    speed: float = 1.0
    _study: tuple[str, Any, Study] | None = None

    def describe(self, results: str, workflow: Any, study: Study) -> None:
        """Take note of a study, whether it is to run or not.

        workflow : Snakemake's own. No event and nothing documented lists rules with their files, and jobs with what
            they need: this is the one place that looks inside Snakemake.
        """
        self._study = results, workflow, study

    def announce(self) -> None:
        """Take note of a run that begins; a warning tells if Snakemake's inside is another one, and no time is told."""
        from snakemake.logging import logger

        assert self._study is not None
        self.results, workflow, _ = self._study
        try:
            rules = list(workflow.rules)
            self.stages = {rule.name: stage(rule, rules) for rule in rules if rule.output}
            self.look_ahead()
        except Exception as error:
            logger.warning(f"the stages of this run, and its time, cannot be told: {error}")

    def look_ahead(self) -> Forecast | None:
        """Forecast the jobs that are to run, from those of earlier runs and from what the tree ships."""
        if self._study is None:
            return None
        results, workflow, study = self._study
        jobs = planned_jobs(workflow, study)
        history = read_past(results)
        durations = shipped()
        if jobs and not history:
            # Without a kernel nothing can run, but what is to run can be seen.
            with suppress(ImportError):
                self.speed = calibrate() / durations.calibration
        self.forecast = Forecast(jobs, durations, self.speed, history)
        return self.forecast


def planned_jobs(workflow: Any, study: Study) -> dict[int, PlannedJob]:
    """Return {number: job} of the jobs that make files, of a Snakemake that knows which are to run."""
    dag = workflow.dag
    numbers = {job: dag.jobid(job) for job in dag.needrun_jobs(exclude_finished=False) if job.output}
    planned = {}
    for job, number in numbers.items():
        kind, work = work_of(study, job.rule.name, job.wildcards_dict, job.params.get("kept"))
        needs = frozenset(numbers[need] for need in dag.dependencies[job] if need in numbers)
        name = job_name(job.rule.name, job.wildcards_dict)
        planned[number] = PlannedJob(name, kind, work, int(job.threads), float(job.priority), needs)
    return planned


def stage(rule: Any, rules: Iterable[Any]) -> str:
    """Return the stage of a rule: a file of rules is one, named after its first rule that only gathers, or the file."""
    names = [other.name for other in rules if other.snakefile == rule.snakefile and not other.output]
    return str(names[0] if names else Path(str(rule.snakefile)).stem)


#: The Snakefile and the display are in one process.
PLAN = Plan()
