"""Make the durations that come with the sources, from benchmark files of a large and a small study run in this folder.

    python benchmarks/durations.py config/paper.yaml config/smoke.yaml

For each rule: the mean CPU time and size of a job, at the smallest and at the largest work in these studies. Rules that
did not run keep their durations.
"""

import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from replay import planned

from burridge_knopoff.report.stages import job_costs
from snakemake_logger_plugin_study.durations import FILE, SHIPPED, work_of


def main():
    """Read, print and write."""
    jobs = defaultdict(lambda: defaultdict(list))
    for config in sys.argv[1:]:
        plan = planned(config, "all", "chains")
        work = work_of(plan.jobs)
        for job in plan.workflow.dag.jobs:
            for wall, cpu, _ in job_costs(Path(job.benchmark)) if job.benchmark else ():
                size = sum(path.stat().st_size for path in map(Path, job.output) if path.is_file())
                # Snakemake measures no CPU time of jobs that are too short.
                jobs[job.rule.name][work.get(job.rule.name, work["all points"])].append((cpu or wall, size))
    rules = dict(SHIPPED)
    for rule, by_work in jobs.items():
        rows = [[least, *np.mean(by_work[least], axis=0)] for least in sorted({min(by_work), max(by_work)})]
        # More work never takes less time.
        rows[-1] = list(np.max(rows, axis=0))
        rules[rule] = [[float(f"{value:.4g}") for value in row] for row in rows]
        print(rule, rules[rule])
    lines = ",\n".join(f' "{rule}": {json.dumps(rows)}' for rule, rows in sorted(rules.items()))
    FILE.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
