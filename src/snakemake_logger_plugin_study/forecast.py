"""How long the jobs of a run still take: from what such jobs cost, from earlier runs, and from what has finished."""

from __future__ import annotations

import heapq
from collections import defaultdict
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from typing import NamedTuple, TypeVar

from snakemake_logger_plugin_study.durations import Durations

_T = TypeVar("_T")

#: Seconds of jobs for which what was known before counts as much as what has finished: of all kinds, and of one.
WEIGHT, WEIGHT_OF_KIND = 5.0, 2.0
#: Of a job that has run longer than was thought: what it still takes, as a share of what it has taken.
OVERDUE = 0.2


@dataclass(frozen=True)
class PlannedJob:
    """A job that is to run.

    kind, work : what its duration is known by
    needs : numbers of the jobs that come before
    """

    name: str
    kind: str
    work: float
    threads: int = 1
    priority: float = 0.0
    needs: frozenset[int] = frozenset()


class Known(NamedTuple):
    """A job whose duration is known, in seconds of all its threads together."""

    kind: str
    work: float
    seconds: float


class Cost(NamedTuple):
    """What jobs take: seconds on the cores of a run, seconds of CPU, and bytes of the files that they make."""

    seconds: float
    cpu: float
    size: float


class Forecast:
    """Tells the time left of a run.

    jobs : {number: job}, all that are to run
    durations : what jobs cost on another machine
    speed : seconds here for one there, where nothing has run here yet
    history : jobs of earlier runs on this machine
    """

    def __init__(
        self, jobs: Mapping[int, PlannedJob], durations: Durations, speed: float = 1.0, history: Iterable[Known] = ()
    ) -> None:
        self.jobs = dict(jobs)
        self._durations = durations
        self._after = following({number: job.needs for number, job in self.jobs.items()})
        self._speed, factors = self._factors(speed, {}, history)
        #: Of kinds that have run before: how much slower each is than all of them.
        self._relative = {kind: factor / self._speed for kind, factor in factors.items()}

    def _factors(
        self, speed: float, relative: Mapping[str, float], known: Iterable[Known]
    ) -> tuple[float, dict[str, float]]:
        """Return the ratio of seconds to what was thought, of all jobs and of each kind, given what it was before."""
        taken: dict[str, float] = defaultdict(float)
        thought: dict[str, float] = defaultdict(float)
        for job in known:
            taken[job.kind] += job.seconds
            thought[job.kind] += self._durations.seconds(job.kind, job.work) * relative.get(job.kind, 1.0)
        speed = (sum(taken.values()) + WEIGHT * speed) / (sum(thought.values()) + WEIGHT)
        kinds = taken.keys() | relative.keys()
        return speed, {
            kind: relative.get(kind, 1.0) * (taken[kind] + WEIGHT_OF_KIND * speed) / (thought[kind] + WEIGHT_OF_KIND)
            for kind in kinds
        }

    def cost(self, cores: float) -> Cost:
        """Return what all jobs take together before any has begun."""
        cpu = sum(self._duration(job, self._speed, {}) * job.threads for job in self.jobs.values())
        size = sum(self._durations.size(job.kind, job.work) for job in self.jobs.values())
        return Cost(self.time_left(0.0, cores), cpu, size)

    def time_left(
        self,
        now: float,
        cores: float,
        running: Mapping[int, float] | None = None,
        done: Mapping[int, float] | None = None,
        failed: Iterable[int] = (),
    ) -> float:
        """Return the seconds until the last job ends, as a scheduler would run them that fills all cores.

        running : {number: when it began}
        done : {number: seconds that it took, not finite if that is not known}
        failed : numbers of jobs whose dependents cannot run
        """
        running, done = dict(running or {}), dict(done or {})
        known = [
            Known(job.kind, job.work, seconds * job.threads)
            for number, seconds in done.items()
            if (job := self.jobs.get(number)) and seconds < float("inf")
        ]
        # A job that has run longer than was thought tells as much as one that has finished.
        for number, begin in running.items():
            job = self.jobs.get(number)
            if job and now - begin > self._duration(job, self._speed, {}):
                known.append(Known(job.kind, job.work, (now - begin) * job.threads))
        speed, factors = self._factors(self._speed, self._relative, known)
        gone = {*done, *failed, *downstream(failed, self._after)}
        left = {number: job for number, job in self.jobs.items() if number not in gone}
        ends = {}
        for number, begin in running.items():
            if number in left:
                taken = now - begin
                ends[number] = max(self._duration(left[number], speed, factors) - taken, OVERDUE * taken)
        durations = {number: self._duration(job, speed, factors) for number, job in left.items() if number not in ends}
        return max(schedule(left, durations, max(cores, 1), ends).values(), default=0.0)

    def _duration(self, job: PlannedJob, speed: float, factors: Mapping[str, float]) -> float:
        factor = factors.get(job.kind, speed * self._relative.get(job.kind, 1.0))
        return self._durations.seconds(job.kind, job.work) * factor / job.threads


def following(needs: Mapping[_T, Iterable[_T]]) -> dict[_T, list[_T]]:
    """Return {job or rule: those that need it}, given what each needs."""
    after: dict[_T, list[_T]] = defaultdict(list)
    for name, own in needs.items():
        for need in own:
            after[need].append(name)
    return after


def downstream(names: Iterable[_T], after: Mapping[_T, Iterable[_T]]) -> set[_T]:
    """Return all that comes after some jobs or rules, given what follows on each."""
    found: set[_T] = set()
    more = list(names)
    while more:
        new = [name for name in after.get(more.pop(), ()) if name not in found]
        found.update(new)
        more += new
    return found


def schedule(
    jobs: Mapping[int, PlannedJob],
    durations: Mapping[int, float],
    cores: float,
    at_work: Mapping[int, float] | None = None,
) -> dict[int, float]:
    """Return {job: when it ends}, as a scheduler runs jobs that fills all cores: by priority, then in their order.

    jobs : {number: job}; of what a job needs only these are waited for
    durations : {number: seconds} of those that have not begun; at_work : {number: when it ends} of the others
    """
    needs = {number: [need for need in job.needs if need in jobs] for number, job in jobs.items()}
    missing = {number: len(own) for number, own in needs.items()}
    after = following(needs)
    order = {number: (-job.priority, place) for place, (number, job) in enumerate(jobs.items())}
    ready = [(order[number], number) for number in durations if not missing[number]]
    heapq.heapify(ready)
    ends = dict(at_work or {})
    running = [(end, number) for number, end in ends.items()]
    heapq.heapify(running)
    free = cores - sum(min(jobs[number].threads, cores) for number in ends)
    now = 0.0
    while ready or running:
        while ready and (free >= min(jobs[ready[0][1]].threads, cores) or not running):
            _, number = heapq.heappop(ready)
            free -= min(jobs[number].threads, cores)
            ends[number] = now + durations[number]
            heapq.heappush(running, (ends[number], number))
        now, number = heapq.heappop(running)
        free += min(jobs[number].threads, cores)
        for other in after[number]:
            missing[other] -= 1
            if not missing[other] and other in durations:
                heapq.heappush(ready, (order[other], other))
    return ends
