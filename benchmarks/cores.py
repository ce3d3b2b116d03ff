"""What a study takes on 1, 2, 4 … 256 cores: the durations of its run in this folder, scheduled again.

    python benchmarks/cores.py config/paper.yaml

The long jobs of a law share their parts out among processes, the cores divided by the laws; what each part took stands
in their logs. Printed: cores, seconds, how many times faster than one core; then the longest chain of jobs that need
each other. What Snakemake itself takes, and what jobs on one machine take from each other, is not in it.
"""

import re
import sys
from collections import defaultdict
from dataclasses import replace
from pathlib import Path

from progress import recorded

from snakemake_logger_plugin_study.run import schedule

LONG = re.compile(r"(.+)_of_law law=(\w+)")
PART = re.compile(r"^(.+): \d+, ([\d.]+) s, the longest ([\d.]+) s(; \d+ kept.*)?$", re.MULTILINE)


def parts_of(results, job):
    """Return (sum, longest) in seconds of what the processes of a job share, from its log."""
    long = LONG.fullmatch(job.name)
    log = Path(results, "logs", *([long[1], f"{long[2]}.log"] if long else [f"{job.rule}.log"]))
    text = log.read_text(encoding="utf-8") if log.is_file() else ""
    parts = defaultdict(list)
    for name, *seconds, kept in PART.findall(text):
        if kept:
            sys.exit(
                f"{log}: what was kept from a run before took no time: rm -r .snakemake/study_cache, and run it again"
            )
        parts[name].append([float(value) for value in seconds])
    return [(sum(total for total, _ in each), max(longest for _, longest in each)) for each in parts.values()]


def on(cores, jobs, seconds, parts):
    """Return the jobs and their seconds on so many cores.

    A part that is shared among k processes takes at most its sum / k and, of its longest piece, the rest. The jobs were
    recorded with as many processes as they had threads.
    """
    laws = sum(job.rule == "attractors_of_law" for job in jobs.values())
    processes = max(1, cores // max(1, laws))
    shared = {number: found for number, found in parts.items() if found}
    wide = {number: replace(job, threads=processes if number in shared else 1) for number, job in jobs.items()}
    took = dict(seconds)
    for number, found in shared.items():
        spared = sum((total - longest) * (1.0 / jobs[number].threads - 1.0 / processes) for total, longest in found)
        took[number] = max(0.0, seconds[number] - spared)
    return wide, took


def main():
    """Print the table of each study."""
    for config in sys.argv[1:]:
        run, took = recorded(config)
        jobs, seconds = run.jobs, {number: wall for number, (wall, _) in took.items()}
        parts = {number: parts_of(run.results, job) for number, job in jobs.items()}
        alone = sum(on(1, jobs, seconds, parts)[1].values())
        print(f"{run.results}: {len(jobs)} jobs\n\n| cores | seconds | faster |\n|------:|--------:|-------:|")
        for cores in (2**power for power in range(9)):
            took = max(schedule(*on(cores, jobs, seconds, parts), cores).values())
            print(f"| {cores:5d} | {took:7.1f} | {alone / took:6.1f} |")
        print("\nthe longest chain:")
        many = 1000 * len(jobs)
        # No job waits for a core.
        least = on(many, jobs, seconds, parts)[1]
        ends = schedule(jobs, least, many)
        number = max(ends, key=ends.get)
        while number is not None:
            print(f"{least[number]:8.1f} s  {jobs[number].name}")
            number = max(jobs[number].needs, key=ends.get, default=None)


if __name__ == "__main__":
    main()
