"""Replays a study that ran in this folder: the error of the estimated time left, and the gain of more cores.

    python benchmarks/replay.py config/paper.yaml config/smoke.yaml [--cores 1]

It is replayed from its benchmark files as if it had never run; other programs on the machine would count. The output is
the estimate at the beginning, and the largest ratio between estimated and true time left after a minute (or a tenth of
a shorter run); both count as at least 10 s, the smallest time that the display shows.

Then, on 1, 2, 4 … 256 cores, the time to the first figure with results, to the figures of the paper, and to the end of
the study, and the critical path of jobs. The long jobs of a law divide their parts among processes (the number of cores
divided by that of the laws); their logs contain the time of each part. Points are threads of Snakemake, of which one at
a time runs Python. The start of Snakemake, and the slowing of jobs by each other, is not included.
"""

import argparse
import heapq
import re
import sys
from collections import Counter, defaultdict
from dataclasses import replace
from pathlib import Path

from snakemake_logger_plugin_study.dry_run import dry_run
from snakemake_logger_plugin_study.durations import Durations, measured_seconds
from snakemake_logger_plugin_study.run import DONE, RUNNING, WAITING

#: Moments of a run at which the estimate is compared, and the smallest time that the display prints.
MOMENTS, LEAST = 400, 10.0
#: Rules whose jobs are threads of Snakemake.
POINTS = ("simulate", "simulate_solver")

#: Share of the time of a point in which no other point can run Python: all but the run itself.
SERIAL = 0.6
#: Cores of the run that is replayed.
RECORDED = 2

LONG = re.compile(r"(.+)_of_law law=(\w+)")
PART = re.compile(r"^(.+): \d+, ([\d.]+) s, the longest ([\d.]+) s(; \d+ from the cache)?$", re.MULTILINE)


def planned(config, *targets, cores=2):
    """Return the plan of all jobs of a study, as `snakemake -n --forceall` makes it."""
    plan, written = dry_run([*targets, "--forceall", "--configfile", config, f"-c{cores}"])
    return plan if plan and plan.workflow.dag is not None else sys.exit(written)


def recorded(config, cores=2):
    """Return the run of all jobs of a study, by priority, and {number: seconds of the job in the last run}."""
    plan = planned(config, cores=cores)
    run, dag = plan.look_ahead(), plan.workflow.dag
    priority = {dag.jobid(job): job.priority for job in dag.jobs}
    run.jobs = dict(sorted(run.jobs.items(), key=lambda item: -priority[item[0]]))
    run.cores = cores
    took = {number: measured_seconds(job.benchmark, 1) for number, job in run.jobs.items()}
    if missing := [run.jobs[number].name for number, seconds in took.items() if seconds is None]:
        sys.exit(f"{config}: no benchmark file of {missing[0]} and {len(missing) - 1} more: run the study first")
    return run, took


def estimates(run, seconds):
    """Return (moment, estimate, truth) of a run, in seconds, from its beginning to its end."""
    run.durations = Durations(run.durations.work, runs=run.durations.runs)
    ends = schedule(run.jobs, seconds, run.cores)
    end = max(ends.values())
    for moment in (end * step / MOMENTS for step in range(MOMENTS)):
        for number, job in run.jobs.items():
            job.begin = ends[number] - seconds[number]
            job.state = WAITING if job.begin > moment else RUNNING if ends[number] > moment else DONE
            job.seconds = seconds[number] * job.threads if job.state == DONE else None
        yield moment, run.time_left(moment), end - moment


def schedule(jobs, seconds, cores):
    """Return {job: the time at which it ends}, for a scheduler that keeps all cores busy and takes the jobs in order.

    jobs : {number: job}; seconds : {number: duration}
    """
    missing = {number: len(job.needs) for number, job in jobs.items()}
    after = defaultdict(list)
    for number, job in jobs.items():
        for need in job.needs:
            after[need].append(number)
    order = {number: (place, number) for place, number in enumerate(jobs)}
    # Sorted lists are heaps.
    ready = sorted(order[number] for number in jobs if not missing[number])
    ends, running, free, now = {}, [], cores, 0.0
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
            if not missing[other]:
                heapq.heappush(ready, order[other])
    return ends


