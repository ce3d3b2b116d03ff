"""What the jobs of a study have taken, rule by rule: wall and CPU time, and the peak memory of the largest job.

    python benchmarks/stages.py results/paper

It reads what Snakemake has measured of each job, and what the display has recorded of the last run.
"""

from __future__ import annotations

import sys
from pathlib import Path

from measure import print_table, verdict
from progress import recorded

from burridge_knopoff.report.stages import Stage, read_stages

LIMIT_MB = 400.0
LIMIT_MINUTES = 5.0


def rules_of(results: Path) -> list[Stage]:
    """Return what the jobs of each rule of a study have taken; the one with the largest CPU time first."""
    return sorted(read_stages(results / "benchmarks", joined={}, skipped=()), key=lambda rule: -rule.cpu)


def main() -> None:
    """Print the tables of each study."""
    for results in map(Path, sys.argv[1:]):
        rows = []
        for rule in rules_of(results):
            taken = [f"{rule.wall:.1f}", f"{rule.cpu:.1f}", f"{rule.memory:.0f}"]
            rows.append([rule.name, rule.jobs, *taken, verdict(rule.memory, LIMIT_MB)])
        print_table(["rule", "jobs", "wall s, sum", "CPU s, sum", "MB, largest", f"under {LIMIT_MB:g} MB"], rows)
        record = recorded(results)
        minutes = max(job["end"] for job in record["jobs"]) / 60.0
        kept = f"{LIMIT_MINUTES:g}, {verdict(minutes, LIMIT_MINUTES)}"
        last = [len(record["jobs"]), f"{record['cores']:g}", f"{minutes:.2f}", kept]
        print_table(["jobs of the last run", "cores", "minutes", "limit, kept"], [last])


if __name__ == "__main__":
    main()
