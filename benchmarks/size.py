"""Large studies: the cost of a run of many points, per point, and its memory.

Studies of several numbers of points, identical except for their grid of a, are run from nothing to their reports on two
cores, each in an empty folder. The cost of a point is the CPU time of Snakemake and all jobs over the number of points:
the wall time would depend on other programs. A second run has nothing to do; `bk check` then reads every file.
"""

from __future__ import annotations

import argparse
import sys
import tempfile
from collections import defaultdict
from pathlib import Path

from measure import BIN, SNAKEMAKE, print_table, run

from burridge_knopoff.report.stages import read_stages

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


def config_of(points: int) -> str:
    """Return the config of a study of that many points."""
    count = points // (LAWS * STATES)
    values = ", ".join(f"{A_RANGE * (k + 1) / count:.7f}" for k in range(count))
    states = "\n".join(STATE.format(name=f"state{n}", first=-0.989 + 0.4 * n) for n in range(STATES))
    return CONFIG.format(values=values, states=states)


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
    stages = read_stages(folder / "results/size/benchmarks")
    rules.update((stage.name, (stage.cpu, stage.memory)) for stage in stages)
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
