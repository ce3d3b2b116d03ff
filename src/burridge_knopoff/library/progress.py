"""A bar that shows the progress of a long call, by rich or tqdm, whichever is installed."""

from __future__ import annotations

import sys
import time
import warnings
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Lock
from typing import Literal

from burridge_knopoff.messages import refusal

#: Whether a call shows its progress: `ALWAYS` also where standard error is neither a terminal nor a notebook.
Progress = bool | Literal["always"]
ALWAYS = "always"

# Least time in seconds between two pictures of a bar. No thread draws it meanwhile: processes may be forked.
DRAWN = 0.1


@contextmanager
def progress_bar(progress: Progress, total: float, what: str) -> Iterator[Callable[..., None]]:
    """Yield a function that advances a bar on standard error; several threads may call it.

    progress : whether there is a bar; True is quiet in a pipe, "always" is not
    total : amount of work, by default in units of one call of the function; its argument is another amount
    what : name of the call, in front of the bar

    Warns if a bar is asked for and neither rich nor tqdm is installed. Raises ValueError, one line, for another value
    of `progress`.
    """
    if not isinstance(progress, bool) and progress != ALWAYS:
        raise refusal("progress", progress, "True | False | 'always'")
    if progress == ALWAYS or (progress and (sys.stderr.isatty() or "ipykernel" in sys.modules)):
        lock = Lock()
        with _bar(total, what, forced=progress == ALWAYS) as draw:

            def advance(amount: float = 1.0) -> None:
                with lock:
                    draw(amount)

            yield advance
    else:
        yield _no_bar


def _no_bar(amount: float = 1.0) -> None:
    pass


@contextmanager
def _bar(total: float, what: str, forced: bool) -> Iterator[Callable[[float], None]]:
    """Yield a function that adds an amount to a bar."""
    try:
        from rich.console import Console
        from rich.progress import BarColumn, TaskProgressColumn, TextColumn, TimeRemainingColumn
        from rich.progress import Progress as Bars
    except ImportError:
        with _tqdm_bar(total, what) as draw:
            yield draw
        return
    columns = TextColumn("{task.description}"), BarColumn(), TaskProgressColumn(), TimeRemainingColumn()
    console = Console(stderr=True, force_terminal=True if forced else None)
    with Bars(
        *columns, console=console, auto_refresh=False, transient=True, redirect_stdout=False, redirect_stderr=False
    ) as bars:
        task, drawn = bars.add_task(what, total=total), 0.0

        def draw(amount: float) -> None:
            nonlocal drawn
            bars.advance(task, amount)
            if time.monotonic() - drawn >= DRAWN:
                drawn = time.monotonic()
                bars.refresh()

        yield draw


@contextmanager
def _tqdm_bar(total: float, what: str) -> Iterator[Callable[[float], None]]:
    try:
        from tqdm.auto import tqdm
    except ImportError:
        # Told to the caller of the function that shows the bar.
        warnings.warn("progress: no bar is shown, expected rich or tqdm to be installed", stacklevel=8)
        yield _no_bar
        return

    class Bar(tqdm):
        monitor_interval = 0

    # The amount is a share of the work: only the percentage and the times mean something.
    layout = "{desc}: {percentage:3.0f}%|{bar}| {elapsed}<{remaining}"
    with Bar(total=total, desc=what, bar_format=layout, mininterval=DRAWN, leave=False) as bar:
        yield bar.update
