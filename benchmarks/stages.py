"""Wall time of a study stage by stage, and the CPU time and peak memory of its largest job of each rule.

It runs the default study, or another config, from nothing in a folder of its own on two cores, and reads what Snakemake
has measured of each job. `--target chains` runs the optional stage of longer chains.
"""

from __future__ import annotations

import argparse
import os
import subprocess
import sys
import tempfile
import time
from collections import defaultdict
from pathlib import Path

from measure import print_table, verdict

from burridge_knopoff.study.job_costs import read_costs

REPOSITORY = Path(__file__).resolve().parent.parent
LIMIT_MB = 400.0
LIMIT_MINUTES = {"all": 6.0, "basins": 2.0, "chains": 5.0}


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
    """Run the study and print the tables."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--cores", type=int, default=2, help="cores of Snakemake (default: %(default)s)")
    parser.add_argument("--configfile", type=Path, help="config of the study (default: that of the Snakefile)")
    parser.add_argument("--target", default="all", help="target of Snakemake (default: %(default)s)")
    options = parser.parse_args()
    snakemake = [
        str(Path(sys.executable).parent / "snakemake"),
        f"-c{options.cores}",
        "-s",
        str(REPOSITORY / "workflow/Snakefile"),
    ]
    with tempfile.TemporaryDirectory() as folder:
        # A target stands before --configfile, which takes all that follows.
        command = [*snakemake, "-d", folder, options.target]
        if options.configfile is not None:
            command += ["--configfile", str(options.configfile.resolve())]
        begin = time.perf_counter()
        run = subprocess.run(command, cwd=REPOSITORY, env=os.environ, capture_output=True, text=True)
        wall = time.perf_counter() - begin
        if run.returncode:
            sys.exit(f"{' '.join(command)} failed:\n{run.stderr[-4000:]}")
        results = next((Path(folder) / "results").iterdir())
        measured = jobs(results / "benchmarks")
    rows = []
    for rule, values in sorted(measured.items(), key=lambda item: -sum(value[1] for value in item[1])):
        total = [sum(value[k] for value in values) for k in (0, 1)]
        memory = max(value[2] for value in values)
        rows.append(
            [rule, len(values), f"{total[0]:.1f}", f"{total[1]:.1f}", f"{memory:.0f}", verdict(memory, LIMIT_MB)]
        )
    print_table(["rule", "jobs", "wall s, sum", "CPU s, sum", "MB, largest", f"under {LIMIT_MB:g} MB"], rows)
    limit = LIMIT_MINUTES.get(options.target)
    kept = "" if limit is None else f"{limit:g}, {verdict(wall / 60.0, limit)}"
    print_table(
        ["target", "cores", "minutes", "limit, kept"], [[options.target, options.cores, f"{wall / 60.0:.2f}", kept]]
    )


if __name__ == "__main__":
    main()
