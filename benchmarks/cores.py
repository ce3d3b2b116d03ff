"""What a study takes on 1, 2, 4 … 256 cores: the durations of a run on this machine, scheduled anew.

    python benchmarks/cores.py results/paper

Printed: cores, seconds, how many times faster than one core; then the longest chain of jobs that need each other. What
Snakemake itself takes, and what jobs on one machine take from each other, is not in it.
"""

import sys

from progress import planned

from snakemake_logger_plugin_study.forecast import schedule
from snakemake_logger_plugin_study.past import read_record


def main():
    """Print the table of each study."""
    for results in sys.argv[1:]:
        record = read_record(results)
        if not record:
            sys.exit(f"{results}: no record of a run in it; snakemake writes it")
        jobs, seconds = planned(record)
        alone = sum(seconds.values())
        print(f"{results}: {len(jobs)} jobs\n\n| cores | seconds | faster |\n|------:|--------:|-------:|")
        for cores in (2**power for power in range(9)):
            took = max(schedule(jobs, seconds, cores).values())
            print(f"| {cores:5d} | {took:7.1f} | {alone / took:6.1f} |")
        print("\nthe longest chain:")
        ends = schedule(jobs, seconds, len(jobs))
        number = max(ends, key=ends.get)
        while number is not None:
            print(f"{seconds[number]:8.1f} s  {jobs[number].name}")
            number = max(jobs[number].needs, key=ends.get, default=None)


if __name__ == "__main__":
    main()
