#!/usr/bin/env python3
"""Cancel the jobs of a study that an earlier run left in this folder, and wait for their end; functions of the others.

    jobs.py STUDY

Exit code 1, with one line on stderr, if they do not end or Slurm does not answer. All programs of this folder use only
the standard library of Python 3.8 or later.
"""

import itertools
import os
import subprocess
import sys
import time
from pathlib import Path

#: What a job writes; `NUMBER.done` is made when its script has succeeded.
FOLDER = Path(".snakemake/slurm")
#: Seconds for which requests are repeated, to a controller that does not answer for example, and seconds between them.
PATIENCE, PAUSE = 300.0, 5.0


def main():
    """Cancel the jobs; return the exit code."""
    try:
        for number in attempts():
            left = live_jobs(sys.argv[1])
            if not left:
                return 0
            if number == 0:
                print(f"Slurm jobs of an earlier run are cancelled: {' '.join(left.values())}", file=sys.stderr)
            ask("scancel", *left.values())
        raise OSError(f"cancelled jobs do not end: {' '.join(left.values())}")
    except OSError as error:
        print(f"jobs.py: {error}", file=sys.stderr)
        return 1


def live_jobs(study):
    """Return {name: number} of the jobs of a study in this folder that have not ended.

    Raises OSError if Slurm does not answer.
    """
    for _ in attempts():
        answer = ask("squeue", "--me", "--noheader", "--format=%A|%j|%Z")
        if answer.returncode == 0:
            jobs = (line.split("|", 2) for line in answer.stdout.splitlines())
            here = (study, os.getcwd())
            return {name: number for number, name, folder in jobs if (name.partition(".")[0], folder) == here}
    raise OSError("squeue: " + one_line(answer.stderr))


def attempts():
    """Count the attempts at a request, with a pause after each."""
    end = time.monotonic() + PATIENCE
    for number in itertools.count():
        yield number
        if time.monotonic() > end:
            return
        time.sleep(PAUSE)


def ask(*command, **options):
    """Run a program of Slurm to its end; return its result with its output."""
    return subprocess.run(command, capture_output=True, text=True, **options)


def one_line(text):
    """Return the last non-empty line of a text."""
    return next((line.strip() for line in reversed(text.splitlines()) if line.strip()), "no reason given")


if __name__ == "__main__":
    sys.exit(main())
