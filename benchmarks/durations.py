"""Make the durations that come with the sources, from benchmark files of a large and a small study run in this folder.

    python benchmarks/durations.py config/paper.yaml config/smoke.yaml

For each rule: the mean wall time of a job times its threads, without the estimated time of its simulation, and its
size, at the smallest and at the largest work in these studies. Durations of rules that did not run are scaled as those
of the others have changed. Other programs on the machine would count.
"""

import json
import sys
from collections import defaultdict
from pathlib import Path

import numpy as np
from replay import planned

from snakemake_logger_plugin_study.durations import FILE, SHIPPED, measured_seconds, run_seconds_of, work_of


def main():
    """Read, print and write."""
    jobs = defaultdict(lambda: defaultdict(list))
    for config in sys.argv[1:]:
        plan = planned(config, "all", "chains")
        work, runs = work_of(plan.study), run_seconds_of(plan.study)
        files = {number: job.benchmark for number, job in plan.look_ahead().jobs.items()}
        for job in plan.workflow.dag.jobs:
            seconds = measured_seconds(files.get(plan.workflow.dag.jobid(job), ""), int(job.threads))
            if seconds is not None:
                size = sum(path.stat().st_size for path in map(Path, job.output) if path.is_file())
                rest = max(0.0, seconds - runs.get(job.rule.name, 0.0))
                jobs[job.rule.name][work.get(job.rule.name, work["all points"])].append((rest, size))
    rules = {}
    for rule, by_work in jobs.items():
        rows = [[least, *np.mean(by_work[least], axis=0)] for least in sorted({min(by_work), max(by_work)})]
        # More work never takes less time.
        rows[-1] = list(np.max(rows, axis=0))
        rules[rule] = [[float(f"{value:.4g}") for value in row] for row in rows]
        print(rule, rules[rule])
    ratio = np.median([rows[0][1] / SHIPPED[rule][0][1] for rule, rows in rules.items() if rule in SHIPPED])
    for rule in SHIPPED.keys() - rules:
        rules[rule] = [[work, float(f"{ratio * seconds:.4g}"), size] for work, seconds, size in SHIPPED[rule]]
    lines = ",\n".join(f' "{rule}": {json.dumps(rows)}' for rule, rows in sorted(rules.items()))
    FILE.write_text(f"{{\n{lines}\n}}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
