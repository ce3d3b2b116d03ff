"""Functions shared by the benchmarks: CPU times of a call and of contestants in alternation, and Markdown tables."""

from __future__ import annotations

import gc
import statistics
import time
from collections.abc import Callable, Mapping, Sequence


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
