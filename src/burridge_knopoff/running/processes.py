"""Parallel work in processes. The results do not depend on the number of processes."""

from __future__ import annotations

import logging
import os
import signal
import sys
import threading
import time
from collections import deque
from collections.abc import Callable, Collection, Iterable, Iterator, Sequence
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

#: Least time in seconds between two reports of the progress of a job.
REPORTED = 5.0

#: Fractions of the time of a job at which some of its calls begin and end.
Span = tuple[float, float]

_K = TypeVar("_K")
_T = TypeVar("_T")
_R = TypeVar("_R")


class LoggedShare:
    """Logs the share of a job that is done, from time to time."""

    def __init__(self) -> None:
        self._reported = time.monotonic()

    def __call__(self, share: float) -> None:
        """Log the share unless the last one was logged a short time ago."""
        if time.monotonic() - self._reported >= REPORTED:
            self._reported = time.monotonic()
            _LOG.info("progress %.3f", share)


class ParallelMap:
    """Applies functions to many items, in parallel if there is a pool of processes.

    pool : None if this process does all the work; folder, classes, report : see `parallel_map`

    Functions, items and results must be picklable. A call must not rely on the side effects of another call.
    """

    def __init__(
        self,
        pool: Executor | None,
        folder: str | Path | None,
        classes: Collection[type],
        report: Callable[[float], None] | None = None,
    ) -> None:
        self._pool, self._folder, self._classes = pool, folder, classes
        self._report_to = report or LoggedShare()
        self.asked: set[Path] = set()
        self._taken: list[tuple[float, bool]] = []
        self._last = ""

    def __call__(
        self, what: str, function: Callable[..., Any], *items: Sequence[Any], span: Span | None = None
    ) -> list[Any]:
        """Return the results of a function for the items of one or several sequences, in order.

        span : fractions of the time of the whole job at which these calls begin and end, to report the progress

        Calls begin with the last item: along a grid of a it takes longest, and no process then waits for it at the end.
        The time of the calls is logged in seconds; successive calls with the same `what` are logged together.
        """
        call = partial(_timed, self._begin(what), self._classes, function)
        results = []
        backward = [sequence[::-1] for sequence in items]
        for result in self._pool.map(call, *backward) if self._pool else map(call, *backward):
            results.append(self._record(result))
            self._report(span, len(results) / len(items[0]))
        return results[::-1]

    def work_through(
        self,
        what: str,
        function: Callable[[_T], _R],
        items: Iterable[tuple[_K, _T]],
        successors: Callable[[_K, _T, _R], Iterable[tuple[_K, _T]]],
        span: Span | None = None,
    ) -> None:
        """Apply a function to items, and to the further items that follow from its results, as soon as they are known.

        items : pairs of a name and an item
        successors : takes name, item and result, in any order of the items, and returns further pairs
        span, order of the calls : see `__call__`
        """
        call, done = partial(_timed, self._begin(what), self._classes, function), 0
        backward = [*items][::-1]
        if self._pool is None:
            todo = deque(backward)
            while todo:
                name, item = todo.popleft()
                todo.extend(successors(name, item, self._record(call(item))))
                done += 1
                self._report(span, done / (done + len(todo)))
            return
        running = {self._pool.submit(call, item): (name, item) for name, item in backward}
        try:
            while running:
                for future in wait_for(running, return_when=FIRST_COMPLETED).done:
                    pair = running.pop(future)
                    for name, item in successors(*pair, self._record(future.result())):
                        running[self._pool.submit(call, item)] = name, item
                    done += 1
                self._report(span, done / (done + len(running)))
        finally:
            for future in running:
                future.cancel()

    def log(self, what: str = "") -> None:
        """Log the last calls, unless the next calls have the same description `what`."""
        if what != self._last:
            _log(self._last, self._taken)
            self._taken.clear()
            self._last = what

    def _report(self, span: Span | None, share: float) -> None:
        """Report the progress of the job, from the share of these calls that are done."""
        if span:
            self._report_to(span[0] + share * (span[1] - span[0]))

    def _begin(self, what: str) -> Path | None:
        self.log(what)
        return Path(self._folder, what) if self._folder else None

    def _record(self, call: tuple[Any, float, Path | None, bool]) -> Any:
        result, seconds, path, was_read = call
        if path:
            self.asked.add(path)
        self._taken.append((seconds, was_read))
        return result


@contextmanager
def parallel_map(
    processes: int,
    folder: str | Path | None = None,
    classes: Collection[type] = (),
    report: Callable[[float], None] | None = None,
) -> Iterator[ParallelMap]:
    """Yield a `ParallelMap`, which applies functions to many items in several processes at once.

    On macOS this process does all the work.

    folder : cache of the results for later runs, see `running.cache`; None for no cache. Cached results that were not
        used by any call are deleted at the end
    classes : of the objects that may occur in cached results
    report : called with the share of the job that is done; by default it is logged
    """
    # macOS does not allow fork once libraries have threads, and a new interpreter would run the caller's script again.
    if processes == 1 or sys.platform == "darwin":
        yield (apply := ParallelMap(None, folder, classes, report))
    else:
        context = get_context("fork")
        receiver, sender = context.Pipe(duplex=False)
        with receiver, sender, ProcessPoolExecutor(processes, context, _end_with_parent, (receiver,)) as pool:
            apply = ParallelMap(pool, folder, classes, report)
            try:
                yield apply
            except KeyboardInterrupt:
                # The message is never received, so that all processes see it.
                sender.send_bytes(b"end")
                raise
    apply.log()
    if folder:
        delete_unused(Path(folder), apply.asked)


def _log(what: str, taken: Sequence[tuple[float, bool]]) -> None:
    """Log the number of calls, their total and longest time, and how many results came from the cache."""
    if taken:
        seconds, was_read = zip(*taken, strict=True)
        text = f"{what}: {len(taken)}, {sum(seconds):.1f} s, the longest {max(seconds):.1f} s"
        _LOG.info("%s", text + f"; {sum(was_read)} from the cache" * any(was_read))


def _timed(
    folder: Path | None, classes: Collection[type], function: Callable[..., Any], *items: Any
) -> tuple[Any, float, Path | None, bool]:
    """Return the result of a call, its time in seconds, its file in the cache, and whether it was read from there."""
    begin = time.perf_counter()
    result, path, was_read = (
        cached_call(folder, classes, function, *items) if folder else (function(*items), None, False)
    )
    return result, time.perf_counter() - begin, path, was_read


def _end_with_parent(receiver: Connection) -> None:
    """End this process when the parent process is killed, or interrupted by Ctrl-C."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def end() -> None:
        wait([receiver] if parent is None else [receiver, parent.sentinel])
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()
