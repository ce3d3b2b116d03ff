"""Work shared among processes; the results do not depend on the number of processes."""

from __future__ import annotations

import logging
import os
import signal
import sys
import threading
import time
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any

from burridge_knopoff.running.cache import forget, kept

_LOG = logging.getLogger(__name__)


@contextmanager
def shared_out(processes: int, folder: str | Path | None = None) -> Iterator[Callable[..., list[Any]]]:
    """Yield a function `each` that maps a function over one or several sequences, in several processes at once.

    On macOS this process does all the work.

    folder : cache of the results for later runs, see `running.cache`; None for no cache. Cached results that no call
        has asked for are deleted at the end

    `each(what, function, *sequences)` returns the list of results and logs how long the calls took, in seconds; calls
    in a row with the same `what` are logged together. Function, items and results have to be picklable. A call must not
    rely on what another call has changed.
    """
    asked: set[Path] = set()
    taken: list[tuple[float, bool]] = []
    last = ""

    def each(call: Callable[..., Any], what: str, function: Callable[..., Any], *items: Any) -> list[Any]:
        nonlocal last
        if what != last:
            _log(last, taken)
            taken.clear()
            last = what
        done = list(call(partial(_timed, Path(folder, what) if folder else None, function), *items))
        asked.update(path for *_, path, _ in done if path)
        taken.extend((seconds, was_read) for _, seconds, _, was_read in done)
        return [result for result, *_ in done]

    # macOS forbids fork once libraries have threads, and a fresh interpreter would run the caller's script again.
    if processes == 1 or sys.platform == "darwin":
        yield partial(each, map)
    else:
        context = get_context("fork")
        told, tell = context.Pipe(duplex=False)
        with told, tell, ProcessPoolExecutor(processes, context, _end_with_parent, (told,)) as pool:
            try:
                yield partial(each, pool.map)
            except KeyboardInterrupt:
                # Nobody reads it: all of them see it.
                tell.send_bytes(b"end")
                raise
    _log(last, taken)
    if folder:
        forget(Path(folder), asked)


def _log(what: str, taken: Sequence[tuple[float, bool]]) -> None:
    """Log the number of calls, their total and longest time, and how many results came from the cache."""
    if taken:
        seconds, was_read = zip(*taken, strict=True)
        text = f"{what}: {len(taken)}, {sum(seconds):.1f} s, the longest {max(seconds):.1f} s"
        _LOG.info("%s", text + f"; {sum(was_read)} kept from a run before" * any(was_read))


def _timed(folder: Path | None, function: Callable[..., Any], *items: Any) -> tuple[Any, float, Path | None, bool]:
    """Return the result of a call, the seconds it took, its file in the cache, and whether it was read from there."""
    begin = time.perf_counter()
    result, path, was_read = kept(folder, function, *items) if folder else (function(*items), None, False)
    return result, time.perf_counter() - begin, path, was_read


def _end_with_parent(told: Connection) -> None:
    """End this process when the process that shares the work out is killed, or interrupted by Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def end() -> None:
        wait([told] if parent is None else [told, parent.sentinel])
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
