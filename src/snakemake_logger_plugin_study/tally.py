"""The state of a run: jobs of each stage, and an honest time left."""

from __future__ import annotations

from collections import Counter
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field


@dataclass
class Rule:
    """The jobs of one rule.

    stage : name of the stage that the rule belongs to
    total : number of jobs that are to run
    threads : cores that a job takes
    needs : rules whose jobs come before
    last : mean duration of a job in the last run, in seconds; None if it is not known
    """

    stage: str
    total: int
    threads: int = 1
    needs: tuple[str, ...] = ()
    last: float | None = None
    done: int = 0
    failed: int = 0
    blocked: int = 0
    running: dict[int, float] = field(default_factory=dict)
    seconds: float = 0.0
    timed: int = 0

    @property
    def duration(self) -> float | None:
        """Mean duration of a job: of those finished in this run, else of the last run; None if unknown."""
        return self.seconds / self.timed if self.timed else self.last

    @property
    def left(self) -> int:
        """Number of jobs that run or will run."""
        return max(self.total - self.done - self.failed - self.blocked, 0)


@dataclass(frozen=True)
class Count:
    """Jobs of a stage, or of all stages."""

    name: str
    done: int
    total: int
    running: int


@dataclass(frozen=True)
class TimeLeft:
    """Seconds left; `complete` is False if rules of unknown duration come on top."""

    seconds: float
    complete: bool


class Tally:
    """Counts the jobs of a run and estimates how long it still takes; times are in seconds since any fixed moment."""

    def __init__(self) -> None:
        self.rules: dict[str, Rule] = {}
        self.cores: float = 1
        self._rule_of: dict[int, str] = {}
        self._dependents: Mapping[int, Iterable[int]] = {}
        self._messages: dict[int, str] = {}
        self._failed: set[int] = set()

    def expect(
        self, rules: Mapping[str, Rule], rule_of: Mapping[int, str], dependents: Mapping[int, Iterable[int]]
    ) -> None:
        """Set what is to run.

        rule_of : {job: rule}
        dependents : {job: jobs that need it}
        """
        self.rules = dict(rules)
        self._rule_of = dict(rule_of)
        self._dependents = dependents

    def expect_counts(self, counts: Mapping[str, int]) -> None:
        """Set what is to run from the number of jobs of each rule alone; each rule is a stage then."""
        self.rules = {name: Rule(name, total) for name, total in counts.items()}

    def start(self, job: int, rule: str, now: float, threads: int = 1, message: str = "") -> None:
        """Count a job as running, also one that failed and is tried again; a rule that was not expected is added."""
        known = self.rules.setdefault(rule, Rule(rule, 0))
        self._rule_of[job] = rule
        known.running[job] = now
        known.threads = threads
        self._messages[job] = message
        if job in self._failed:
            self._failed.remove(job)
            self._find_blocked()
        known.total = max(known.total, known.done + known.failed + known.blocked + len(known.running))

    def finish(self, job: int, now: float, timed: bool = True) -> None:
        """Count a job as done.

        timed : False if the time since its start says nothing about its duration
        """
        rule, start = self._end(job)
        if rule is None or start is None:
            return
        rule.done += 1
        if timed:
            rule.seconds += now - start
            rule.timed += 1

    def fail(self, job: int) -> None:
        """Count a job as failed, and all that need it as blocked."""
        rule, start = self._end(job)
        if rule is None or start is None:
            return
        self._failed.add(job)
        self._find_blocked()

    def _end(self, job: int) -> tuple[Rule | None, float | None]:
        rule = self.rules.get(self._rule_of.get(job, ""))
        self._messages.pop(job, None)
        return rule, rule.running.pop(job, None) if rule else None

    def _find_blocked(self) -> None:
        blocked: set[int] = set()
        waiting = [job for failed in self._failed for job in self._dependents.get(failed, ())]
        while waiting:
            job = waiting.pop()
            if job not in blocked:
                blocked.add(job)
                waiting.extend(self._dependents.get(job, ()))
        failed_of, blocked_of = (Counter(self._rule_of[job] for job in jobs) for jobs in (self._failed, blocked))
        for name, rule in self.rules.items():
            rule.failed, rule.blocked = failed_of[name], blocked_of[name]

    def stages(self) -> list[Count]:
        """Return the counts of each stage, in the order of the rules."""
        names = dict.fromkeys(rule.stage for rule in self.rules.values())
        return [self._count(name, [rule for rule in self.rules.values() if rule.stage == name]) for name in names]

    def total(self) -> Count:
        """Return the counts of all stages."""
        return self._count("all", self.rules.values())

    @staticmethod
    def _count(name: str, rules: Iterable[Rule]) -> Count:
        rules = list(rules)
        return Count(
            name,
            sum(rule.done for rule in rules),
            sum(rule.total for rule in rules),
            sum(len(rule.running) for rule in rules),
        )

    @property
    def failed(self) -> int:
        """Number of jobs that failed."""
        return sum(rule.failed for rule in self.rules.values())

    @property
    def blocked(self) -> int:
        """Number of jobs that cannot run because others failed."""
        return sum(rule.blocked for rule in self.rules.values())

    def running(self, now: float, longer: float) -> list[tuple[str, float]]:
        """Return (message, seconds so far) of the jobs that have been running longer than that, the oldest first."""
        jobs = [(job, now - start) for rule in self.rules.values() for job, start in rule.running.items()]
        return [
            (self._messages.get(job) or self._rule_of[job], seconds)
            for job, seconds in sorted(jobs, key=lambda item: -item[1])
            if seconds > longer
        ]

    def time_left(self, now: float) -> TimeLeft | None:
        """Return how long the run still takes, or None if no duration is known.

        The larger of two lower bounds: all work spread over the cores, and the longest chain of rules that need each
        other, one job each. The scheduler fills the cores, so the truth is near them.
        """
        work = 0.0
        complete, known = True, False
        longest: dict[str, float] = {}
        for name, rule in self.rules.items():
            if not rule.left:
                continue
            if rule.duration is None:
                complete = False
                continue
            known = True
            begun = [max(rule.duration - (now - start), 0.0) for start in rule.running.values()]
            waiting = max(rule.left - len(begun), 0)
            work += min(rule.threads, self.cores) * (waiting * rule.duration + sum(begun))
            longest[name] = rule.duration if waiting else max(begun)
        if not known:
            return None
        chains: dict[str, float] = {}
        for name in self.rules:
            self._chain(name, longest, chains)
        return TimeLeft(max(work / max(self.cores, 1), *chains.values()), complete)

    def _chain(self, name: str, longest: Mapping[str, float], chains: dict[str, float]) -> float:
        """Return the time of the longest chain of rules up to this one; `chains` keeps those found before."""
        if name not in chains:
            before = [self._chain(need, longest, chains) for need in self.rules[name].needs if need in self.rules]
            chains[name] = longest.get(name, 0.0) + max(before, default=0.0)
        return chains[name]
