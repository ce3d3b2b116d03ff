"""How honest is the time left? The record of a run is replayed, and what the display would have told held to the truth.

    python benchmarks/progress.py results/paper results/smoke

For each study, as if it had never run on this machine: what was told at its begin, and from a minute after it (or a
tenth of a shorter run) to its end the largest ratio between what was told and what it took, and the share of that time
in which it was within a factor of 1.5. Both count as 10 s at least: the display tells no less. Exit code 1 if a ratio
is above 1.5.
"""

import argparse
import sys

from snakemake_logger_plugin_study.durations import shipped
from snakemake_logger_plugin_study.forecast import Forecast, PlannedJob
from snakemake_logger_plugin_study.past import read_record

#: The factor that is allowed, moments of a run that are looked at, and the least time that the display tells.
FACTOR, MOMENTS, LEAST = 1.5, 400, 10.0


def told(record, speed=None):
    """Return (moment, told, truth) of a run, in seconds, from its begin to its end."""
    numbers = {job["name"]: number for number, job in enumerate(record["jobs"])}
    jobs = {
        numbers[job["name"]]: PlannedJob(
            *(job[key] for key in ("name", "kind", "work", "threads", "priority")),
            frozenset(numbers[need] for need in job["needs"]),
        )
        for job in record["jobs"]
    }
    forecast = Forecast(jobs, shipped(), record["speed"] if speed is None else speed)
    begin, end = min(job["begin"] for job in record["jobs"]), max(job["end"] for job in record["jobs"])
    for moment in (begin + (end - begin) * step / MOMENTS for step in range(MOMENTS)):
        begun = [(number, job) for number, job in enumerate(record["jobs"]) if job["begin"] <= moment]
        running = {number: job["begin"] for number, job in begun if job["end"] > moment}
        done = {number: job["end"] - job["begin"] for number, job in begun if number not in running}
        yield moment - begin, forecast.time_left(moment, record["cores"], running, done), end - moment


def ratio(first, second):
    """Return how many times larger the larger of two durations is."""
    first, second = max(first, LEAST), max(second, LEAST)
    return max(first / second, second / first)


def main():
    """Print a line for each study; return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", nargs="+")
    parser.add_argument("--speed", type=float, help="seconds of the calibration for one where it was measured")
    given = parser.parse_args()
    worst = 0.0
    for results in given.results:
        record = read_record(results)
        if not record:
            sys.exit(f"{results}: no record of a run in it; snakemake writes it")
        moments = list(told(record, given.speed))
        took = moments[0][2]
        counted = [ratio(*pair) for moment, *pair in moments if moment >= min(60.0, took / 10)]
        within = sum(value <= FACTOR for value in counted) / len(counted)
        worst = max(worst, *counted)
        print(
            f"{results}, {record['cores']:g} cores: took {took:.0f} s, told {moments[0][1]:.0f} s at its begin; "
            f"then at most a factor of {max(counted):.2f} off, within {FACTOR} for {100 * within:.0f} % of the time"
        )
    return int(worst > FACTOR)


if __name__ == "__main__":
    sys.exit(main())
