"""What submit.py, status.py and cancel.py share: a folder for each submission, and how Slurm is asked.

`.snakemake/slurm/<name>/` holds `record.json` (what the job makes, and from what), its script, Slurm's output and, once
the script has ended, `exit` with its exit code. The folder is there before Slurm knows the job, and the job's name in
Slurm is that of the folder: a job whose Snakemake was killed is found again by the next one.

These programs use nothing but the standard library of any Python 3 from 3.8.
"""

import itertools
import subprocess
import time
from pathlib import Path

FOLDER = Path(".snakemake/slurm")
#: In the folder of a job.
RECORD, OUTPUT = "record.json", "output.txt"
#: Seconds for which a controller that does not answer is asked again, and between two attempts.
PATIENCE, PAUSE = 300.0, 5.0


def exit_code(job):
    """Return the exit code of the script in the folder of a job; None while it has none."""
    try:
        # To list a folder makes a network file system look again.
        list(job.iterdir())
        return int((job / "exit").read_text())
    except (OSError, ValueError):
        return None


def live_jobs():
    """Return {name: Slurm's number} of the jobs of this user that have not ended; raise OSError if Slurm cannot say."""
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
    """Run a program of Slurm to its end; return it with what it wrote."""
    return subprocess.run(command, capture_output=True, text=True, **options)


def one_line(text):
    """Return the last line of a text that is not empty."""
    return next((line.strip() for line in reversed(text.splitlines()) if line.strip()), "no reason given")
