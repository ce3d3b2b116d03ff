"""What a run is about to do, told by the Snakefile to the display: stages, jobs, and how long such jobs took last."""

from __future__ import annotations

from collections import Counter
from pathlib import Path
from typing import Any

from snakemake_logger_plugin_study.tally import Rule

#: Benchmark files of a rule that are read for its mean duration.
MOST_BENCHMARKS = 200


def announce(workflow: Any) -> None:
    """Log how many jobs of each stage are to run, with the plan for the display.

    workflow : of Snakemake, with its jobs known, as in `onstart`

    Raises nothing: a run can do without.
    """
    from snakemake.logging import logger

    try:
        rules, rule_of, dependents = plan(workflow)
    except Exception as error:
        logger.warning(f"the stages of this run cannot be told: {error}")
        return
    amounts: Counter[str] = Counter()
    for rule in rules.values():
        amounts[rule.stage] += rule.total
    jobs = f"{len(rule_of)} {'job' if len(rule_of) == 1 else 'jobs'}"
    message = f"{jobs}: {', '.join(f'{stage} {amount}' for stage, amount in amounts.items())}"
    logger.info(message, extra={"plan": (rules, rule_of, dependents)})


def plan(workflow: Any) -> tuple[dict[str, Rule], dict[int, str], dict[int, list[int]]]:
    """Return {rule: its jobs}, {job: rule} and {job: jobs that need it} of all that is to run."""
    stage_of = stages(workflow.rules)
    dag = workflow.dag
    # Targets such as `all` have no output: they are no work.
    planned = {dag.jobid(job): job for job in dag.needrun_jobs() if job.rule.output}
    rule_of = {number: job.rule.name for number, job in planned.items()}
    counts = Counter(rule_of.values())
    needs: dict[str, set[str]] = {name: set() for name in counts}
    dependents: dict[int, list[int]] = {}
    for number, job in planned.items():
        for dependency in dag.dependencies[job]:
            needs[job.rule.name].add(dependency.rule.name)
            dependents.setdefault(dag.jobid(dependency), []).append(number)
    benchmarks: dict[str, list[str]] = {}
    for job in dag.jobs:
        if job.benchmark is not None:
            benchmarks.setdefault(job.rule.name, []).append(str(job.benchmark))
    rules = {
        rule.name: Rule(
            stage_of[rule.name],
            counts[rule.name],
            needs=tuple(sorted(needs[rule.name])),
            last=mean_duration(benchmarks.get(rule.name, [])),
        )
        for rule in workflow.rules
        if rule.name in counts
    }
    for job in planned.values():
        rules[job.rule.name].threads = job.threads
    return rules, rule_of, dependents


def stages(rules: Any) -> dict[str, str]:
    """Return {rule: stage}: a file of rules is a stage, named after its rule that only gathers, else as the file."""
    rules = list(rules)
    name_of = {str(rule.snakefile): Path(str(rule.snakefile)).stem for rule in rules}
    for rule in reversed(rules):
        if not rule.output:
            name_of[str(rule.snakefile)] = rule.name
    return {rule.name: name_of[str(rule.snakefile)] for rule in rules}


def mean_duration(benchmarks: list[str]) -> float | None:
    """Return the mean number of seconds in these benchmark files of Snakemake, None if there is none to be read."""
    seconds = []
    for path in benchmarks[:MOST_BENCHMARKS]:
        try:
            with open(path, encoding="utf-8") as file:
                file.readline()
                seconds.append(float(file.readline().split("\t")[0]))
        except (OSError, ValueError):
            continue
    return sum(seconds) / len(seconds) if seconds else None
