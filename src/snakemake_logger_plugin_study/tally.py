"""The state of a run: jobs of each stage, and the time left."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import NamedTuple

from snakemake_logger_plugin_study.forecast import Forecast, downstream, following

#: Seconds for which a time left that was worked out is only counted down.
FRESH = 2.0

RUNNING, DONE, FAILED = "running", "done", "failed"
#: The name of all stages together.
ALL = "all"


@dataclass
class Job:
    """A job that has begun; `timed` is False if its begin and end say nothing about its duration."""

    name: str
    begin: float
    message: str = ""
    output: tuple[str, ...] = ()
    log: tuple[str, ...] = ()
    timed: bool = True
    state: str = RUNNING
    end: float = 0.0


@dataclass
class Rule:
    """The jobs of one rule.

    total : number of jobs that are to run
    needs : rules whose jobs come before
    jobs : {number: job} of those that have begun
    """

    stage: str
    total: int
    needs: frozenset[str] = frozenset()
    jobs: dict[int, Job] = field(default_factory=dict)

    def count(self, state: str) -> int:
        """Return the number of jobs in a state."""
        return sum(job.state == state for job in self.jobs.values())


class Count(NamedTuple):
    """Jobs of a stage, or of all stages."""

    name: str
    done: int
    total: int
    running: int


class Tally:
    """Counts the jobs of a run and tells how long it still takes; times are in seconds since any fixed moment."""

    def __init__(
        self, rules: Mapping[str, Rule] | None = None, cores: float = 1, forecast: Forecast | None = None
    ) -> None:
        self.rules = dict(rules or {})
        self.cores = cores
        self.forecast = forecast
        self._told: tuple[float, float] | None = None

    def start(self, number: int, rule: str, job: Job) -> None:
        """Count a job as running, also one that failed and is tried again; a rule that was not expected is added."""
        known = self.rules.setdefault(rule, Rule(rule, 0))
        known.jobs[number] = job
        known.total = max(known.total, len(known.jobs))

    def job(self, number: int) -> Job | None:
        """Return a job that has begun."""
        return next((rule.jobs[number] for rule in self.rules.values() if number in rule.jobs), None)

    def end(self, number: int, state: str, now: float = 0.0) -> None:
        """Count a job as done or failed, if it has begun."""
        if job := self.job(number):
            job.state, job.end = state, now

    def counts(self) -> list[Count]:
        """Return the counts of each stage, in the order of the rules, and at last those of all."""
        counts = []
        for name in [*dict.fromkeys(rule.stage for rule in self.rules.values()), ALL]:
            rules = [rule for rule in self.rules.values() if name in (rule.stage, ALL)]
            done, running = (sum(rule.count(state) for rule in rules) for state in (DONE, RUNNING))
            counts.append(Count(name, done, sum(rule.total for rule in rules), running))
        return counts

    def jobs(self, state: str) -> list[Job]:
        """Return the jobs in a state, in the order of the rules."""
        return [job for rule in self.rules.values() for job in rule.jobs.values() if job.state == state]

    def blocked(self) -> dict[str, int]:
        """Return {rule: jobs that cannot run because jobs failed}: what has not begun of all rules after theirs.

        The log tells which rules need each other, not which jobs: one that needs no failed job counts until it begins.
        """
        failed = {name for name, rule in self.rules.items() if rule.count(FAILED)}
        after = downstream(failed, following({name: rule.needs for name, rule in self.rules.items()}))
        return {name: self.rules[name].total - len(self.rules[name].jobs) for name in after}

    def time_left(self, now: float) -> float | None:
        """Return how long the run still takes, in seconds, or None if no forecast is known."""
        if self.forecast is None:
            return None
        if self._told is None or not 0.0 <= now - self._told[0] < FRESH:
            begun = {number: job for rule in self.rules.values() for number, job in rule.jobs.items()}
            running = {number: job.begin for number, job in begun.items() if job.state == RUNNING}
            done = {
                number: job.end - job.begin if job.timed else float("inf")
                for number, job in begun.items()
                if job.state == DONE
            }
            failed = [number for number, job in begun.items() if job.state == FAILED]
            self._told = now, self.forecast.time_left(now, self.cores, running, done, failed)
        told, seconds = self._told
        return max(seconds - (now - told), 0.0)
