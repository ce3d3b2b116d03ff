"""Work shared among processes; the results do not depend on the number of processes."""

from __future__ import annotations

import logging
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Iterable, Iterator, Sequence
from concurrent.futures import FIRST_COMPLETED, Executor, ProcessPoolExecutor
from concurrent.futures import wait as wait_for
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context, parent_process
from multiprocessing.connection import Connection, wait
from pathlib import Path
from typing import Any, TypeVar

from burridge_knopoff.running.cache import cached_call, delete_unused

_LOG = logging.getLogger(__name__)

_K = TypeVar("_K")
_T = TypeVar("_T")
_R = TypeVar("_R")


class ParallelMap:
    """Carries functions out for many items, in several processes at once if there is a pool of them.

    pool : None if this process does all the work; folder : see `parallel_map`
    Function, items and results have to be picklable. A call must not rely on what another call has changed.
    """

    def __init__(self, pool: Executor | None, folder: str | Path | None) -> None:
        self._pool, self._folder = pool, folder
        self.asked: set[Path] = set()
        self._taken: list[tuple[float, bool]] = []
        self._last = ""

    def __call__(self, what: str, function: Callable[..., Any], *items: Sequence[Any]) -> list[Any]:
        """Return the results of a function for each item of one or several sequences, in their order.

        Logs how long the calls took, in seconds; calls in a row with the same `what` are logged together.
        """
        call = partial(_timed, self._begin(what), function)
        return list(map(self._ended, self._pool.map(call, *items) if self._pool else map(call, *items)))

    def work_through(
        self,
        what: str,
        function: Callable[[_T], _R],
        items: Iterable[tuple[_K, _T]],
        more: Callable[[_K, _T, _R], Iterable[tuple[_K, _T]]],
    ) -> None:
        """Carry a function out for some items, and on for those that its results lead to, each as soon as it is known.

        items : with a name each; more : takes name, item and result and returns what comes of them, in any order
        """
        call = partial(_timed, self._begin(what), function)
        if self._pool is None:
            todo = deque(items)
            while todo:
                name, item = todo.popleft()
                todo.extend(more(name, item, self._ended(call(item))))
            return
        running = {self._pool.submit(call, item): (name, item) for name, item in items}
        try:
            while running:
                for future in wait_for(running, return_when=FIRST_COMPLETED).done:
                    known = running.pop(future)
                    for name, item in more(*known, self._ended(future.result())):
                        running[self._pool.submit(call, item)] = name, item
        finally:
            for future in running:
                future.cancel()

    def log(self, what: str = "") -> None:
        """Log the calls that were last carried out, unless they are the same as those to come."""
        if what != self._last:
            _log(self._last, self._taken)
            self._taken.clear()
            self._last = what

    def _begin(self, what: str) -> Path | None:
        self.log(what)
        return Path(self._folder, what) if self._folder else None

    def _ended(self, call: tuple[Any, float, Path | None, bool]) -> Any:
        result, seconds, path, was_read = call
        if path:
            self.asked.add(path)
        self._taken.append((seconds, was_read))
        return result


@contextmanager
def parallel_map(processes: int, folder: str | Path | None = None) -> Iterator[ParallelMap]:
    """Yield what carries functions out for many items in several processes at once.

    On macOS this process does all the work.

    folder : cache of the results for later runs, see `running.cache`; None for no cache. Cached results that no call
        has asked for are deleted at the end
    """
    # macOS forbids fork once libraries have threads, and a fresh interpreter would run the caller's script again.
    if processes == 1 or sys.platform == "darwin":
        yield (each := ParallelMap(None, folder))
    else:
        context = get_context("fork")
        told, tell = context.Pipe(duplex=False)
        with told, tell, ProcessPoolExecutor(processes, context, _end_with_parent, (told,)) as pool:
            each = ParallelMap(pool, folder)
            try:
                yield each
            except KeyboardInterrupt:
                # Nobody reads it: all of them see it.
                tell.send_bytes(b"end")
                raise
    each.log()
    if folder:
        delete_unused(Path(folder), each.asked)


def _log(what: str, taken: Sequence[tuple[float, bool]]) -> None:
    """Log the number of calls, their total and longest time, and how many results came from the cache."""
    if taken:
        seconds, was_read = zip(*taken, strict=True)
        text = f"{what}: {len(taken)}, {sum(seconds):.1f} s, the longest {max(seconds):.1f} s"
        _LOG.info("%s", text + f"; {sum(was_read)} kept from a run before" * any(was_read))


def _timed(folder: Path | None, function: Callable[..., Any], *items: Any) -> tuple[Any, float, Path | None, bool]:
    """Return the result of a call, the seconds it took, its file in the cache, and whether it was read from there."""
    begin = time.perf_counter()
    result, path, was_read = cached_call(folder, function, *items) if folder else (function(*items), None, False)
    return result, time.perf_counter() - begin, path, was_read


def _end_with_parent(told: Connection) -> None:
    """End this process when the process that shares the work out is killed, or interrupted by Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def end() -> None:
        wait([told] if parent is None else [told, parent.sentinel])
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
