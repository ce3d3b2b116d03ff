"""Wall time of the same point jobs on Slurm by two executor plugins of Snakemake, one by one and in groups.

It needs a cluster (`tests/slurm/cluster.sh start FOLDER`, `export SLURM_CONF=FOLDER/slurm.conf`) and both plugins in
the environment: snakemake-executor-plugin-cluster-generic, which `workflow/profiles/slurm` uses, and
snakemake-executor-plugin-slurm. The latter removes SLURM_CONF from its jobs, so that /etc/slurm/slurm.conf must lead to
the same cluster; otherwise it is left out.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measure import print_table
from process import REPOSITORY, SNAKEMAKE

PROFILE = REPOSITORY / "workflow" / "profiles" / "slurm"
CONFIG = """
study: plugins
a: [{{from: 0.01, to: {last:g}, step: 0.01}}]
initial: {{minus: {{}}, plus: {{}}}}
transient: 100
window: 200
batches: 4
"""
#: What the other plugin needs in place of the programs of the profile.
OTHER = ["--executor", "slurm", "--slurm-status-command", "squeue", "--cores", "1"]


def wall(options: list[str], config: str) -> float:
    """Return the wall time in seconds of all points of a config."""
    with tempfile.TemporaryDirectory() as folder:
        Path(folder, "study.yaml").write_text(config)
        command = [*SNAKEMAKE, *options]
        begin = time.perf_counter()
        run = subprocess.run(
            [*command, "--configfile", "study.yaml", "--", "points"], cwd=folder, capture_output=True, text=True
        )
        if run.returncode:
            sys.exit(f"{' '.join(command)} failed:\n{run.stderr[-4000:]}")
        return time.perf_counter() - begin


def main() -> None:
    """Measure and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--values", type=int, default=10, help="values of a, with four points each (default: 10)")
    values = parser.parse_args().values
    if "SLURM_CONF" not in os.environ:
        sys.exit("SLURM_CONF is not set: start a cluster with tests/slurm/cluster.sh")
    points = 4 * values
    config = CONFIG.format(last=0.01 * values)
    contestants = {"cluster-generic": [], "slurm": OTHER}
    central = Path("/etc/slurm/slurm.conf")
    if not central.exists() or not central.samefile(os.environ["SLURM_CONF"]):
        del contestants["slurm"]
    rows = []
    for plugin, options in contestants.items():
        for size in (1, points // 2):
            profile = ["--workflow-profile", str(PROFILE), "--seconds-between-status-checks", "1"]
            seconds = wall([*profile, "--group-components", f"points={size}", *options], config)
            rows.append([f"{seconds:.0f}", points, size, plugin])
    print_table(["wall s", "points", "points in a group", "plugin"], rows)


if __name__ == "__main__":
    main()
