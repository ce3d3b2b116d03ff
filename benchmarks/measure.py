"""Functions shared by the benchmarks: CPU times of calls and of commands, and Markdown tables."""

from __future__ import annotations

import gc
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

REPOSITORY = Path(__file__).resolve().parent.parent
#: Next to the interpreter as it was called, since the interpreter of a virtual environment is a link.
BIN = Path(sys.executable).parent
SNAKEMAKE = [str(BIN / "snakemake"), "-s", str(REPOSITORY / "Snakefile")]


@dataclass
class Run:
    """Wall and CPU time in seconds of a command, and the peak memory in MB of its own process."""

    wall: float
    cpu: float
    memory: float


def run(command: Sequence[str], folder: Path) -> Run:
    """Run a command in a folder to its end, without its output, sampling the memory of its process."""
    cpu, begin, peak = -_children_cpu(), time.perf_counter(), 0.0
    environment = {**os.environ, "OPENBLAS_NUM_THREADS": "1"}
    with tempfile.TemporaryFile() as output:
        process = subprocess.Popen(command, cwd=folder, env=environment, stdout=output, stderr=output)
        while process.poll() is None:
            try:
                status = Path(f"/proc/{process.pid}/status").read_text()
                peak = max(peak, *(float(line.split()[1]) for line in status.splitlines() if line.startswith("VmHWM")))
            except (OSError, TypeError):
                pass
            time.sleep(0.05)
        wall = time.perf_counter() - begin
        if process.returncode:
            output.seek(0)
            sys.exit(f"{' '.join(command)} failed:\n{output.read().decode()[-4000:]}")
    return Run(wall, cpu + _children_cpu(), peak * 1024 / 1e6)


def _children_cpu() -> float:
    """Return the user and system time in seconds of all processes run so far, theirs included."""
    used = resource.getrusage(resource.RUSAGE_CHILDREN)
    return used.ru_utime + used.ru_stime


def cpu_times(contestants: Mapping[str, Callable[[], object]], rounds: int) -> dict[str, float]:
    """Return the median CPU time in seconds of each contestant.

    They run alternately, `rounds` times, so that changes of the clock frequency or of the load affect all of them. Each
    should have run once before, to exclude imports, just-in-time compilation and cold caches.
    """
    times: dict[str, list[float]] = {name: [] for name in contestants}
    for _ in range(rounds):
        for name, contestant in contestants.items():
            gc.collect()
            begin = time.process_time()
            contestant()
            times[name].append(time.process_time() - begin)
    return {name: statistics.median(values) for name, values in times.items()}


def least(call: Callable[[], object], repeats: int = 3) -> float:
    """Return the smallest CPU time of a call, in ms."""
    times = []
    for _ in range(repeats):
        begin = time.process_time()
        call()
        times.append(time.process_time() - begin)
    return 1e3 * min(times)


def print_table(header: Sequence[str], rows: Sequence[Sequence[object]]) -> None:
    """Print a table in Markdown; numbers are aligned to the right."""
    cells = [[str(value) for value in row] for row in (header, *rows)]
    width = [max(len(row[i]) for row in cells) for i in range(len(header))]
    right = [bool(rows) and cells[1][i][:1] in set("0123456789-") for i in range(len(header))]

    def line(row: Sequence[str]) -> str:
        padded = [c.rjust(w) if r else c.ljust(w) for c, w, r in zip(row, width, right, strict=True)]
        return f"| {' | '.join(padded)} |"

    print(line(cells[0]))
    print("|" + "|".join("-" * (w + 1) + (":" if r else "-") for w, r in zip(width, right, strict=True)) + "|")
    for row in cells[1:]:
        print(line(row))
    print()
