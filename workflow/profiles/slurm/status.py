#!/usr/bin/env python3
"""Print running, success or failed for a job that submit.py has submitted.

    status.py NUMBER:NAME

A job has succeeded if its script left the exit code 0, whatever Slurm reports. A job without an exit code has failed
once Slurm no longer lists it as live. If Slurm does not answer, a job counts as running. The folder of a successful job
is removed, since Snakemake itself then records the success.
"""

import shutil
import sys
import time

from jobs import FOLDER, OUTPUT, ask, exit_code

#: States of a job that has not ended.
LIVE = {"PENDING", "CONFIGURING", "RUNNING", "SUSPENDED", "COMPLETING", "STAGE_OUT", "SIGNALING", "STOPPED", "RESIZING"}
#: States of a job whose script has ended by itself; its exit code may become visible here later.
ENDED = {"COMPLETED", "FAILED", "UNKNOWN"}
#: Seconds until a file that another node has written is visible here.
LATENCY = 60.0


def main():
    """Print the status; return the exit code."""
    number, _, name = sys.argv[1].partition(":")
    job = FOLDER / name
    # Slurm is asked first: a job that ends after its answer is found by the next call.
    state = slurm_state(number, name)
    code = exit_code(job)
    if code == 0:
        shutil.rmtree(job, ignore_errors=True)
        print("success")
    elif state in LIVE or (code is None and state in ENDED and waited(job) < LATENCY):
        print("running")
    else:
        words = "no exit code" if code is None else f"exit code {code}"
        print(f"Slurm job {number} {name}: {state}, {words}, output in {job / OUTPUT}", file=sys.stderr)
        print("failed")
    return 0


def slurm_state(number, name):
    """Return the state of a job; UNKNOWN if it was forgotten, RUNNING if Slurm does not answer."""
    if number == "0":
        return "UNKNOWN"
    answer = ask("scontrol", "--oneliner", "show", "job", number)
    if answer.returncode:
        return "UNKNOWN" if "Invalid job id" in answer.stderr + answer.stdout else "RUNNING"
    fields = dict(word.partition("=")[::2] for word in answer.stdout.split())
    # A new installation of Slurm may number its jobs from 1 again.
    return fields.get("JobState", "RUNNING") if fields.get("JobName") == name else "UNKNOWN"


def waited(job):
    """Return the seconds since the end of a job was first seen."""
    mark = job / "ended"
    try:
        if not mark.exists():
            mark.touch()
        return time.time() - mark.stat().st_mtime
    except OSError:
        # The folder itself is gone, and with it any exit code.
        return LATENCY


if __name__ == "__main__":
    sys.exit(main())
