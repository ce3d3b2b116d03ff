"""Wall time of the points and their summaries, compared with the same workflow with point jobs that only import.

The baseline is a copy of the workflow with one line changed: instead of `bk simulate`, a point job imports NumPy and
netCDF4 and links to the point file made by the first run of the study. Jobs, dependencies, scheduler and all other
rules are the same, so the ratio is what the simulations add to a workflow of that many Python processes. The two run
in alternation, each in an empty folder; the ratio is the median over the pairs. It needs an otherwise idle machine:
where other programs take cores away, only the ratio of CPU times, which is also printed, is meaningful.
"""

from __future__ import annotations

import argparse
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from measure import print_table
from process import AS_TYPED, BIN, IMPORTS, ONE_THREAD, REPOSITORY, SNAKEFILE, children_cpu

#: All results of the default study that are made from its point files, except figures.
TARGETS = [
    f"results/paper/summary/{name}.nc" for name in ("mean_distance", "bifurcation_diagram", "lyapunov", "agreement")
]
POINT_RULE = "workflow/rules/points.smk"
POINT_COMMAND = '"{params.command} --out {output} > /dev/null 2> {log} || [ $? = 3 ]"'
PLANNED = re.compile(r"^(\d+) jobs: ", re.MULTILINE)


def make_baseline(folder: Path, outputs: Path) -> Path:
    """Copy the workflow with point jobs that import and link; return its Snakefile.

    outputs : folder of a finished run of the study
    """
    shutil.copy(REPOSITORY / "Snakefile", folder)
    (folder / "profiles").symlink_to("workflow/profiles")
    shutil.copytree(REPOSITORY / "workflow", folder / "workflow")
    shutil.copytree(REPOSITORY / "config", folder / "config")
    rule = folder / POINT_RULE
    text = rule.read_text(encoding="utf-8")
    if text.count(POINT_COMMAND) != 1:
        raise RuntimeError(f"{POINT_RULE} has changed: the line {POINT_COMMAND} is not in it")
    # A link costs almost nothing in the process that has already imported; `cp` would be one more process.
    script = f"{IMPORTS}, os; os.link('{outputs}/{{output}}', '{{output}}')"
    rule.write_text(text.replace(POINT_COMMAND, f'"python -c \\"{script}\\" 2> {{log}}"'), encoding="utf-8")
    return folder / "Snakefile"


def run_study(snakefile: Path, folder: Path, cores: int, environment: dict[str, str]) -> tuple[float, float, int]:
    """Run a workflow in an empty folder; return its wall time and CPU time in seconds and its number of jobs."""
    command = [str(BIN / "snakemake"), f"-c{cores}", "-s", str(snakefile), "-d", str(folder)]
    command += TARGETS
    folder.mkdir()
    cpu = -children_cpu()
    begin = time.perf_counter()
    result = subprocess.run(
        command, cwd=REPOSITORY, env=environment, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True
    )
    wall = time.perf_counter() - begin
    cpu += children_cpu()
    planned = PLANNED.search(result.stderr)
    if result.returncode or planned is None:
        sys.exit(f"{' '.join(command)} failed:\n{result.stderr[-4000:]}")
    return wall, cpu, int(planned[1])


def main() -> None:
    """Measure the pairs and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--pairs", type=int, default=2, help="pairs of runs (default: %(default)s)")
    parser.add_argument("--cores", type=int, default=2, help="cores of Snakemake (default: %(default)s)")
    parser.add_argument("--one-thread", action="store_true", help="no threads of the linear-algebra library")
    options = parser.parse_args()
    environment = ONE_THREAD if options.one_thread else AS_TYPED
    studies, baselines = [], []
    with tempfile.TemporaryDirectory() as temporary:
        folder = Path(temporary)
        baseline = make_baseline(folder / "workflow_of_imports", folder / "study_0")
        for number in range(options.pairs):
            for name, snakefile, runs in (
                ("study", SNAKEFILE, studies),
                ("imports", baseline, baselines),
            ):
                target = folder / f"{name}_{number}"
                runs.append(run_study(snakefile, target, options.cores, environment))
                print(f"{name} {number + 1}: {runs[-1][0]:.1f} s, CPU {runs[-1][1]:.1f} s", file=sys.stderr)
            if studies[-1][2] != baselines[-1][2]:
                sys.exit(f"not the same workflow: {studies[-1][2]} and {baselines[-1][2]} jobs")
    wall, cpu = (
        statistics.median(study[i] / base[i] for study, base in zip(studies, baselines, strict=True)) for i in (0, 1)
    )
    row = [f"{wall:.2f}", f"{cpu:.2f}"]
    row += [f"{statistics.median(run[i] for run in runs):.1f}" for i in (0, 1) for runs in (studies, baselines)]
    print(f"\nThe study, `snakemake -c{options.cores}`, against point jobs that are `python -c '{IMPORTS}'`.\n")
    header = ["wall ratio", "CPU ratio", "study s", "imports s", "study CPU s", "imports CPU s"]
    print_table([*header, "jobs", "pairs"], [[*row, studies[0][2], len(studies)]])


if __name__ == "__main__":
    main()
