"""Cost of the jobs of a study by rule: wall and CPU time, and the peak memory of the largest job.

    python benchmarks/stages.py results/paper

It reads the benchmark files of the jobs. The minutes are those from the beginning of the first job to the end of the
last one, if all belong to one run.
"""

from __future__ import annotations

import sys
from pathlib import Path

from measure import print_table

from burridge_knopoff.report.stages import Stage, job_costs, read_stages


def rules_of(results: Path) -> list[Stage]:
    """Return the cost of the jobs of each rule of a study, the one with the largest CPU time first."""
    return sorted(read_stages(results / "benchmarks", joined={}, skipped=()), key=lambda rule: -rule.cpu)


def minutes_of(results: Path) -> float:
    """Return the minutes from the beginning of the first job of a study to the end of the last one."""
    paths = (results / "benchmarks").rglob("*.tsv")
    ends = [(path.stat().st_mtime, wall) for path in paths for wall, *_ in job_costs(path)]
    return (max(end for end, _ in ends) - min(end - wall for end, wall in ends)) / 60.0


def main() -> None:
    """Print the tables of each study."""
    for results in map(Path, sys.argv[1:]):
        rows = []
        for rule in rules_of(results):
            taken = [f"{rule.wall:.1f}", f"{rule.cpu:.1f}", f"{rule.memory:.0f}"]
            rows.append([rule.name, rule.jobs, *taken])
        print_table(["rule", "jobs", "wall s, sum", "CPU s, sum", "MB, largest"], rows)
        print(f"{minutes_of(results):.2f} minutes from the first begin to the last end")


if __name__ == "__main__":
    main()
