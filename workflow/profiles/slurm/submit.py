#!/usr/bin/env python3
"""Submit a job script of Snakemake to Slurm and print Slurm's number of the job.

    BK_STUDY=STUDY submit.py JOBSCRIPT

Exit code 1, with one line on stderr, if Slurm refuses the job or does not answer.
"""

import json
import os
import re
import secrets
import shlex
import sys
from pathlib import Path

from jobs import FOLDER, ask, attempts, live_jobs, one_line

#: Messages of sbatch if the controller does not answer, or accepts no job at the moment.
NO_ANSWER = re.compile(
    "contact|timed out|connect|communication|zero bytes|temporarily|try again|submit limit", re.IGNORECASE
)
#: Additional needs of the Snakemake inside a job: memory in MB, and minutes to start on a slow file system.
SNAKEMAKE_MB, SNAKEMAKE_MINUTES = 250, 5

# A new installation of Slurm numbers its jobs from 1 again: an old mark says nothing.
SCRIPT = """#!/bin/sh
done={folder}/$SLURM_JOB_ID.done
rm -f $done
(
{script}
) && touch $done
"""


def main():
    """Submit the job; return the exit code."""
    script = Path(sys.argv[1]).read_text()
    properties = json.loads(re.search("^# properties = (.*)$", script, re.MULTILINE).group(1))
    attempt = int(re.search(r" --attempt (\d+)", script).group(1))
    FOLDER.mkdir(parents=True, exist_ok=True)
    try:
        print(submit(SCRIPT.format(folder=FOLDER, script=script), properties, attempt))
    except OSError as error:
        print(f"submit.py: {error}", file=sys.stderr)
        return 1
    return 0


def submit(script, properties, attempt):
    """Submit a script; return Slurm's number of the job, or raise OSError if it is refused."""
    study = os.environ["BK_STUDY"]
    label = properties["groupid"] if properties["type"] == "group" else properties["rule"]
    name = f"{study}.{label}.{secrets.token_hex(8)}"
    command = ["sbatch", "--parsable", f"--job-name={name}", f"--chdir={os.getcwd()}", f"--output={FOLDER}/%j.txt"]
    command += requests(properties, attempt)
    for number in attempts():
        # The job may have been accepted and the answer lost.
        taken = live_jobs(study).get(name) if number else None
        if taken:
            return taken
        answer = ask(*command, input=script)
        if answer.returncode == 0:
            return answer.stdout.strip().partition(";")[0]
        if not NO_ANSWER.search(answer.stderr):
            break
    raise OSError(one_line(answer.stderr))


def requests(properties, attempt):
    """Return the options of sbatch for a job; memory and time, which may have been short, grow with each attempt."""
    resources = properties["resources"]
    options = [
        # Only Snakemake counts and repeats attempts.
        "--no-requeue",
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


if __name__ == "__main__":
    sys.exit(main())
