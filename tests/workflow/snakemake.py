"""Runs of Snakemake in forks of a process that has imported it, with servers of scripts in forks of another one.

Tests of signals that a program handles, and those on a terminal, start the program itself.
"""

from __future__ import annotations

import json
import os
import select
import socket
import subprocess
import sys
import tempfile
from collections.abc import Mapping, Sequence
from functools import cache
from pathlib import Path

#: Of the package and of the display, in this checkout.
SOURCES = Path(__file__).parents[2] / "src"

#: Executes each call from a socket in a fork, and answers with the number of the process and its exit code. Another
#: socket may come with it. Several may run at a time; another fork waits for each of them.
SERVE = """
import contextlib, gc, json, os, signal, socket, sys
def become(call):
    os.chdir(call["folder"])
    os.environ.clear()
    os.environ.update(call["environment"])
    sys.path[:0] = os.environ["PYTHONPATH"].split(os.pathsep)
    sys.argv = sys.orig_argv = call["command"]
def serve(calls, run):
    signal.signal(signal.SIGCHLD, signal.SIG_IGN)
    # Otherwise each fork searches everything that is imported when it ends, which takes longer than most of them run.
    gc.freeze()
    while True:
        message, numbers, _, _ = socket.recv_fds(calls, 1 << 20, 2)
        if not message:
            break
        answering, *received = numbers
        if not os.fork():
            signal.signal(signal.SIGCHLD, signal.SIG_DFL)
            call, answers = json.loads(message), open(answering, "w", buffering=1)
            # A signal to the group of a Snakemake also reaches its scripts.
            os.setpgid(0, call["group"])
            process = os.fork()
            if not process:
                become(call)
                run(call, *received)
                sys.exit()
            print(process, file=answers)
            code = os.waitstatus_to_exitcode(os.waitpid(process, 0)[1])
            # Of a server of scripts the Snakemake may have ended before.
            with contextlib.suppress(BrokenPipeError):
                print(code, file=answers)
            os._exit(0)
        for number in (answering, *received):
            os.close(number)
calls, *others = (socket.socket(fileno=int(number)) for number in sys.argv[1:])
"""

#: Takes the server of its scripts from the other process. A fork that has imported the project serves the runs of this
#: checkout; runs with the sources of another one start without imports.
SNAKEMAKE = f"""{SERVE}
import snakemake.cli, snakemake.dag, snakemake.report.html_reporter, snakemake.script
import nbformat, netCDF4, numpy, scipy.linalg, scipy.optimize, smart_open, xarray
def start():
    requests, its_requests = socket.socketpair()
    answers, answering = os.pipe()
    call = dict(command=["script_server"], folder=os.getcwd(), environment=dict(os.environ), group=os.getpgrp())
    socket.send_fds(scripts, [json.dumps(call).encode()], [answering, its_requests.fileno()])
    os.close(answering)
    its_requests.close()
    return requests, int(os.read(answers, 64).split()[0])
def run(call):
    if call["own_group"]:
        os.setpgid(0, 0)
    for number, name in enumerate([os.devnull, *call["written"]]):
        os.dup2(os.open(name, os.O_RDWR | os.O_CREAT | os.O_APPEND, 0o666), number)
    import burridge_knopoff.script_server
    burridge_knopoff.script_server.start = start
    sys.exit(snakemake.cli.main(call["command"][1:]))
calls_here, scripts, scripts_here = others
if not os.fork():
    sys.path.insert(0, {str(SOURCES)!r})
    from burridge_knopoff.provenance.sources import PACKAGE, source_fingerprint
    import burridge_knopoff.claims.ledger, burridge_knopoff.figures.description, burridge_knopoff.study
    source_fingerprint(*PACKAGE.rglob("*.py"))
    snakemake.cli.get_argument_parser()
    sys.path.pop(0)
    calls, scripts = calls_here, scripts_here
serve(calls, run)
"""

