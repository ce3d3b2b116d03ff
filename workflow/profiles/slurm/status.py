#!/usr/bin/env python3
"""Print running, success or failed for a job of Slurm.

    status.py NUMBER

If Slurm does not answer, a job counts as running. If Slurm has forgotten it, its own mark tells whether it succeeded.
"""

import re
import sys

from jobs import FOLDER, ask

#: States of a job that has not ended.
LIVE = {"PENDING", "CONFIGURING", "RUNNING", "SUSPENDED", "COMPLETING", "STAGE_OUT", "SIGNALING", "STOPPED", "RESIZING"}


def main():
    """Print the status; return the exit code."""
    number = sys.argv[1]
    output, done = FOLDER / f"{number}.txt", FOLDER / f"{number}.done"
    answer = ask("scontrol", "--oneliner", "show", "job", number)
    state = re.search(r" JobState=(\w+)", answer.stdout)
    if state:
        state = state[1]
    elif "Invalid job id" in answer.stderr:
        state = "COMPLETED" if done.exists() else "forgotten"
    if state == "COMPLETED":
        print("success")
        for path in (output, done):
            if path.exists():
                path.unlink()
    elif state is None or state in LIVE:
        print("running")
    else:
        print(f"Slurm job {number}: {state}, output in {output}", file=sys.stderr)
        print("failed")
    return 0


if __name__ == "__main__":
    sys.exit(main())
