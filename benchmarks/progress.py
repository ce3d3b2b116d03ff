"""How honest is the time left? The record of a run is replayed, and what the display would have told held to the truth.

    python benchmarks/progress.py results/paper results/smoke [--cores 1]

For each study, as if it had never run on this machine: what was told at its begin, and from a minute after it (or a
tenth of a shorter run) to its end the largest ratio between what was told and what it took, and the share of that time
in which it was within a factor of 1.5. Both count as 10 s at least: the display tells no less. With `--cores` the jobs
take as long as they did, on so many cores. Exit code 1 if a ratio is above 1.5.
"""

import argparse
import sys

from snakemake_logger_plugin_study.durations import SHIPPED, Durations
from snakemake_logger_plugin_study.past import read_record
from snakemake_logger_plugin_study.run import DONE, RUNNING, WAITING, Job, Run, schedule

#: The factor that is allowed, moments of a run that are looked at, and the least time that the display tells.
FACTOR, MOMENTS, LEAST = 1.5, 400, 10.0
#: What a record holds of a job that was known before it began, besides what it needs.
PLANNED = ("name", "kind", "work", "threads", "priority")


def recorded(results):
    """Return the record of the last run of a study; end the program, with a line, if there is none."""
    return read_record(results) or sys.exit(f"{results}: no record of a run in it; snakemake writes it")


def planned(record):
    """Return the jobs of a record by number, and the seconds that each took."""
    jobs = {
        number: Job(stage="", needs=frozenset(job["needs"]), **{name: job[name] for name in PLANNED})
        for number, job in enumerate(record["jobs"])
    }
    return jobs, {number: job["end"] - job["begin"] for number, job in enumerate(record["jobs"])}


def told(record, cores=None):
    """Return (moment, told, truth) of a run, in seconds, from its begin to its end."""
    jobs, seconds = planned(record)
    ends = {number: job["end"] for number, job in enumerate(record["jobs"])}
    if cores is not None:
        ends = schedule(jobs, seconds, cores)
    for number, job in jobs.items():
        job.begin, job.end = ends[number] - seconds[number], ends[number]
    begin, end = min(job.begin for job in jobs.values()), max(ends.values())
    speed = record["calibration"] / SHIPPED["calibration"]
    run = Run("", jobs, (), Durations(SHIPPED["costs"], speed), cores or record["cores"])
    for moment in (begin + (end - begin) * step / MOMENTS for step in range(MOMENTS)):
        for job in jobs.values():
            job.state = WAITING if job.begin > moment else RUNNING if job.end > moment else DONE
        yield moment - begin, run.forecast(moment), end - moment


def ratio(first, second):
    """Return how many times larger the larger of two durations is."""
    first, second = max(first, LEAST), max(second, LEAST)
    return max(first / second, second / first)


def main():
    """Print a line for each study; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+")
    parser.add_argument("--cores", type=int, help="without it those of the run")
    given = parser.parse_args()
    worst = 0.0
    for results in given.results:
        record = recorded(results)
        moments = list(told(record, given.cores))
        took = moments[0][2]
        counted = [ratio(*pair) for moment, *pair in moments if moment >= min(60.0, took / 10)]
        within = sum(value <= FACTOR for value in counted) / len(counted)
        worst = max(worst, *counted)
        beginning = (
            f"{results}, cores {given.cores or record['cores']:g}: took {took:.0f} s, told {moments[0][1]:.0f} s"
        )
        print(
            f"{beginning} at its begin; then at most a factor of {max(counted):.2f} off, "
            f"within {FACTOR} for {100 * within:.0f} % of the time"
        )
    return int(worst > FACTOR)


if __name__ == "__main__":
    sys.exit(main())
