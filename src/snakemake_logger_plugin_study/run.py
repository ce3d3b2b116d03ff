"""A run: its jobs, their progress, and the time left."""

from __future__ import annotations

from collections import Counter, defaultdict
from collections.abc import Collection, Mapping, Sequence
from dataclasses import dataclass, field
from functools import cache

from burridge_knopoff.study.job_log import progress_of
from snakemake_logger_plugin_study.durations import Durations

WAITING, RUNNING, DONE, FAILED = "waiting", "running", "done", "failed"
#: The share of a job that is done from which its progress shows how long it takes.
CERTAIN = 0.25


@dataclass
class Job:
    """A job that makes files: its plan and, from `state` on, its progress.

    threads : number of cores that it can use
    cores : number of cores that it has while all requested cores are busy: fewer if more are requested than there
        are; by default as many as threads
    needs : numbers of the jobs on which it depends
    benchmark : the file with its duration, written by Snakemake or, for a point, by the job itself
    begin, since : when it began, by a clock that is never set, and by the clock of its files
    seconds : its duration times its cores; None if it has not finished or was not measured
    """

    name: str
    stage: str
    rule: str = ""
    threads: int = 1
    cores: float = 0.0
    needs: frozenset[int] = frozenset()
    benchmark: str = ""
    state: str = WAITING
    begin: float = 0.0
    since: float = 0.0
    seconds: float | None = None
    message: str = ""
    output: Sequence[str] = ()
    log: Sequence[str] = ()

    def __post_init__(self) -> None:
        self.cores = self.cores or self.threads

    def work(self, expected: float, now: float) -> tuple[float, float]:
        """Return its CPU time in seconds, of the whole job and of the part that is done."""
        whole, taken = expected if self.seconds is None else self.seconds, (now - self.begin) * self.cores
        if self.state != RUNNING:
            return whole, whole if self.state == DONE else 0.0
        # It takes no less than expected: what an earlier run has left in the cache is done at once.
        if (share := progress_of(self.log, self.since)) >= CERTAIN:
            whole = max(whole, taken / share)
        return whole, min(taken, whole)


@dataclass
class Stage:
    """The jobs of a stage: their numbers by state, their CPU time in seconds, and that of the part that is done."""

    name: str
    counts: Counter[str] = field(default_factory=Counter)
    work: float = 0.0
    work_done: float = 0.0

    @property
    def jobs(self) -> int:
        """Number of its jobs."""
        return self.counts.total()


@dataclass
class Run:
    """The jobs of a run. The display reads them in its own thread while jobs begin and end.

    results : folder of the study
    jobs : {number: job}, in the order of the stages
    wanted : rules of all requested files, whether the run makes them or they are up to date
    durations : durations of jobs, as known before the first one begins
    cores : number of cores, or of simultaneous jobs on a cluster; capacity : the same in words
    touching : whether the run only sets the times of files, as `snakemake --touch` does
    newer : existing files that are newer than files made from them, which are therefore made again
    """

    results: str = ""
    jobs: Mapping[int, Job] = field(default_factory=dict)
    wanted: Collection[str] = ()
    durations: Durations = field(default_factory=Durations)
    cores: float = 1.0
    capacity: str = "on 1 core"
    touching: bool = False
    newer: Collection[str] = ()

    def jobs_in(self, state: str) -> list[Job]:
        """Return the jobs in a state."""
        return [job for job in self.jobs.values() if job.state == state]

    def stages(self, now: float) -> list[Stage]:
        """Return the progress of each stage, and of all jobs as the last one."""
        stages, total, work = dict[str, Stage](), Stage("all"), self._work(now)
        for number, job in self.jobs.items():
            for stage in (stages.setdefault(job.stage, Stage(job.stage)), total):
                stage.counts[job.state] += 1
                stage.work += work[number][0]
                stage.work_done += work[number][1]
        return [*stages.values(), total]

    def blocked(self) -> set[int]:
        """Return the numbers of the jobs that cannot run because other jobs failed."""
        failed = {number for number, job in self.jobs.items() if job.state == FAILED}
        numbers = set(failed)
        while more := {number for number, job in self.jobs.items() if not job.needs.isdisjoint(numbers)} - numbers:
            numbers |= more
        return numbers - failed

    def time_left(self, now: float) -> float:
        """Return the time left in seconds: of the work left on all cores, or of its longest chain of jobs if longer."""
        blocked, work = self.blocked(), self._work(now)
        jobs = {n: job for n, job in self.jobs.items() if job.state in (WAITING, RUNNING) and n not in blocked}
        left = {number: work[number][0] - work[number][1] for number in jobs}

        @cache
        def chain(number: int) -> float:
            before = max((chain(need) for need in jobs[number].needs if need in jobs), default=0.0)
            return before + left[number] / jobs[number].threads

        return max(sum(left.values()) / self.cores, *map(chain, jobs), 0.0)

    def _work(self, now: float) -> dict[int, tuple[float, float]]:
        """Return {job: its CPU time in seconds, and that of the part that is done}."""
        finished: dict[str, list[float]] = defaultdict(list)
        for job in self.jobs.values():
            if job.seconds is not None:
                finished[job.rule].append(job.seconds)
        expected = self.durations.expected({job.rule for job in self.jobs.values()}, finished)
        return {number: job.work(expected[job.rule], now) for number, job in self.jobs.items()}
