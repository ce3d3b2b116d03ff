"""Programs of this checkout, and the CPU time and memory of processes."""

from __future__ import annotations

import os
import resource
import subprocess
import sys
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
#: Next to the interpreter as it was called, since the interpreter of a virtual environment is a link.
BIN = Path(sys.executable).parent
SNAKEFILE = REPOSITORY / "Snakefile"
SNAKEMAKE = [str(BIN / "snakemake"), "-s", str(SNAKEFILE)]

#: As at a prompt, where importing NumPy starts a linear-algebra thread for every core.
AS_TYPED = {key: value for key, value in os.environ.items() if key != "OPENBLAS_NUM_THREADS"}
#: Without those threads, as in `bk`.
ONE_THREAD = AS_TYPED | {"OPENBLAS_NUM_THREADS": "1"}

#: The minimum that a Python job that writes netCDF has to do.
IMPORTS = "import numpy, netCDF4"


@dataclass(frozen=True)
class Usage:
    """CPU time (user and system) in seconds and peak memory in MB of one process and what it has waited for."""

    cpu: float
    memory: float


def run(command: Sequence[str], environment: Mapping[str, str] = AS_TYPED) -> Usage:
    """Run a command; raise CalledProcessError if it fails."""
    process = subprocess.Popen(command, env=dict(environment))
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    if process.returncode:
        raise subprocess.CalledProcessError(process.returncode, command)
    # Linux counts ru_maxrss in KiB.
    return Usage(used.ru_utime + used.ru_stime, used.ru_maxrss * 1024 / 1e6)


def children_cpu() -> float:
    """Return the user and system time in seconds of all processes run so far, theirs included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime
