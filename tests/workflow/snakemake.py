"""Runs of Snakemake in forks of a process that has imported it: where there is little to do, two thirds of the time.

Tests that kill it, and those on a terminal, start the program itself.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

#: Imports nothing of the project: that is another one in every folder.
SERVER = """
import json, os, sys
import snakemake.cli, snakemake.dag, snakemake.report
import netCDF4, numpy, scipy.linalg, scipy.optimize, smart_open, xarray
for line in sys.stdin:
    call = json.loads(line)
    process = os.fork()
    if not process:
        os.chdir(call["folder"])
        os.environ.clear()
        os.environ.update(call["environment"])
        sys.path[:0] = os.environ["PYTHONPATH"].split(os.pathsep)
        sys.argv = sys.orig_argv = call["command"]
        for number, name in enumerate([os.devnull, "output", "error"]):
            os.dup2(os.open(os.path.join(call["written"], name), os.O_RDWR | os.O_CREAT), number)
        sys.exit(snakemake.cli.main(call["command"][1:]))
    print(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), flush=True)
"""


@cache
def _server() -> subprocess.Popen[str]:
    """Return the process; it ends with this one, whose pipe it reads."""
    command = [sys.executable, "-P", "-c", SERVER]
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    return subprocess.Popen(command, stdin=subprocess.PIPE, stdout=subprocess.PIPE, text=True, env=environment)


def run_snakemake(
    command: Sequence[str], folder: Path, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[str]:
    """Do what the command line does, in a folder, to its end; standard output and error are captured.

    environment : of the run; PYTHONPATH leads to the package
    """
    server = _server()
    assert server.stdin is not None
    assert server.stdout is not None
    with tempfile.TemporaryDirectory() as written:
        call = {"command": command, "folder": str(folder), "environment": dict(environment), "written": written}
        print(json.dumps(call), file=server.stdin, flush=True)
        code = int(server.stdout.readline())
        output, error = (Path(written, name).read_text() for name in ("output", "error"))
    return subprocess.CompletedProcess(command, code, output, error)
