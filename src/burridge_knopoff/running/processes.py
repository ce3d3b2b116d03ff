"""Work shared out among processes, with the same results whatever their number."""

from __future__ import annotations

import logging
import os
import threading
import time
from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from functools import partial
from multiprocessing import get_context, parent_process
from typing import Any

_LOG = logging.getLogger(__name__)


@contextmanager
def shared_out(processes: int) -> Iterator[Callable[..., list[Any]]]:
    """Give what calls a function for each item of one or several sequences, in so many processes at once.

    `each(what, function, *sequences)` returns the list of results, and logs the CPU seconds that `what` has taken.
    Function, items and results have to be picklable, and a call must not rely on what another one has changed.
    """
    if processes == 1:
        yield partial(_each, map)
        return
    # A fresh interpreter would run the script of the caller once more.
    with ProcessPoolExecutor(processes, get_context("fork"), _end_with_parent) as pool:
        yield partial(_each, pool.map)


def _end_with_parent() -> None:
    """Let a process not outlive the one that shares out the work, if that is killed."""

    def end() -> None:
        if (parent := parent_process()) is not None:
            parent.join()
        os._exit(1)

    threading.Thread(target=end, daemon=True).start()


def _each(call: Callable[..., Any], what: str, function: Callable[..., Any], *items: Any) -> list[Any]:
    done = list(call(partial(_timed, function), *items))
    seconds = [spent for _, spent in done]
    _LOG.info("%s: %d, %.1f s, the longest %.1f s", what, len(done), sum(seconds), max(seconds, default=0.0))
    return [result for result, _ in done]


def _timed(function: Callable[..., Any], *items: Any) -> tuple[Any, float]:
    begin = time.process_time()
    return function(*items), time.process_time() - begin
