"""Cost of planning studies of many points, and the disk space that they need: some are in docs/cluster.md.

For each number of points a config is written and planned (`snakemake -n`), on this machine and for Slurm, where points
form groups; and one of its points is planned alone, as every submitted job does before it begins. Numbers of points
above `--largest` are not planned but extrapolated: a straight line through the last two that were measured, which is
the least. The size of a point file is the mean over a sample of runs with the default settings.
"""

from __future__ import annotations

import argparse
import math
import statistics
import subprocess
import tempfile
from itertools import chain
from pathlib import Path

import yaml
from measure import BIN, REPOSITORY, SNAKEMAKE, print_table, run

PROFILE = REPOSITORY / "workflow" / "profiles" / "slurm"
#: Profiles with which studies are planned, by the names of their columns.
PROFILES = {"plan": REPOSITORY / "workflow" / "profiles" / "default", "plan for Slurm": PROFILE}
#: Two laws and two initial states.
POINTS_OF_A_VALUE = 4
STEP = 1e-6
CONFIG = """
study: planning
a: [{{from: 0.1, to: {last:.6f}, step: 0.000001}}]
a_digits: 6
initial: {{minus: {{}}, plus: {{}}}}
"""
TARGET = "results/planning/points/linearized/plus/a0.100000.nc"
#: A point leaves its file, a log, a benchmark, and Snakemake's record of it.
FILES_OF_A_POINT = 4


def planned(folder: Path, target: str, profile: Path) -> tuple[float, float]:
    """Return CPU time in seconds and peak memory in MB of a dry run."""
    command = [*SNAKEMAKE, "-n", "-d", str(folder), "--workflow-profile", str(profile), target]
    used = run([*command, "--configfile", str(folder / "study.yaml")], folder)
    return used.cpu, used.memory


def point_size() -> float:
    """Return the mean size in KB of point files made with the default settings."""
    sizes = []
    with tempfile.TemporaryDirectory() as folder:
        for law in ("linearized", "nonlinear"):
            for a in ("0.05", "0.1", "0.2", "0.3"):
                path = Path(folder, f"{law}{a}.nc")
                options = ["--law", law, "--a", a, "--initial", "plus", "--out", str(path)]
                subprocess.run([str(BIN / "bk"), "simulate", *options], check=True)
                sizes.append(path.stat().st_size / 1e3)
    return statistics.mean(sizes)


def main() -> None:
    """Measure, extrapolate, and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--points", type=int, nargs="+", default=[100, 1000, 3000, 10_000, 1_000_000])
    parser.add_argument("--largest", type=int, default=10_000, help="planned in earnest (default: %(default)s)")
    options = parser.parse_args()
    group = yaml.safe_load((PROFILE / "config.yaml").read_text(encoding="utf-8"))["group-components"]["points"]
    size = point_size()
    rows = []
    measured: list[tuple[int, list[float]]] = []
    for points in sorted(options.points):
        if points <= options.largest:
            with tempfile.TemporaryDirectory() as name:
                folder = Path(name)
                last = 0.1 + (points // POINTS_OF_A_VALUE - 1) * STEP
                (folder / "study.yaml").write_text(CONFIG.format(last=last), encoding="utf-8")
                plans = [planned(folder, "all", profile) for profile in PROFILES.values()]
                figures = [*chain(*plans), *planned(folder, TARGET, PROFILE)]
            measured.append((points, figures))
            how = "measured"
        else:
            (first, low), (second, high) = measured[-2:]
            share = (points - first) / (second - first)
            figures = [begin + share * (end - begin) for begin, end in zip(low, high, strict=True)]
            how = f"extrapolated from {first} and {second}"
        rows.append(
            [
                points,
                *(f"{value:.3g}" for value in figures),
                math.ceil(points / group),
                FILES_OF_A_POINT * points,
                f"{points * size / 1e6:.3g}",
                how,
            ]
        )
    plans = [f"{name} {unit}" for name in PROFILES for unit in ("CPU s", "MB")]
    header = ["points", *plans, "start of a job CPU s", "MB", "submissions", "files", "GB"]
    print(f"\nPoints in groups of {group}; a point file has {size:.0f} KB.\n")
    print_table([*header, "how"], rows)


if __name__ == "__main__":
    main()
