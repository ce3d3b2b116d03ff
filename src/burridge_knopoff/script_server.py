"""Scripts in forks of a process that has imported what they import, which takes longer than most of them work.

    python -P -m burridge_knopoff.script_server NUMBER

serves the parent, by the inherited socket of that number, until the parent ends. Each request is another socket, on
which what is to be run comes in, and who runs it and how it ended go out. Every script has a process that waits for it:
it ends as it would without the server, even if the server is killed.
"""

from __future__ import annotations

import atexit
import gc
import os
import pickle
import shutil
import signal
import socket
import subprocess
import sys
import tempfile
import threading
from collections.abc import Collection, Mapping
from contextlib import suppress
from importlib import import_module
from multiprocessing import Pipe
from multiprocessing.connection import Connection
from pathlib import Path
from typing import Any, NamedTuple


class End(NamedTuple):
    """The end of a script, and what it used together with its child processes.

    code : exit code, or minus the number of the signal that ended it
    seconds : CPU time; memory : that of its largest process, in MiB
    """

    code: int
    seconds: float = 0.0
    memory: float = 0.0


class Script:
    """A script in a process of its own, where it waits for the call of `run`.

    pid : number of this process, None if it could not begin
    """

    def __init__(self, line: Connection) -> None:
        self._line = line
        self.pid: int | None = None
        with suppress(EOFError, OSError):
            self.pid = line.recv()

    def run(self) -> End:
        """Run it to its end."""
        with self._line, suppress(EOFError, OSError):
            self._line.send(None)
            return End(*self._line.recv())
        return End(-signal.SIGKILL)


class ScriptServer:
    """Begins scripts. Its process starts with the first of them, and anew if it was killed.

    pid : number of this process, 0 if there is none
    """

    def __init__(self) -> None:
        self.pid = 0
        self._requests: socket.socket | None = None
        self._lock = threading.Lock()

    def begin(
        self, script: Path, variables: Mapping[str, Any], modules: Collection[str], environment: Mapping[str, str]
    ) -> Script:
        """Return a script with some global variables.

        modules : names of modules that it imports
        environment : variables of its environment that differ from those of this process
        """
        line, its_line = Pipe()
        with its_line, self._lock:
            try:
                self._request(its_line)
            except OSError:
                self._requests = None
                self._request(its_line)
        with suppress(OSError):
            # The server need not know the classes of the variables.
            line.send((str(script), [*modules], dict(environment), pickle.dumps(dict(variables))))
        return Script(line)

    def _request(self, line: Connection) -> None:
        if self._requests is None:
            self._requests, self.pid = start()
        socket.send_fds(self._requests, [b"."], [line.fileno()])


def start() -> tuple[socket.socket, int]:
    """Start the process of a server; return the socket for requests and the number of the process."""
    requests, its_requests = socket.socketpair()
    # Ctrl-C reaches all processes: it ends the scripts, and this one ends the server.
    mask = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    with its_requests:
        number = its_requests.fileno()
        server = subprocess.Popen(
            [sys.executable, "-P", "-m", __name__, f"{number}"],
            pass_fds=[number],
            # With threads it could not be forked.
            env=os.environ | {"OPENBLAS_NUM_THREADS": "1"},
        )
    signal.pthread_sigmask(signal.SIG_SETMASK, mask)

    def end() -> None:
        requests.close()
        # Its CPU time, and that of the scripts, counts as that of this process.
        server.wait()

    atexit.register(end)
    return requests, server.pid


def serve(requests: socket.socket) -> None:
    """Fork for each request, until the parent ends. Ctrl-C is blocked."""
    signal.signal(signal.SIGCHLD, _reap)
    while handles := socket.recv_fds(requests, 1, 1)[1]:
        with Connection(handles[0]) as line, suppress(EOFError, OSError):
            script, modules, environment, variables = line.recv()
            _import(modules)
            # After a fork it is not pending any more.
            interrupted = signal.SIGINT in signal.sigpending()
            if not os.fork():
                requests.close()
                _attend(line, interrupted, script, environment, variables)


def _reap(*_: object) -> None:
    with suppress(ChildProcessError):
        while os.waitpid(-1, os.WNOHANG)[0]:
            pass


def _import(modules: Collection[str]) -> None:
    """Import what a script imports. What fails here fails again in the script, whose log has the reason."""
    for module in modules:
        with suppress(Exception):
            import_module(module)
    # Garbage collection in a fork would copy all that it shares.
    gc.collect()
    gc.freeze()


def _attend(line: Connection, interrupted: bool, script: str, environment: Mapping[str, str], variables: bytes) -> None:
    """Run a script in a fork of this process, tell its number and its end, and end this process."""
    code = 1
    try:
        signal.signal(signal.SIGCHLD, signal.SIG_DFL)
        if process := os.fork():
            line.send(process)
            _, status, usage = os.wait4(process, 0)
            seconds = usage.ru_utime + usage.ru_stime
            line.send((os.waitstatus_to_exitcode(status), seconds, usage.ru_maxrss / 1024))
        else:
            line.recv()
            signal.pthread_sigmask(signal.SIG_UNBLOCK, {signal.SIGINT})
            if not interrupted:
                os.environ.update(environment)
                # The folder of temporary files may be another one now.
                tempfile.tempdir = None
                code = _run(script, variables)
    finally:
        # Python's own exit would free, and for this copy, all that is shared.
        os._exit(code)


def _run(script: str, variables: bytes) -> int:
    """Run a script, with all that is to be done at its end, as Python does; return its exit code."""
    # matplotlib may have made a temporary folder, which is that of the server.
    atexit.unregister(shutil.rmtree)
    sys.argv = [script]
    code: object = None
    try:
        text = Path(script).read_text(encoding="utf-8")
        exec(compile(text, script, "exec"), {"__name__": "__main__", "__file__": script, **pickle.loads(variables)})
    except SystemExit as end:
        code = end.code
        if not (code is None or isinstance(code, int)):
            print(code, file=sys.stderr)
    except BaseException as error:
        code = 1
        # Without this function.
        error.__traceback__ = error.__traceback__ and error.__traceback__.tb_next
        sys.excepthook(type(error), error, error.__traceback__)
    atexit._run_exitfuncs()
    for stream in (sys.stdout, sys.stderr):
        with suppress(OSError, ValueError):
            stream.flush()
    return code & 0xFF if isinstance(code, int) else int(code is not None)


if __name__ == "__main__":
    serve(socket.socket(fileno=int(sys.argv[1])))
