"""Large studies: the cost of a run of many points, per point, and its memory.

Studies of several numbers of points, identical except for their grid of a, are run from nothing to their reports on two
cores, each in an empty folder. The cost of a point is the CPU time of Snakemake and all jobs over the number of points:
the wall time would depend on other programs. A second run has nothing to do; `bk check` then reads every file.
"""

from __future__ import annotations

import argparse
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from dataclasses import dataclass
from pathlib import Path

from measure import print_table
from process import BIN, ONE_THREAD, SNAKEMAKE, children_cpu
from stages import rules_of

LAWS, STATES = 2, 5
#: Of the whole range of a, so that small and large studies have the same kinds of motion.
A_RANGE = 0.3

CONFIG = """study: size
a_digits: 7
a: [{values}]
initial:
{states}
transient: 200
window: 400
batches: 4
attractors: {{samples: 4, transient: 300, window: 300, time_limit: 2000, pushes: 4}}
basins: {{a: {{linearized: [], nonlinear: []}}}}
chains: {{two_blocks: {{a: [0.02, 0.15], samples: 2}}}}
"""
#: The paper's positions, except that of the first block.
STATE = "  {name}: {{position: [{first}, -0.993, -0.991], velocity: [0.099, 0.1012, 0.1023]}}"


@dataclass
class Run:
    """Wall and CPU time in seconds of a command, and the peak memory in MB of its own process."""

    wall: float
    cpu: float
    memory: float


def config_of(points: int) -> str:
    """Return the config of a study of that many points."""
    count = points // (LAWS * STATES)
    values = ", ".join(f"{A_RANGE * (k + 1) / count:.7f}" for k in range(count))
    states = "\n".join(STATE.format(name=f"state{n}", first=-0.989 + 0.4 * n) for n in range(STATES))
    return CONFIG.format(values=values, states=states)


def run(command: list[str], folder: Path) -> Run:
    """Run a command to its end, sampling the memory of its process."""
    cpu, begin, peak = -children_cpu(), time.perf_counter(), 0.0
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, cwd=folder, env=ONE_THREAD, stdout=output, stderr=output)
        while process.poll() is None:
            try:
                status = Path(f"/proc/{process.pid}/status").read_text()
                peak = max(peak, *(float(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM")))
            except (OSError, TypeError):
                pass
            time.sleep(0.05)
        wall = time.perf_counter() - begin
        if process.returncode:
            output.seek(0)
            sys.exit(f"{' '.join(command)} failed:\n{output.read().decode()[-4000:]}")
    return Run(wall, cpu + children_cpu(), peak * 1024 / 1e6)


def measure(points: int, folder: Path, cores: int) -> tuple[list[object], dict[str, tuple[float, float]]]:
    """Run a study of that many points; return its row of the table and {rule: CPU s, largest MB}."""
    (folder / "size.yaml").write_text(config_of(points), encoding="utf-8")
    command = [*SNAKEMAKE, f"-c{cores}", "--configfile", "size.yaml"]
    plan = run([*command, "-n", "--quiet"], folder)
    whole = run(command, folder)
    again = run(command, folder)
    check = run([str(BIN / "bk"), "check", "results/size"], folder)
    size = sum(path.stat().st_size for path in folder.joinpath("results/size/points").rglob("*.nc")) / 1e6
    rules: dict[str, tuple[float, float]] = defaultdict(lambda: (0.0, 0.0))
    rules.update((rule.name, (rule.cpu, rule.memory)) for rule in rules_of(folder / "results/size"))
    row = [points, f"{plan.wall:.1f}", f"{whole.wall / 60:.1f}", f"{whole.cpu / points:.3f}", f"{whole.memory:.0f}"]
    row += [f"{again.wall:.1f}", f"{check.wall:.1f}", f"{size:.0f}"]
    print(f"{points} points: {whole.wall:.0f} s", file=sys.stderr)
    return row, rules


def main() -> None:
    """Measure the studies and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--points", type=int, nargs="+", default=[500, 10_000], help="(default: %(default)s)")
    parser.add_argument("--cores", type=int, default=2, help="cores of Snakemake (default: %(default)s)")
    parser.add_argument("--folder", type=Path, help="where the studies stay (default: nowhere)")
    options = parser.parse_args()
    rows, rules = [], []
    with tempfile.TemporaryDirectory() as temporary:
        for points in options.points:
            folder = (options.folder or Path(temporary)) / f"points{points}"
            folder.mkdir(parents=True)
            row, rule_costs = measure(points, folder, options.cores)
            rows.append(row)
            rules.append(rule_costs)
    header = ["points", "dry run s", "run min", "CPU s a point", "Snakemake MB", "no-op s", "check s", "points MB"]
    print_table(header, rows)
    table = []
    for rule in sorted(rules[-1], key=lambda name: -rules[-1][name][0]):
        memory = rules[-1][rule][1]
        costs = [
            1000.0 * rule_costs[rule][0] / points for rule_costs, points in zip(rules, options.points, strict=True)
        ]
        table.append([rule, *(f"{cost:.2f}" for cost in costs), f"{memory:.0f}"])
    names = [f"ms a point, {points}" for points in options.points]
    print_table(["rule", *names, "MB, largest"], table)


if __name__ == "__main__":
    main()
