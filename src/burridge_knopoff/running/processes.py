"""Work shared out among processes, with the same results whatever their number."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from concurrent.futures import ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import get_context
from typing import Any

#: Does the work of `map`, and returns a list.
Mapping = Callable[..., list[Any]]


@contextmanager
def shared_out(processes: int) -> Iterator[Mapping]:
    """Give what calls a function for each item of one or several sequences, in so many processes at once.

    Function, items and results have to be picklable, and the function must not rely on what another call has changed.
    """
    if processes == 1:
        yield lambda function, *items: list(map(function, *items))
        return
    # A fresh interpreter would run the script of the caller once more.
    with ProcessPoolExecutor(processes, get_context("fork")) as pool:
        yield lambda function, *items: list(pool.map(function, *items))