#: Likewise, servers of this checkout start with the project imported, those of another one only with its requirements.
SCRIPTS = f"""{SERVE}
import importlib, pkgutil
import matplotlib.backends.backend_agg, matplotlib.backends.backend_pdf, matplotlib.patches, matplotlib.ticker
import flint, jinja2, netCDF4, numpy, plotly.offline, scipy.optimize, scipy.signal, scipy.spatial, xarray
import snakemake.script
(calls_here,) = others
if not os.fork():
    sys.path.insert(0, {str(SOURCES)!r})
    for room in ("claims", "figures", "report", "summaries"):
        for module in pkgutil.iter_modules([f"{SOURCES}/burridge_knopoff/{{room}}"]):
            importlib.import_module(f"burridge_knopoff.{{room}}.{{module.name}}")
    sys.path.pop(0)
    calls = calls_here
def run(call, number):
    import burridge_knopoff.script_server
    signal.pthread_sigmask(signal.SIG_BLOCK, {{signal.SIGINT}})
    burridge_knopoff.script_server.serve(socket.socket(fileno=number))
serve(calls, run)
"""


@cache
def _servers(seed: str) -> tuple[socket.socket, socket.socket]:
    """Return the sockets for calls of Snakemake with the sources of another checkout and with those of this one.

    The processes end with this one, which alone holds these sockets. seed : of the order of iteration over sets
    """
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1", "PYTHONHASHSEED": seed}
    pairs = (socket.socketpair(type=socket.SOCK_SEQPACKET) for _ in range(4))
    (elsewhere, end_elsewhere), (here, end_here), (asked, script), (asked_here, script_here) = pairs
    for program, *ends in ((SNAKEMAKE, end_elsewhere, end_here, asked, asked_here), (SCRIPTS, script, script_here)):
        numbers = [end.fileno() for end in ends]
        command = [sys.executable, "-P", "-c", program, *map(str, numbers)]
        subprocess.Popen(command, pass_fds=numbers, env=environment, stdin=subprocess.DEVNULL)
        for end in ends:
            end.close()
    return elsewhere, here


class Fork:
    """A Snakemake that has begun, with the methods of `subprocess.Popen` that tests use."""

    def __init__(
        self, command: Sequence[str], folder: Path, environment: Mapping[str, str], *written: Path, own_group: bool
    ) -> None:
        """Begin.

        environment : of the run; PYTHONPATH leads to the package
        written : files of standard output and error
        own_group : whether it starts a process group, to which its jobs will belong
        """
        call = {"command": command, "folder": str(folder), "environment": dict(environment), "own_group": own_group}
        call |= {"written": [*map(str, written)], "group": os.getpgrp()}
        self._answers, answering = os.pipe()
        is_here = environment["PYTHONPATH"].split(os.pathsep)[0] == str(SOURCES)
        server = _servers(environment.get("PYTHONHASHSEED", "random"))[is_here]
        socket.send_fds(server, [json.dumps(call).encode()], [answering])
        os.close(answering)
        self._said: list[bytes] = []
        self._listen()
        self.pid = int(self._said[0])

    def _listen(self) -> None:
        answers = os.read(self._answers, 64).split()
        assert answers, "the server of Snakemake has died"
        self._said += answers

    def poll(self) -> int | None:
        """Return the exit code, None if it still runs."""
        if len(self._said) == 1 and select.select([self._answers], [], [], 0.0)[0]:
            self._listen()
        return int(self._said[1]) if len(self._said) > 1 else None

    def wait(self) -> int:
        """Wait for its end and return the exit code."""
        if len(self._said) == 1:
            self._listen()
            os.close(self._answers)
        return int(self._said[1])


def run_snakemake(
    command: Sequence[str], folder: Path, environment: Mapping[str, str]
) -> subprocess.CompletedProcess[str]:
    """Execute a command line in a folder; standard output and error are captured.

    environment : of the run; PYTHONPATH leads to the package
    """
    with tempfile.TemporaryDirectory() as name:
        written = Path(name, "output"), Path(name, "error")
        code = Fork(command, folder, environment, *written, own_group=False).wait()
        output, error = (path.read_text() for path in written)
    return subprocess.CompletedProcess(command, code, output, error)


def run_workflow(folder: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run the Snakefile of this checkout in a folder on two cores."""
    inherited = {key: value for key, value in os.environ.items() if not key.startswith("PYTEST")}
    command = ["snakemake", "-c2", "-s", str(SOURCES.parent / "Snakefile"), "--nocolor", *arguments]
    return run_snakemake(command, folder, {**inherited, "PYTHONPATH": str(SOURCES)})
