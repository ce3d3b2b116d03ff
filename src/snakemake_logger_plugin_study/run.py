"""A run: its jobs, how far they are, and when they end."""

from __future__ import annotations

import heapq
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from snakemake_logger_plugin_study.durations import Durations

WAITING, RUNNING, DONE, FAILED = "waiting", "running", "done", "failed"
#: Seconds for which a forecast holds.
FRESH = 2.0


@dataclass
class Job:
    """A job that makes files: what is planned and, from `state` on, what became of it.

    needs : numbers of the jobs that come before
    benchmark : the file that Snakemake writes with its duration
    seconds : how long it took, times its threads; None if it has not finished, or nothing measured it
    """

    name: str
    stage: str
    rule: str = ""
    threads: int = 1
    priority: float = 0.0
    needs: frozenset[int] = frozenset()
    benchmark: str = ""
    state: str = WAITING
    begin: float = 0.0
    seconds: float | None = None
    message: str = ""
    output: Sequence[str] = ()
    log: Sequence[str] = ()


@dataclass
class Run:
    """The jobs of a run. A display reads it in a thread of its own, while jobs begin and end.

    results : folder of the study
    jobs : {number: job}, in the order of the stages
    wanted : rules of all files that the run is to make or has found up to date
    durations : how long jobs take, as known before any has begun
    stopping : whether Ctrl-C has ended it
    """

    results: str = ""
    jobs: Mapping[int, Job] = field(default_factory=dict)
    wanted: Collection[str] = ()
    durations: Durations = field(default_factory=Durations)
    cores: float = 1.0
    stopping: bool = False
    _told: tuple[float, float] | None = None

    def job(self, number: int, rule: str) -> Job:
        """Return a job, also one that was not planned."""
        if number not in self.jobs:
            # Another thread may walk through the old mapping.
            self.jobs = {**self.jobs, number: Job(rule, rule, rule)}
        return self.jobs[number]

    def of(self, state: str) -> list[Job]:
        """Return the jobs in a state."""
        return [job for job in self.jobs.values() if job.state == state]

    def counts(self) -> list[tuple[str, Counter[str]]]:
        """Return (stage, jobs in each state) of each stage, and at last of all."""
        stages: dict[str, Counter[str]] = defaultdict(Counter)
        for job in self.jobs.values():
            stages[job.stage][job.state] += 1
        return [*stages.items(), ("all", sum(stages.values(), Counter()))]

    def blocked(self) -> set[int]:
        """Return the numbers of the jobs that cannot run because others failed."""
        failed = {number for number, job in self.jobs.items() if job.state == FAILED}
        found = set(failed)
        while more := {number for number, job in self.jobs.items() if not job.needs.isdisjoint(found)} - found:
            found |= more
        return found - failed

    def time_left(self, now: float) -> float:
        """Return how long the run still takes, in seconds, counted down from what was told a moment ago."""
        if self._told is None or not 0.0 <= now - self._told[0] < FRESH:
            self._told = now, self.forecast(now)
        told, seconds = self._told
        return max(seconds - (now - told), 0.0)

    def forecast(self, now: float) -> float:
        """Return how long the run still takes, in seconds, as a scheduler would run its jobs that fills all cores."""
        expected, blocked = self.expected(), self.blocked()
        left = {
            number: job
            for number, job in self.jobs.items()
            if job.state == RUNNING or (job.state == WAITING and number not in blocked)
        }
        seconds = {number: expected[job.rule] / job.threads for number, job in left.items()}
        ends = {
            number: max(0.0, seconds.pop(number) - (now - job.begin))
            for number, job in left.items()
            if job.state == RUNNING
        }
        return max(schedule(left, seconds, self.cores, ends).values(), default=0.0)

    def expected(self) -> dict[str, float]:
        """Return {rule: expected seconds of a job, times its threads}."""
        finished: dict[str, list[float]] = defaultdict(list)
        for job in self.jobs.values():
            if job.seconds is not None:
                finished[job.rule].append(job.seconds)
        return self.durations.expected({job.rule for job in self.jobs.values()}, finished)


def schedule(
    jobs: Mapping[int, Job], seconds: Mapping[int, float], cores: float, at_work: Mapping[int, float] | None = None
) -> dict[int, float]:
    """Return {job: when it ends}, as a scheduler runs jobs that fills all cores: by priority, then in their order.

    jobs : {number: job}; of what a job needs only these are waited for
    seconds : of those that have not begun; at_work : when the others end
    """
    missing = {number: sum(need in jobs for need in job.needs) for number, job in jobs.items()}
    after = defaultdict(list)
    for number, job in jobs.items():
        for need in job.needs:
            after[need].append(number)
    order = {number: (-job.priority, place, number) for place, (number, job) in enumerate(jobs.items())}
    # Sorted lists are heaps.
    ready = sorted(order[number] for number in seconds if not missing[number])
    ends = dict(at_work or {})
    running = sorted((end, number) for number, end in ends.items())
    free, now = cores - sum(jobs[number].threads for number in ends), 0.0
    while ready or running:
        while ready and (free >= jobs[ready[0][-1]].threads or not running):
            number = heapq.heappop(ready)[-1]
            free -= jobs[number].threads
            ends[number] = now + seconds[number]
            heapq.heappush(running, (ends[number], number))
        now, number = heapq.heappop(running)
        free += jobs[number].threads
        for other in after[number]:
            missing[other] -= 1
            if not missing[other] and other in seconds:
                heapq.heappush(ready, order[other])
    return ends