def ratio(first, second):
    """Return how many times larger the larger of two durations is."""
    first, second = max(first, LEAST), max(second, LEAST)
    return max(first / second, second / first)


def parts_of(results, job):
    """Return (sum, longest) in seconds of the parts that the processes of a job share, from its log."""
    long = LONG.fullmatch(job.name)
    log = Path(results, "logs", *([long[1], f"{long[2]}.log"] if long else [f"{job.rule}.log"]))
    text = log.read_text(encoding="utf-8") if log.is_file() else ""
    parts = defaultdict(list)
    for name, *seconds, kept in PART.findall(text):
        if kept:
            sys.exit(f"{log}: what came from the cache took no time: rm -r .snakemake/study_cache, and run it again")
        parts[name].append([float(value) for value in seconds])
    return [
        (sum(total for total, _ in durations), max(longest for _, longest in durations)) for durations in parts.values()
    ]


def waits(cores):
    """Return how much longer a point takes where so many threads of Snakemake share its Python."""
    return max(1.0, SERIAL * cores)


def jobs_on(cores, jobs, seconds, parts):
    """Return the jobs and their seconds on so many cores.

    A part that is shared among k processes takes at most its sum / k and, of its longest piece, the rest. The jobs were
    recorded with as many processes as they had threads.
    """
    laws = sum(job.rule == "attractors_of_law" for job in jobs.values())
    processes = max(1, cores // max(1, laws))
    shared = {number: pieces for number, pieces in parts.items() if pieces}
    counts = Counter(job.rule for job in jobs.values() if job.rule in POINTS)
    waiting = {rule: waits(min(cores, count)) / waits(RECORDED) for rule, count in counts.items()}
    took = {number: value * waiting.get(jobs[number].rule, 1.0) for number, value in seconds.items()}
    wide = {
        number: replace(job, threads=processes if number in shared else 1, cores=0.0) for number, job in jobs.items()
    }
    for number, pieces in shared.items():
        spared = sum((total - longest) * (1.0 / jobs[number].threads - 1.0 / processes) for total, longest in pieces)
        took[number] = max(0.0, seconds[number] - spared)
    return wide, took


def on_other_cores(config):
    """Print what a study would take on other numbers of cores, and its critical path."""
    run, seconds = recorded(config)
    jobs = run.jobs
    parts = {number: parts_of(run.results, job) for number, job in jobs.items()}
    alone = sum(jobs_on(1, jobs, seconds, parts)[1].values())
    print(f"{run.results}: {len(jobs)} jobs\n")
    print("| cores | first figure, s | figures of the paper, s | study, s | faster |")
    print("|------:|----------------:|------------------------:|---------:|-------:|")
    for cores in (2**power for power in range(9)):
        ends = schedule(*jobs_on(cores, jobs, seconds, parts), cores)
        first = min(end for number, end in ends.items() if jobs[number].stage == "curves" and jobs[number].needs)
        curves = max(end for number, end in ends.items() if jobs[number].stage == "curves")
        took = max(ends.values())
        print(f"| {cores:5d} | {first:15.1f} | {curves:23.1f} | {took:8.1f} | {alone / took:6.1f} |")
    print("\nthe longest chain:")
    many = 1000 * len(jobs)
    # No job waits for a core, and no point for another.
    least = {
        number: seconds[number] if jobs[number].rule in POINTS else value
        for number, value in jobs_on(many, jobs, seconds, parts)[1].items()
    }
    ends = schedule(jobs, least, many)
    number = max(ends, key=ends.get)
    while number is not None:
        print(f"{least[number]:8.1f} s  {jobs[number].name}")
        number = max(jobs[number].needs, key=ends.get, default=None)


def main():
    """Print the estimate for each study, and what it would take on other numbers of cores."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("configs", nargs="+")
    parser.add_argument("--cores", type=int, default=2)
    options = parser.parse_args()
    for config in options.configs:
        moments = list(estimates(*recorded(config, options.cores)))
        _, begin, took = moments[0]
        largest = max(ratio(*pair) for moment, *pair in moments if moment >= min(60.0, took / 10))
        print(
            f"{config}: {took:.0f} s on {options.cores} cores, estimated {begin:.0f} s, then at most {largest:.2f} off"
        )
        on_other_cores(config)


if __name__ == "__main__":
    main()
