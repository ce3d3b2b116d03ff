"""A run: its jobs, how far they are, and when they end."""

from __future__ import annotations

import heapq
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from snakemake_logger_plugin_study.durations import Durations

WAITING, RUNNING, DONE, FAILED = "waiting", "running", "done", "failed"
#: Of a job that has run longer than was thought: what it still takes, as a share of what it has taken.
OVERDUE = 0.05
#: Seconds for which a forecast holds.
FRESH = 2.0


@dataclass
class Job:
    """A job that makes files: what is planned and, from `state` on, what became of it.

    kind, work : what its duration is known by; no kind if it was not planned
    needs : numbers of the jobs that come before
    timed : False if begin and end say nothing about its duration
    """

    name: str
    stage: str
    kind: str = ""
    work: float = 0.0
    threads: int = 1
    priority: float = 0.0
    needs: frozenset[int] = frozenset()
    state: str = WAITING
    begin: float = 0.0
    end: float = 0.0
    timed: bool = True
    message: str = ""
    output: Sequence[str] = ()
    log: Sequence[str] = ()


@dataclass
class Run:
    """The jobs of a run. A display reads it in a thread of its own, while jobs begin and end.

    results : folder of the study
    jobs : {number: job}, in the order of the stages
    wanted : rules of all files that the run is to make or has found up to date
    durations : what jobs take on this machine, as known before any has begun
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
            self.jobs = {**self.jobs, number: Job(rule, rule)}
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
        known, running = [], {}
        for number, job in self.jobs.items():
            taken = (job.end if job.state == DONE else now) - job.begin
            if job.state == RUNNING:
                running[number] = taken
            # A job that has run longer than was thought tells as much as one that has finished.
            late = job.state == RUNNING and taken * job.threads > self.durations.cost(job.kind, job.work)[0]
            if job.timed and (job.state == DONE or late):
                known.append((job.kind, job.work, taken * job.threads))
        durations, blocked = self.durations.corrected(known), self.blocked()
        left = {n: job for n, job in self.jobs.items() if n in running or (job.state == WAITING and n not in blocked)}
        seconds = {n: durations.cost(job.kind, job.work)[0] / job.threads for n, job in left.items()}
        ends = {number: max(seconds.pop(number) - taken, OVERDUE * taken) for number, taken in running.items()}
        return max(schedule(left, seconds, self.cores, ends).values(), default=0.0)


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
