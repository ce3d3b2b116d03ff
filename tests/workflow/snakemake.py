"""Runs of Snakemake in forks of a process that has imported it, and of its scripts in forks of another one.

Tests that kill a study, and those on a terminal, start the program itself.
"""

from __future__ import annotations

import json
import os
import socket
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

#: Makes a fork the process of a command. Nothing of the project is imported before: each folder may have another one.
BECOME = """
import json, os, socket, sys
def become(call):
    os.chdir(call["folder"])
    os.environ.clear()
    os.environ.update(call["environment"])
    sys.path[:0] = os.environ["PYTHONPATH"].split(os.pathsep)
    sys.argv = sys.orig_argv = call["command"]
other = socket.socket(fileno=int(sys.argv[1]))
"""

#: Lets each script be run by the other process, which answers with the number of the process and its exit code.
SNAKEMAKE = f"""{BECOME}
import subprocess
import snakemake.cli, snakemake.dag, snakemake.report, snakemake.script
import netCDF4, numpy, scipy.linalg, scipy.optimize, smart_open, xarray
from snakemake.benchmark import benchmarked
def execute_script(self, name, edit=False):
    answers, answering = os.pipe()
    call = dict(command=[name], folder=os.getcwd(), environment=dict(os.environ))
    socket.send_fds(other, [json.dumps(call).encode()], [answering])
    os.close(answering)
    with open(answers) as answers, benchmarked(int(answers.readline()), self.bench_record):
        code = int(answers.readline() or 1)
    if code:
        raise subprocess.CalledProcessError(code, name)
snakemake.script.PythonScript.execute_script = execute_script
for line in sys.stdin:
    call = json.loads(line)
    process = os.fork()
    if not process:
        become(call)
        for number, name in enumerate([os.devnull, "output", "error"]):
            os.dup2(os.open(os.path.join(call["written"], name), os.O_RDWR | os.O_CREAT), number)
        sys.exit(snakemake.cli.main(call["command"][1:]))
    print(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), flush=True)
"""

#: Several scripts may run at a time: for each there is a fork that waits for it.
SCRIPTS = f"""{BECOME}
import runpy, signal
import matplotlib.backends.backend_agg, matplotlib.backends.backend_pdf, matplotlib.patches, matplotlib.ticker
import flint, jinja2, netCDF4, numpy, plotly.offline, scipy.optimize, scipy.signal, scipy.spatial, xarray
import snakemake.script
signal.signal(signal.SIGCHLD, signal.SIG_IGN)
while True:
    message, answering, _, _ = socket.recv_fds(other, 1 << 20, 1)
    if not message:
        break
    if not os.fork():
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        answers = open(*answering, "w", buffering=1)
        print(os.getpid(), file=answers)
        process = os.fork()
        if not process:
            become(json.loads(message))
            runpy.run_path(sys.argv[0], run_name="__main__")
            sys.exit()
        print(os.waitstatus_to_exitcode(os.waitpid(process, 0)[1]), file=answers)
        os._exit(0)
    os.close(*answering)
"""


@cache
def _servers(seed: str) -> tuple[subprocess.Popen[str], subprocess.Popen[str]]:
    """Return the processes that run Snakemake and its scripts; they end with this one, whose pipe the first one reads.

    seed : of the order in which sets are walked
    """
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": seed}

    def start(program: str, end: socket.socket) -> subprocess.Popen[str]:
        command, number = [sys.executable, "-P", "-c", program], end.fileno()
        pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True}
        return subprocess.Popen([*command, str(number)], pass_fds=[number], env=environment, **pipes)

    one, other = socket.socketpair(type=socket.SOCK_SEQPACKET)
    with one, other:
        return start(SNAKEMAKE, one), start(SCRIPTS, other)


def run_snakemake(
    command: Sequence[str], folder: Path, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[str]:
    """Do what the command line does, in a folder, to its end; standard output and error are captured.

    environment : of the run; PYTHONPATH leads to the package
    """
    server, _ = _servers(environment.get("PYTHONHASHSEED", "random"))
    assert server.stdin is not None
    assert server.stdout is not None
    with tempfile.TemporaryDirectory() as written:
        call = {"command": command, "folder": str(folder), "environment": dict(environment), "written": written}
        print(json.dumps(call), file=server.stdin, flush=True)
        code = int(server.stdout.readline())
        output, error = (Path(written, name).read_text() for name in ("output", "error"))
    return subprocess.CompletedProcess(command, code, output, error)
