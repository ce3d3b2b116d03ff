"""One point of a study as a job in a thread of Snakemake's own process: the run, its file, its log and its time."""

from __future__ import annotations

import atexit
import math
import os
import signal
import subprocess
import sys
import threading
import time
import traceback
from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, TextIO

from burridge_knopoff.messages import escape_unprintable
from burridge_knopoff.outputs import benchmark_of
from burridge_knopoff.provenance.files import check_target, remove_links, reserved_room
from burridge_knopoff.study.job_log import INTERRUPTED
from burridge_knopoff.study.study import Study

if TYPE_CHECKING:
    from burridge_knopoff.kernel._core import StopFlag


class Interrupt:
    """Ctrl-C, for the runs of other threads: Python interrupts the main thread only.

    The kernel is loaded by the first run that heeds it: a Snakefile is read without one.
    """

    def __init__(self) -> None:
        self._is_set = False
        self._stop: StopFlag | None = None
        self._lock = threading.Lock()

    def set(self) -> None:
        """End the runs of all threads that heed this."""
        self._is_set = True
        # A flag that another thread makes meanwhile is set there.
        if self._stop:
            self._stop.set()

    def heed(self) -> None:
        """Let this end the runs of the calling thread."""
        from burridge_knopoff.kernel._core import StopFlag

        with self._lock:
            self._stop = self._stop or StopFlag()
        if self._is_set:
            self._stop.set()
        self._stop.heed()


def stop_on_interrupt() -> Interrupt:
    """Return what Ctrl-C sets."""
    stop = Interrupt()
    previous, last = signal.getsignal(signal.SIGINT), -math.inf

    def interrupt(number: int, frame: object) -> None:
        nonlocal last
        # The first of several within a second ends the run, undisturbed by the others.
        now = time.monotonic()
        is_repeated, last = now - last < 1.0, now
        stop.set()
        if callable(previous) and not is_repeated:
            previous(number, frame)  # type: ignore[arg-type]

    # Only the main thread can set a handler. Without one a run ends before the process does.
    if previous is not signal.SIG_IGN and threading.current_thread() is threading.main_thread():
        signal.signal(signal.SIGINT, interrupt)
        # Python gives the signal its default at the end, when a late repetition would kill the process.
        atexit.register(signal.signal, signal.SIGINT, signal.SIG_IGN)
    return stop


def run_point_job(
    study: Study, wildcards: Mapping[str, str], path: str, log: str, results: str, stop: Interrupt
) -> None:
    """Make the point of some wildcards. Its log says what `bk simulate` would print.

    results : folder of the study, which has a file with the wall time and the CPU time of the job as well
    stop : ends the run
    Raises RuntimeError, one line, if the point fails; its log then has the reason.
    """
    from burridge_knopoff.dataset.simulated_point import simulate_point

    stop.heed()
    benchmark = _benchmark(log, results)
    wall, cpu = time.perf_counter(), time.thread_time()
    with open(log, "w", encoding="utf-8") as stream, reserved_room(stream):
        try:
            simulate_point(
                *study.run_of(**wildcards), path, lambda words: _write(stream, f"note: bk simulate: {words}")
            )
        except (Exception, KeyboardInterrupt) as error:
            _write(stream, _failure(error))
            # Snakemake reports an exception as a failure of this job alone, and is silent about KeyboardInterrupt.
            raise RuntimeError(f"{path} was not made, see {log}") from None
    _write_benchmark(benchmark, time.perf_counter() - wall, time.thread_time() - cpu)


def run_point_command(command: str, path: str, log: str, results: str) -> None:
    """Make a point by a command of `bk simulate`, in a process of its own. Its log has what the command prints.

    results : as for `run_point_job`
    Raises RuntimeError, one line, if the point fails; its log then has the reason.
    """
    benchmark = _benchmark(log, results)
    wall, before = time.perf_counter(), os.times()
    with open(log, "w", encoding="utf-8") as stream, reserved_room(stream):
        # `bk` lies beside this Python, which need not be in the path.
        search = {"PATH": f"{Path(sys.executable).parent}{os.pathsep}{os.environ.get('PATH', os.defpath)}"}
        words = ["sh", "-c", f"exec {command}"]
        code = subprocess.run(words, stdout=subprocess.DEVNULL, stderr=stream, env=os.environ | search).returncode
    # A run that stopped at a limit is a result as well.
    if code not in (0, 3):
        raise RuntimeError(f"{path} was not made, see {log}")
    now = os.times()
    used = now.children_user + now.children_system - before.children_user - before.children_system
    _write_benchmark(benchmark, time.perf_counter() - wall, used)


def _benchmark(log: str, results: str) -> Path:
    """Return the file with the times of a job; neither it nor the log may be a link to another file, or a pipe."""
    benchmark = Path(results, benchmark_of(Path(log).relative_to(results).as_posix()))
    remove_links(log, benchmark)
    for path in (log, benchmark):
        check_target(path)
    return benchmark


def _write_benchmark(path: Path, wall: float, cpu: float) -> None:
    path.parent.mkdir(parents=True, exist_ok=True)
    path.write_text(f"s\tcpu_time\n{wall:.4f}\t{cpu:.4f}\n", encoding="utf-8")


def _failure(error: BaseException) -> str:
    match error:
        case KeyboardInterrupt():
            return f"bk simulate: {INTERRUPTED}"
        case MemoryError():
            return "bk simulate: not enough memory"
        case ValueError() | OSError() | ImportError():
            return f"bk simulate: {error}"
    return "".join(traceback.format_exception(error))


def _write(stream: TextIO, words: str) -> None:
    stream.write("".join(f"{escape_unprintable(line)}\n" for line in words.splitlines()))
    stream.flush()
