"""What Snakemake's log does not tell of a run: where its results lie, and the stage of each rule."""

from __future__ import annotations

import re
from collections.abc import Iterable
from dataclasses import dataclass, field
from glob import iglob
from itertools import islice
from pathlib import Path
from typing import Any

from burridge_knopoff.study.job_costs import read_costs

#: Benchmark files of a rule that are read for its mean duration.
MOST_BENCHMARKS = 200


@dataclass
class Plan:
    """What the Snakefile says of the run that begins; empty before, and without hooks.

    results : folder of the study
    stages : {rule that makes files: its stage}, in the order of the rules
    benchmarks : {rule: pattern of its benchmark files}
    """

    results: str = ""
    stages: dict[str, str] = field(default_factory=dict)
    benchmarks: dict[str, str] = field(default_factory=dict)

    def announce(self, results: str, rules: Iterable[Any]) -> None:
        """Take note of a run that begins.

        rules : `workflow.rules` of Snakemake. No event and nothing documented lists rules with their files: this is the
            one place that looks inside Snakemake. If that fails a warning tells, and each rule is a stage.
        """
        from snakemake.logging import logger

        self.results = results
        try:
            rules = list(rules)
            self.benchmarks = {rule.name: re.sub(r"\{[^}]*\}", "*", str(rule.benchmark or "")) for rule in rules}
            self.stages = {rule.name: stage(rule, rules) for rule in rules if rule.output}
        except Exception as error:
            logger.warning(f"the stages of this run cannot be told: {error}")

    def last_duration(self, rule: str) -> float | None:
        """Return the mean seconds of a job of this rule by the benchmark files there are; None if there is none."""
        seconds = [job.wall for job in read_costs(islice(iglob(self.benchmarks.get(rule, "")), MOST_BENCHMARKS))]
        return sum(seconds) / len(seconds) if seconds else None


def stage(rule: Any, rules: Iterable[Any]) -> str:
    """Return the stage of a rule: a file of rules is one, named after its first rule that only gathers, or the file."""
    names = [other.name for other in rules if other.snakefile == rule.snakefile and not other.output]
    return str(names[0] if names else Path(str(rule.snakefile)).stem)


#: The Snakefile and the display are in one process.
PLAN = Plan()
