"""A run: its jobs, their progress, and the time at which they end."""

from __future__ import annotations

import heapq
from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field

from burridge_knopoff.study.job_log import progress_of
from snakemake_logger_plugin_study.durations import Durations

WAITING, RUNNING, DONE, FAILED = "waiting", "running", "done", "failed"
#: Seconds for which a forecast holds.
FRESH = 2.0
# A job that is done to one in CERTAIN takes as long as its progress shows, and one that begins as long as expected.
CERTAIN = 4.0


@dataclass
class Job:
    """A job that makes files: its plan and, from `state` on, its progress.

    needs : numbers of the jobs on which it depends
    benchmark : the file with its duration, written by Snakemake
    begin, since : when it began, by a clock that is never set, and by the clock of its files
    seconds : its duration times its threads; None if it has not finished or was not measured
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
    since: float = 0.0
    seconds: float | None = None
    message: str = ""
    output: Sequence[str] = ()
    log: Sequence[str] = ()

    @property
    def progress(self) -> float:
        """The share of it that is done by its log, 0 if it logs none."""
        return progress_of(self.log, self.since)


@dataclass
class Stage:
    """The jobs of a stage.

    counts : {state: number of jobs}
    work, work_done : CPU time in seconds, of all its jobs and of the part that is done
    """

    name: str
    counts: Counter[str] = field(default_factory=Counter)
    work: float = 0.0
    work_done: float = 0.0

    @property
    def jobs(self) -> int:
        """Number of its jobs."""
        return self.counts.total()

    @property
    def share_done(self) -> float:
        """The share of its CPU time that is done."""
        return self.work_done / self.work if self.work else 0.0


@dataclass
class Run:
    """The jobs of a run. The display reads them in its own thread while jobs begin and end.

    results : folder of the study
    jobs : {number: job}, in the order of the stages
    wanted : rules of all requested files, whether the run makes them or they are up to date
    durations : durations of jobs, as known before the first one begins
    cores : number of cores, or of simultaneous jobs on a cluster; capacity : the same in words
    stopping : whether the user has ended the run by Ctrl-C
    touching : whether the run only sets the times of files, as `snakemake --touch` does
    """

    results: str = ""
    jobs: Mapping[int, Job] = field(default_factory=dict)
    wanted: Collection[str] = ()
    durations: Durations = field(default_factory=Durations)
    cores: float = 1.0
    capacity: str = "on 1 core"
    stopping: bool = False
    touching: bool = False
    _last_forecast: tuple[float, float] | None = None

    def job(self, number: int, rule: str) -> Job:
        """Return a job; one that was not planned is added."""
        if number not in self.jobs:
            # Another thread may iterate over the old mapping.
            self.jobs = {**self.jobs, number: Job(rule, rule, rule)}
        return self.jobs[number]

    def jobs_in(self, state: str) -> list[Job]:
        """Return the jobs in a state."""
        return [job for job in self.jobs.values() if job.state == state]

    def stages(self, now: float) -> list[Stage]:
        """Return the progress of each stage, and of all jobs as the last one."""
        expected, stages, total = self.expected(), dict[str, Stage](), Stage("all")
        for job in self.jobs.values():
            work = expected[job.rule] if job.seconds is None else job.seconds
            if job.state == RUNNING:
                work = self._work(job, work, now)
            running = min(work, (now - job.begin) * job.threads)
            done = work if job.state == DONE else running if job.state == RUNNING else 0.0
            for stage in (stages.setdefault(job.stage, Stage(job.stage)), total):
                stage.counts[job.state] += 1
                stage.work += work
                stage.work_done += done
        return [*stages.values(), total]

    def blocked(self) -> set[int]:
        """Return the numbers of the jobs that cannot run because other jobs failed."""
        failed = {number for number, job in self.jobs.items() if job.state == FAILED}
        numbers = set(failed)
        while (
            dependents := {number for number, job in self.jobs.items() if not job.needs.isdisjoint(numbers)} - numbers
        ):
            numbers |= dependents
        return numbers - failed

    def time_left(self, now: float) -> float:
        """Return the time left in seconds, counted down from the last forecast for a moment."""
        if self._last_forecast is None or not 0.0 <= now - self._last_forecast[0] < FRESH:
            self._last_forecast = now, self.forecast(now)
        then, seconds = self._last_forecast
        return max(seconds - (now - then), 0.0)

    def forecast(self, now: float) -> float:
        """Return the time left in seconds, for a scheduler that keeps all cores busy."""
        expected, blocked = self.expected(), self.blocked()
        left = {
            number: job
            for number, job in self.jobs.items()
            if job.state == RUNNING or (job.state == WAITING and number not in blocked)
        }
        seconds = {number: expected[job.rule] / job.threads for number, job in left.items()}
        ends = {
            number: max(0.0, self._work(job, seconds.pop(number) * job.threads, now) / job.threads - now + job.begin)
            for number, job in left.items()
            if job.state == RUNNING
        }
        return max(schedule(left, seconds, self.cores, ends).values(), default=0.0)

    @staticmethod
    def _work(job: Job, expected: float, now: float) -> float:
        """Return the seconds of a running job, times its threads: as expected, or more if its progress shows this.

        What an earlier run has left in the cache is done at once, but what is left takes no less time for that.
        """
        share, taken = job.progress, (now - job.begin) * job.threads
        if not share:
            return expected
        weight = min(1.0, CERTAIN * share)
        whole = (1.0 - weight) * expected + weight * max(expected, taken / share)
        return taken + (1.0 - share) * whole

    def expected(self) -> dict[str, float]:
        """Return {rule: expected seconds of a job, times its threads}."""
        finished: dict[str, list[float]] = defaultdict(list)
        for job in self.jobs.values():
            if job.seconds is not None:
                finished[job.rule].append(job.seconds)
        return self.durations.expected({job.rule for job in self.jobs.values()}, finished)


def schedule(
    jobs: Mapping[int, Job], seconds: Mapping[int, float], cores: float, running_ends: Mapping[int, float] | None = None
) -> dict[int, float]:
    """Return {job: the time at which it ends}, for a scheduler that keeps all cores busy: by priority, then in order.

    jobs : {number: job}; a job waits only for those among them
    seconds : durations of the jobs that have not begun; running_ends : {running job: the time at which it ends}
    """
    missing = {number: sum(need in jobs for need in job.needs) for number, job in jobs.items()}
    after = defaultdict(list)
    for number, job in jobs.items():
        for need in job.needs:
            after[need].append(number)
    order = {number: (-job.priority, place, number) for place, (number, job) in enumerate(jobs.items())}
    # Sorted lists are heaps.
    ready = sorted(order[number] for number in seconds if not missing[number])
    ends = dict(running_ends or {})
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
