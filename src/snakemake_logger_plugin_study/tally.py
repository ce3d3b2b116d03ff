"""The state of a run: jobs of each stage, and an honest time left."""

from __future__ import annotations

from collections.abc import Mapping, Set
from dataclasses import dataclass, field
from typing import NamedTuple

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
    last : mean duration of a job in the last run, in seconds; None if it is not known
    needs : rules whose jobs come before
    threads : cores that a job takes
    jobs : {number: job} of those that have begun
    """

    stage: str
    total: int
    last: float | None = None
    needs: frozenset[str] = frozenset()
    threads: int = 1
    jobs: dict[int, Job] = field(default_factory=dict)

    def count(self, state: str) -> int:
        """Return the number of jobs in a state."""
        return sum(job.state == state for job in self.jobs.values())

    @property
    def duration(self) -> float | None:
        """Mean duration of a job: of those finished in this run, else of the last run; None if unknown."""
        seconds = [job.end - job.begin for job in self.jobs.values() if job.state == DONE and job.timed]
        return sum(seconds) / len(seconds) if seconds else self.last


class Count(NamedTuple):
    """Jobs of a stage, or of all stages."""

    name: str
    done: int
    total: int
    running: int


class TimeLeft(NamedTuple):
    """Seconds left; `complete` is False if rules of unknown duration come on top."""

    seconds: float
    complete: bool


def downstream(names: Set[str], needs: Mapping[str, Set[str]]) -> set[str]:
    """Return the rules that come after some of these, given what each rule needs."""
    found: set[str] = set()
    while more := {name for name, own in needs.items() if own & (names | found)} - found:
        found |= more
    return found


class Tally:
    """Counts the jobs of a run and estimates how long it still takes; times are in seconds since any fixed moment."""

    def __init__(self, rules: Mapping[str, Rule] | None = None, cores: float = 1) -> None:
        self.rules = dict(rules or {})
        self.cores = cores

    def start(self, number: int, rule: str, job: Job, threads: int = 1) -> None:
        """Count a job as running, also one that failed and is tried again; a rule that was not expected is added."""
        known = self.rules.setdefault(rule, Rule(rule, 0))
        known.jobs[number] = job
        known.threads = threads
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
        after = downstream(failed, {name: rule.needs for name, rule in self.rules.items()})
        return {name: self.rules[name].total - len(self.rules[name].jobs) for name in after}

    def time_left(self, now: float) -> TimeLeft | None:
        """Return how long the run still takes, or None if no duration is known.

        The larger of two lower bounds: all work spread over the cores, and the longest chain of rules that need each
        other, one job each. The scheduler fills the cores, so the truth is near them.
        """
        blocked = self.blocked()
        work, complete = 0.0, True
        longest: dict[str, float] = {}
        for name, rule in self.rules.items():
            begins = [job.begin for job in rule.jobs.values() if job.state == RUNNING]
            waiting = rule.total - len(rule.jobs) - blocked.get(name, 0)
            if not (begins or waiting):
                continue
            duration = rule.duration
            if duration is None:
                complete = False
                continue
            begun = [max(duration - (now - begin), 0.0) for begin in begins]
            work += min(rule.threads, self.cores) * (waiting * duration + sum(begun))
            longest[name] = duration if waiting else max(begun)
        if not longest:
            return None
        chains: dict[str, float] = {}
        for name in self.rules:
            self._chain(name, longest, chains)
        return TimeLeft(max(work / max(self.cores, 1), *chains.values()), complete)

    def _chain(self, name: str, longest: Mapping[str, float], chains: dict[str, float]) -> float:
        """Return the time of the longest chain of rules up to this one; `chains` keeps those found before."""
        if name not in chains:
            # In case that rules need each other in a circle.
            chains[name] = 0.0
            before = [self._chain(need, longest, chains) for need in self.rules[name].needs if need in self.rules]
            chains[name] = longest.get(name, 0.0) + max(before, default=0.0)
        return chains[name]
