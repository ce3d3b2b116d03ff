#!/usr/bin/env python3
"""Submit a job script of Snakemake to Slurm and print `<Slurm's number>:<name>`, unless an earlier job does the same.

    BK_STUDY="results/STUDY DIGEST" submit.py JOBSCRIPT

If a job of an earlier run makes the same files from the same study, and is live or has succeeded without its Snakemake,
its number and name are printed instead. An earlier job that makes some of the files from another study or from older
inputs is cancelled, and the new job begins when it has ended.

Exit code 1, with one line on stderr, if Slurm refuses the job or does not answer.
"""

import json
import os
import re
import secrets
import shlex
import sys
from pathlib import Path

from jobs import FOLDER, OUTPUT, RECORD, ask, attempts, exit_code, live_jobs, one_line

#: Messages of sbatch if the controller does not answer, or accepts no job at the moment.
NO_ANSWER = re.compile(
    "contact|timed out|connect|communication|zero bytes|temporarily|try again|submit limit", re.IGNORECASE
)
#: Additional needs of the Snakemake inside a job: memory in MB, and minutes to start on a slow file system.
SNAKEMAKE_MB, SNAKEMAKE_MINUTES = 250, 5

# All processes of the job receive SIGTERM: whatever the script returns then, the job was ended from outside.
SCRIPT = """#!/bin/sh
trap 'ended=143' TERM
sh {folder}/snakemake.sh
code=$?
echo "${{ended:-$code}}" > {folder}/exit.part
mv {folder}/exit.part {folder}/exit
exit "${{ended:-$code}}"
"""


def main():
    """Find or submit the job; return the exit code."""
    script = Path(sys.argv[1]).read_text()
    properties = json.loads(re.search("^# properties = (.*)$", script, re.MULTILINE).group(1))
    options = read_options(script)
    # Two studies may run in one folder; their jobs have the same names.
    results, study = os.environ["BK_STUDY"].split()
    targets = sorted(f"{results} {target}" for target in options["--target-jobs"])
    try:
        live = live_jobs()
        same, others = earlier_jobs(targets, study, newest_input(options), live)
        if same is not None:
            print(f"{live.get(same.name, 0)}:{same.name}")
            return 0
        label = properties["groupid"] if properties["type"] == "group" else properties["rule"]
        job = FOLDER / f"{label}-{secrets.token_hex(8)}"
        job.mkdir(parents=True)
        (job / "snakemake.sh").write_text(script)
        # The record is written last: the folder is then complete.
        (job / RECORD).write_text(json.dumps({"study": study, "targets": targets}))
        attempt = int(options["--attempt"][0])
        number = submit(job, requests(properties, attempt), others)
    except OSError as error:
        print(f"submit.py: {error}", file=sys.stderr)
        return 1
    print(f"{number}:{job.name}")
    return 0


def read_options(script):
    """Return {option: values} of the `snakemake` command in a job script."""
    options, values = {}, []
    for word in shlex.split(script, comments=True):
        if word.startswith("--"):
            options[word] = values = []
        else:
            values.append(word)
    return options


def newest_input(options):
    """Return the modification time of the newest file that a job reads, or infinity if a file is missing."""
    files = list(options.get("--wait-for-files", []))
    for name in options.get("--wait-for-files-file", []):
        files += Path(name).read_text().splitlines()
    try:
        # Folders are left out: Snakemake lists its own folder of this run.
        return max((path.stat().st_mtime for path in map(Path, files) if not path.is_dir()), default=0.0)
    except OSError:
        return float("inf")


def earlier_jobs(targets, study, newest, live):
    """Return the job that makes exactly these targets, or None, and the numbers of the jobs to wait for."""
    others = []
    for job in sorted(FOLDER.glob("*")):
        try:
            record = json.loads((job / RECORD).read_text())
            # Measured by the clock of the file system that contains the inputs.
            submitted = (job / RECORD).stat().st_mtime
        except (OSError, ValueError):
            continue
        if set(targets).isdisjoint(record["targets"]):
            continue
        current = record["study"] == study and submitted > newest
        if current and record["targets"] == targets and (job.name in live or exit_code(job) == 0):
            return job, []
        if job.name in live:
            others.append(live[job.name])
            if not current:
                ask("scancel", live[job.name])
    return None, others


def requests(properties, attempt):
    """Return the options of sbatch for a job; memory and time, which may have been short, grow with each attempt."""
    resources = properties["resources"]
    options = [
        "--nodes=1",
        "--ntasks=1",
        f"--cpus-per-task={resources.get('cpus_per_task', properties['threads'])}",
        f"--mem={SNAKEMAKE_MB + resources['mem_mb'] * attempt}M",
        f"--time={SNAKEMAKE_MINUTES + resources['runtime'] * attempt}",
    ]
    for name in ("partition", "account", "qos"):
        if f"slurm_{name}" in resources:
            options.append(f"--{name}={resources[f'slurm_{name}']}")
    return options + shlex.split(resources.get("slurm_extra", ""))


def submit(job, options, others):
    """Submit a job that begins when all others have ended; return Slurm's number, or raise OSError if it is refused."""
    command = ["sbatch", "--parsable", f"--job-name={job.name}", f"--output={job / OUTPUT}", *options]
    # Only Snakemake counts and repeats attempts.
    command.append("--no-requeue")
    if others:
        command.append("--dependency=afterany:" + ":".join(others))
    for number in attempts():
        # The job may have been accepted and the answer lost.
        taken = live_jobs().get(job.name) if number else None
        if taken:
            return taken
        answer = ask(*command, input=SCRIPT.format(folder=job))
        if answer.returncode == 0:
            return answer.stdout.strip().partition(";")[0]
        if not NO_ANSWER.search(answer.stderr):
            break
    raise OSError(one_line(answer.stderr))


if __name__ == "__main__":
    sys.exit(main())
