"""Provokes every kind of fault, and checks that the next run ends with the bytes of an undisturbed study.

It runs the tiny study of the tests, kills it repeatedly at random moments, interrupts it, fills its disks, damages its
files, and runs it in a second clone with its own kernel. Exit code 1 if any byte differs.
"""

from __future__ import annotations

import argparse
import os
import random
import re
import shlex
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path

from measure import print_table

REPOSITORY = Path(__file__).resolve().parent.parent
sys.path.insert(0, str(REPOSITORY))

from tests.workflow.conftest import Study
from tests.workflow.faults import (
    COMPARED,
    STAGES,
    begin,
    differences,
    failures,
    flag_named,
    no_mounts,
    processes,
    read_only,
    remedies,
    running,
    small_disk,
    stages_running,
    temporaries,
    wait_for,
    wait_for_stages,
)
from tests.workflow.test_damage import DAMAGES, POINT

SIGNALS = (signal.SIGINT, signal.SIGTERM, signal.SIGHUP, signal.SIGKILL)
HEADER = ["fault", "moment", "stages hit", "files whole", "temporary", "next commands", "same bytes"]


class Trials:
    """A table of faults, each in its own folder, compared with an undisturbed study."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.rows: list[list[str]] = []
        self.finished = Study(folder / "finished")
        self.finished.ok()

    def copy(self) -> Study:
        """Return a copy of the finished study."""
        shutil.rmtree(self.folder / "trial", ignore_errors=True)
        subprocess.run(["cp", "-a", str(self.finished.folder), str(self.folder / "trial")], check=True)
        return Study(self.folder / "trial", self.finished.config.read_text())

    def new(self) -> Study:
        """Return a study that has not run yet."""
        shutil.rmtree(self.folder / "trial", ignore_errors=True)
        return Study(self.folder / "trial")

    def judge(self, study: Study, fault: str, moment: str = "", hit: str = "", remake: str = "") -> None:
        """Run the next commands until one succeeds, and compare.

        remake : a command that a message has named; else a flag is taken from Snakemake's own
        """
        whole = sum(1 for name in study.files(*COMPARED) if "/." not in name)
        left = len(temporaries(study))
        commands = []
        if remake:
            commands.append(remake)
            run_command(remake, study)
        run = study.run()
        if run.returncode:
            commands += ["snakemake -c2", f"snakemake {flag_named(run.stderr)}"]
            study.ok(flag_named(run.stderr))
            run = study.run()
        commands.append("snakemake -c2")
        good = run.returncode == 0 and not differences(study, self.finished) and not temporaries(study)
        listing = ", ".join(f"`{command}`" for command in commands)
        self.rows.append([fault, moment, hit, str(whole), str(left), listing, "yes" if good else "NO"])
        print(" | ".join(self.rows[-1]), file=sys.stderr, flush=True)

    def stopped(self, fault: str, good: bool) -> None:
        """Add a row for a fault whose run must stop, saying whether it did."""
        if not good:
            self.rows.append([fault, "", "", "", "", "did not stop with its reason", "NO"])


def run_command(command: str, study: Study) -> None:
    """Run a command of a message in the folder of a study."""
    path = f"{Path(sys.executable).parent}{os.pathsep}{os.environ['PATH']}"
    subprocess.run(
        shlex.split(command), cwd=study.folder, capture_output=True, env={**study.environment(), "PATH": path}
    )


def kills(trials: Trials, count: int, chance: random.Random) -> None:
    """Kill the whole process group at random moments, each stage in turn."""
    for number in range(count):
        study = trials.new()
        aim = STAGES[number % len(STAGES)]
        process = begin(study)
        began = time.monotonic()
        wait_for_stages(study, {aim}, process)
        time.sleep(chance.uniform(0.0, 0.5))
        os.killpg(process.pid, signal.SIGKILL)
        moment = f"{time.monotonic() - began:.2f} s"
        process.wait()
        trials.judge(study, f"SIGKILL {number + 1}", moment, ", ".join(sorted(stages_running(study))))


def interruptions(trials: Trials) -> None:
    """Send each signal to the process group and to Snakemake alone."""
    for number in SIGNALS:
        for group in (True, False):
            study = trials.new()
            process = begin(study)
            wait_for_stages(study, {"basins"}, process)
            began = time.monotonic()
            (os.killpg if group else os.kill)(process.pid, number)
            process.wait()
            # Jobs of a killed Snakemake continue and must end by themselves.
            wait_for(lambda study=study: not processes(study))
            moment = f"all ended after {time.monotonic() - began:.1f} s"
            hit = ", ".join(sorted(stages_running(study)))
            trials.judge(study, f"{number.name} to {'the group' if group else 'Snakemake alone'}", moment, hit)


def jobs_killed(trials: Trials) -> None:
    """Kill single jobs from outside, as the kernel does when memory runs out."""
    for stage in ("points", "attractors", "figures"):
        study = trials.new()
        process = begin(study)
        wait_for_stages(study, {stage}, process)

        def job(study: Study = study, stage: str = stage) -> int | None:
            words = {"points": "bk simulate", "attractors": ".attractors_of_law.py", "figures": ".figure_of_"}[stage]
            commands = processes(study).items()
            return next((number for number, command in commands if re.search(f"python.*{words}", command)), None)

        victim = None
        while victim is None and process.poll() is None:
            victim = job()
        os.kill(victim, signal.SIGKILL)
        process.wait()
        screen = (study.folder / "screen").read_text()
        trials.stopped(f"a job of {stage} killed", process.returncode == 1 and bool(failures(screen)))
        trials.judge(
            study, f"a job of {stage} killed", hit=", ".join(sorted({path.split("/")[0] for path in running(study)}))
        )


def disks(trials: Trials) -> None:
    """Fill the disk of each folder, and make results read-only during a run."""
    for folder, free in (("points", 200_000), ("summary", 60_000), ("figures", 900_000)):
        study = trials.copy()
        path = study.folder / "results" / "tiny" / folder
        for file in [file for file in path.rglob("*") if file.is_file()]:
            file.unlink()
        with small_disk(path, free) as ballast:
            run = study.run()
            reasons = failures(run.stderr).values() if run.returncode else []
            full = sum("No space left on device" in reason for reason in reasons)
            trials.stopped(f"disk of {folder} full", full > 0)
            ballast.unlink()
            trials.judge(study, f"disk of {folder} full", f"{free // 1000} kB left", f"{full} jobs failed")
    study = trials.new()
    process = begin(study)
    wait_for_stages(study, {"points"}, process)
    with read_only(study.folder / "results"):
        process.wait()
    trials.stopped("results read-only", process.returncode == 1)
    trials.judge(study, "results read-only", "while points are made", ", ".join(sorted(stages_running(study))))


def damages(trials: Trials) -> None:
    """Damage a point that is newer than the results made from it; the message names the command that recreates it."""
    for name, (spoil, _) in DAMAGES.items():
        study = trials.copy()
        target = study.folder / "results" / "tiny" / POINT
        spoil(target)
        remake = ""
        if target.exists():
            os.utime(target)
            run = study.run()
            reasons = failures(run.stderr) if run.returncode else {}
            named = remedies(run.stderr)
            trials.stopped(f"point: {name}", len(named) == 1 and "mean_distance.log" in reasons)
            remake = min(named, default="")
        trials.judge(study, f"point: {name}", remake=remake)


def clones(trials: Trials) -> None:
    """Run a clone with a freshly compiled kernel, on one core and on two."""
    clone = trials.folder / "clone"
    subprocess.run(["git", "clone", "--quiet", str(REPOSITORY), str(clone)], check=True)
    build = [sys.executable, "setup.py", "--quiet", "build_ext", "--inplace"]
    subprocess.run(build, cwd=clone, check=True, capture_output=True)
    for cores in (1, 2):
        study = trials.new()
        study.repository = clone
        run = study.run(cores=cores)
        good = run.returncode == 0 and not differences(study, trials.finished)
        row = [
            f"none, second clone, -c{cores}",
            "",
            "",
            str(len(study.files(*COMPARED))),
            "0",
            "",
            "yes" if good else "NO",
        ]
        trials.rows.append(row)


def main() -> None:
    """Run the trials and print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0], allow_abbrev=False)
    parser.add_argument("--kills", type=int, default=20, help="SIGKILLs of a whole run (default: %(default)s)")
    parser.add_argument("--seed", type=int, default=1, help="seed of their moments (default: %(default)s)")
    trials_of: dict[str, Callable[[Trials], None]] = {
        "interruptions": interruptions,
        "jobs": jobs_killed,
        "disks": disks,
        "damages": damages,
        "clones": clones,
    }
    parser.add_argument("--only", nargs="+", choices=["kills", *trials_of], help="these faults only (default: all)")
    options = parser.parse_args()
    wanted = options.only or ["kills", *trials_of]
    if "disks" in wanted and (reason := no_mounts()):
        print(f"disks left out: {reason}", file=sys.stderr)
        wanted = [name for name in wanted if name != "disks"]
    with tempfile.TemporaryDirectory() as folder:
        trials = Trials(Path(folder).resolve())
        if "kills" in wanted:
            kills(trials, options.kills, random.Random(options.seed))
        for name, run in trials_of.items():
            if name in wanted:
                run(trials)
    print_table(HEADER, trials.rows)
    if any(row[-1] != "yes" for row in trials.rows):
        sys.exit(1)


if __name__ == "__main__":
    main()
