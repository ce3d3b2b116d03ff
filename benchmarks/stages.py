"""What the jobs of a study have taken, rule by rule: wall and CPU time, and the peak memory of the largest job.

    python benchmarks/stages.py results/paper

It reads what Snakemake has measured of each job, and what the display has recorded of the last run.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from pathlib import Path

from measure import print_table, verdict

from burridge_knopoff.study.job_costs import read_costs
from snakemake_logger_plugin_study.past import read_record

LIMIT_MB = 400.0
LIMIT_MINUTES = 5.0


def rule_of(path: Path) -> str:
    """Return the rule to which a benchmark file belongs: its own name, or the folder of a rule with many jobs."""
    return path.parts[0] if len(path.parts) > 1 else path.stem


def jobs(folder: Path) -> dict[str, list[tuple[float, float, float]]]:
    """Return {rule: [(wall s, CPU s, MB), …]} from the benchmark files of a study."""
    found: dict[str, list[tuple[float, float, float]]] = defaultdict(list)
    for job in read_costs(sorted(folder.rglob("*.tsv"))):
        found[rule_of(job.path.relative_to(folder))].append((job.wall, job.cpu, job.memory * 1.048576))
    return found


def main() -> None:
    """Print the tables of each study."""
    for results in map(Path, sys.argv[1:]):
        rows = []
        measured = jobs(results / "benchmarks")
        for rule, values in sorted(measured.items(), key=lambda item: -sum(value[1] for value in item[1])):
            total = [sum(value[k] for value in values) for k in (0, 1)]
            memory = max(value[2] for value in values)
            rows.append(
                [rule, len(values), f"{total[0]:.1f}", f"{total[1]:.1f}", f"{memory:.0f}", verdict(memory, LIMIT_MB)]
            )
        print_table(["rule", "jobs", "wall s, sum", "CPU s, sum", "MB, largest", f"under {LIMIT_MB:g} MB"], rows)
        record = read_record(results)
        if not record:
            sys.exit(f"{results}: no record of a run in it; snakemake writes it")
        minutes = max(job["end"] for job in record["jobs"]) / 60.0
        kept = f"{LIMIT_MINUTES:g}, {verdict(minutes, LIMIT_MINUTES)}"
        last = [len(record["jobs"]), f"{record['cores']:g}", f"{minutes:.2f}", kept]
        print_table(["jobs of the last run", "cores", "minutes", "limit, kept"], [last])


if __name__ == "__main__":
    main()
