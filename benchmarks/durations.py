"""Make the durations that the tree ships anew, from studies that have run on this machine and nothing else beside them.

    python benchmarks/durations.py results/paper results/smoke

Each kind of job gets a fixed part and one in proportion to its work, by least squares of relative errors over all its
jobs; kinds that did not run in any of these studies keep what they have. Printed: kind, jobs, seconds, rate.
"""

import json
import sys
from collections import defaultdict

import numpy as np
from scipy.optimize import nnls

from snakemake_logger_plugin_study.durations import FILE, SHIPPED, calibrate
from snakemake_logger_plugin_study.past import read_past

#: Seconds and bytes below which no job is told from another.
LEAST_SECONDS, LEAST_SIZE = 0.05, 1000.0


def fitted(work, values, least):
    """Return the fixed part and the rate of one kind; the rate is 0 where all jobs have the same small value."""
    work, values = np.array(work), np.maximum(values, least)
    if len(set(work)) == 1:
        # One study tells no two parts: what is long is work but for the start of a program.
        mean = values.mean()
        fixed = mean if mean < 100.0 * least else 20.0 * least
        return fixed, (mean - fixed) / work[0] if work[0] else 0.0
    (fixed, rate), _ = nnls(np.column_stack([np.ones_like(work), work]) / values[:, None], np.ones_like(values))
    # Where the larger job takes more for each unit, it is the one whose seconds count.
    return (fixed, rate) if fixed else (0.0, values.sum() / work.sum())


def main():
    """Measure, print and write."""
    jobs = defaultdict(list)
    for results in sys.argv[1:]:
        for job in read_past(results).values():
            jobs[job["kind"]].append(job)
    calibration = calibrate()
    # What is kept was measured on a machine of another speed.
    ratio = calibration / SHIPPED["calibration"]
    costs = {kind: [ratio * fixed, ratio * rate, *size] for kind, (fixed, rate, *size) in SHIPPED["costs"].items()}
    for kind, same in sorted(jobs.items()):
        work = [job["work"] for job in same]
        seconds = fitted(work, [job["seconds"] for job in same], LEAST_SECONDS)
        costs[kind] = [*seconds, *fitted(work, [job["size"] for job in same], LEAST_SIZE)]
        print(f"{kind:32} {len(same):5d}  {seconds[0]:8.3f} s  {seconds[1]:.3e} s")
    rounded = {kind: [float(f"{value:.4g}") for value in cost] for kind, cost in sorted(costs.items())}
    lines = ",\n".join(f'  "{kind}": {json.dumps(cost)}' for kind, cost in rounded.items())
    FILE.write_text(f'{{\n "calibration": {calibration:.4g},\n "costs": {{\n{lines}\n }}\n}}\n')


if __name__ == "__main__":
    main()
