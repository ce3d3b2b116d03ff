"""What submit.py, status.py and cancel.py share: a folder for each submission, and how Slurm is asked.

`.snakemake/slurm/<name>/` holds `record.json` (what the job makes, and from what), its script, Slurm's output and, once
the script has ended, `exit` with its exit code. The folder is there before Slurm knows the job, and the job's name in
Slurm is that of the folder: a job whose Snakemake was killed is found again by the next one.

These programs use nothing but the standard library of any Python 3 from 3.8.
"""

import json
import re
import subprocess
import time
from pathlib import Path

FOLDER = Path(".snakemake/slurm")
#: Seconds for which a controller that does not answer is asked again, and between two attempts.
PATIENCE, PAUSE = 300.0, 5.0
#: What Slurm's programs say when the controller does not answer or has no room now.
NO_ANSWER = re.compile(
    "contact|timed out|connect|communication|zero bytes|temporarily|try again|submit limit", re.IGNORECASE
)


class Job:
    """A submission: its folder, and what lies there."""

    def __init__(self, name):
        self.name = name
        self.folder = FOLDER / name

    @property
    def output(self):
        """What the script wrote, by Slurm."""
        return self.folder / "output.txt"

    def record(self):
        """Return the content of record.json; {} if it cannot be read."""
        try:
            return json.loads((self.folder / "record.json").read_text())
        except (OSError, ValueError):
            return {}

    def submitted(self):
        """Return when the record was written, by the clock of the file system that also holds the inputs."""
        return (self.folder / "record.json").stat().st_mtime

    def exit_code(self):
        """Return the exit code of the script; None while it has none."""
        try:
            # To list a folder makes a network file system look again.
            list(self.folder.iterdir())
            return int((self.folder / "exit").read_text())
        except (OSError, ValueError):
            return None


def known_jobs():
    """Return the jobs of all folders."""
    return [Job(path.name) for path in sorted(FOLDER.iterdir())] if FOLDER.is_dir() else []


def live_jobs():
    """Return {name: Slurm's number} of the jobs of this user that have not ended; raise OSError if Slurm cannot say."""
    end = time.monotonic() + PATIENCE
    while True:
        answer = ask("squeue", "--me", "--noheader", "--format=%A|%j")
        if answer.returncode == 0:
            return {name: number for number, _, name in (line.partition("|") for line in answer.stdout.splitlines())}
        if time.monotonic() > end:
            raise OSError("squeue: " + one_line(answer.stderr))
        time.sleep(PAUSE)


def ask(*command, **options):
    """Run a program of Slurm to its end; return it with what it wrote."""
    return subprocess.run(command, capture_output=True, text=True, **options)


def one_line(text):
    """Return the last line of a text that is not empty."""
    return next((line.strip() for line in reversed(text.splitlines()) if line.strip()), "no reason given")
