"""Functions shared by submit.py, status.py and cancel.py: the folder of a submission, and requests to Slurm.

`.snakemake/slurm/<name>/` contains `record.json` (the files that the job makes, and from what), its script, Slurm's
output and, once the script has ended, `exit` with its exit code. The folder is created before the job is submitted, and
the job has its name in Slurm: the next Snakemake finds a job whose own Snakemake was killed.

These programs use only the standard library of Python 3.8 or later.
"""

import itertools
import subprocess
import time
from pathlib import Path

FOLDER = Path(".snakemake/slurm")
#: In the folder of a job.
RECORD, OUTPUT = "record.json", "output.txt"
#: Seconds for which requests to a controller that does not answer are repeated, and seconds between them.
PATIENCE, PAUSE = 300.0, 5.0


def exit_code(job):
    """Return the exit code of the script in the folder of a job; None while it has none."""
    try:
        # Listing a folder makes a network file system refresh it.
        list(job.iterdir())
        return int((job / "exit").read_text())
    except (OSError, ValueError):
        return None


def live_jobs():
    """Return {name: Slurm's number} of this user's jobs that have not ended; raise OSError if Slurm does not answer."""
    for _ in attempts():
        answer = ask("squeue", "--me", "--noheader", "--format=%A|%j")
        if answer.returncode == 0:
            return {name: number for number, _, name in (line.partition("|") for line in answer.stdout.splitlines())}
    raise OSError("squeue: " + one_line(answer.stderr))


def attempts():
    """Count the attempts to reach a controller that does not answer, with a pause after each."""
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
