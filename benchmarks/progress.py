"""How good is the time left? Runs are replayed from their benchmark files, and what is told is compared with the truth.

    python benchmarks/progress.py config/paper.yaml config/smoke.yaml [--cores 1]

The studies ran in this folder, but are replayed as if they never had, each job with its CPU time: what other programs
took does not count. Printed: what is told at the beginning, and the largest ratio of what is told and what is left,
from a minute on (or a tenth of a shorter run). Both count as 10 s at least, as the display tells no less. Exit code 1
if a ratio exceeds 2.
"""

import argparse
import contextlib
import io
import sys
from pathlib import Path

from snakemake.cli import main as snakemake

from burridge_knopoff.report.stages import job_costs
from snakemake_logger_plugin_study.durations import Durations, work_of
from snakemake_logger_plugin_study.plan import PLAN
from snakemake_logger_plugin_study.run import DONE, RUNNING, WAITING, schedule

#: The factor that is allowed, moments of a run that are looked at, and the least time that the display tells.
FACTOR, MOMENTS, LEAST = 2.0, 400, 10.0


def planned(config, *targets, cores=2):
    """Return the plan of all jobs of a study, as `snakemake -n --forceall` makes it."""
    arguments = [*targets, "-n", "--forceall", "-c", str(cores), "--configfile", config]
    said = io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
        try:
            snakemake(arguments)
        except SystemExit as end:
            code = end.code
    if code:
        sys.exit(said.getvalue())
    return PLAN


def recorded(config, cores=2):
    """Return the run of all jobs of a study and {number: wall and CPU time of the job in the last run, in seconds}."""
    run = planned(config, cores=cores).look_ahead()
    run.cores = cores
    took = {number: next(job_costs(Path(job.benchmark)), None) for number, job in run.jobs.items()}
    if missing := [run.jobs[number].name for number, costs in took.items() if costs is None]:
        sys.exit(f"{config}: no benchmark file of {missing[0]} and {len(missing) - 1} more: run the study first")
    return run, {number: costs[:2] for number, costs in took.items()}


def told(run, took):
    """Return (moment, told, truth) of a run, in seconds, from its begin to its end."""
    run.durations = Durations(work_of(PLAN.jobs))
    # Snakemake measures no CPU time of jobs that are too short.
    seconds = {number: (cpu or wall) / run.jobs[number].threads for number, (wall, cpu) in took.items()}
    ends = schedule(run.jobs, seconds, run.cores)
    end = max(ends.values())
    for moment in (end * step / MOMENTS for step in range(MOMENTS)):
        for number, job in run.jobs.items():
            job.begin = ends[number] - seconds[number]
            job.state = WAITING if job.begin > moment else RUNNING if ends[number] > moment else DONE
            job.seconds = seconds[number] * job.threads if job.state == DONE else None
        yield moment, run.forecast(moment), end - moment


def ratio(first, second):
    """Return how many times larger the larger of two durations is."""
    first, second = max(first, LEAST), max(second, LEAST)
    return max(first / second, second / first)


def main():
    """Print a line for each study; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("configs", nargs="+")
    parser.add_argument("--cores", type=int, default=2)
    given = parser.parse_args()
    worst = 0.0
    for config in given.configs:
        moments = list(told(*recorded(config, given.cores)))
        _, begin, took = moments[0]
        largest = max(ratio(*pair) for moment, *pair in moments if moment >= min(60.0, took / 10))
        worst = max(worst, largest)
        print(f"{config}: {took:.0f} s on {given.cores} cores, told {begin:.0f} s, then at most {largest:.2f} off")
    return int(worst > FACTOR)


if __name__ == "__main__":
    sys.exit(main())
