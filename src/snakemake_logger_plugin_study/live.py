"""Progress on a terminal: a line for each stage, all jobs with the time left, and the jobs that run long."""

from __future__ import annotations

import threading
import time
from typing import TextIO

from rich.console import Console, Group
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from snakemake_logger_plugin_study.tally import Tally
from snakemake_logger_plugin_study.wording import failures, time_left

REFRESHES_PER_SECOND = 2
#: Seconds after which a job is named, and how many are at most.
LONG_JOB, LONG_JOBS = 5.0, 4
#: Columns of a bar, and of a terminal too narrow for bars.
BAR_WIDTH, NARROW = 30, 64


class LiveDisplay:
    """Draws the state of a run at the bottom of a terminal; what is written to `above` scrolls by over it."""

    def __init__(self, tally: Tally, lock: threading.RLock, stream: TextIO, nocolor: bool) -> None:
        self._tally, self._lock = tally, lock
        self._begin = time.time()
        self.console = Console(file=stream, no_color=nocolor, highlight=False)
        self.above = Above(self.console)
        self._live = Live(
            get_renderable=self.picture,
            console=self.console,
            refresh_per_second=REFRESHES_PER_SECOND,
            transient=True,
            # Whatever writes to the terminal goes through `above`.
            redirect_stdout=False,
            redirect_stderr=False,
        )
        self._live.start()

    def picture(self) -> Group:
        """Return what the display shows now."""
        with self._lock:
            now = time.time()
            stages, total = self._tally.stages(), self._tally.total()
            left = time_left(self._tally.time_left(now))
            failed = failures(self._tally)
            long = self._tally.running(now, LONG_JOB)[:LONG_JOBS]
        wide = self.console.width >= NARROW
        table = Table.grid(padding=(0, 1))
        table.add_column(no_wrap=True)
        if wide:
            table.add_column(width=BAR_WIDTH)
        table.add_column(justify="right", no_wrap=True)
        table.add_column(no_wrap=True)
        for stage in [*stages, total]:
            style = "bold" if stage.running or stage is total else "dim"
            bar = ProgressBar(total=max(stage.total, 1), completed=stage.done if stage.total else 1)
            running = f"{stage.running} running" if stage.running and stage is not total else ""
            cells = [Text(words, style=style) for words in (stage.name, f"{stage.done} of {stage.total}", running)]
            table.add_row(cells[0], *([bar] if wide else []), *cells[1:])
        words = ", ".join(part for part in (failed, left, f"{clock(now - self._begin)} so far") if part)
        lines = [Text(words, style="bold red" if failed else "bold")]
        lines += [Text(f"{message}: {clock(seconds)}", style="dim") for message, seconds in long]
        for line in lines:
            line.no_wrap, line.overflow = True, "ellipsis"
        return Group(table, *lines)

    def close(self) -> None:
        """Take the display away and give the cursor back."""
        self._live.stop()


class Above:
    """A stream for Snakemake's own handler: each message is printed above the display, colours and all."""

    def __init__(self, console: Console) -> None:
        self._console = console
        self._parts: list[str] = []

    def isatty(self) -> bool:
        """Tell that this is a terminal."""
        return True

    def write(self, text: str) -> int:
        """Keep text until `flush`."""
        self._parts.append(text)
        return len(text)

    def flush(self) -> None:
        """Print what was kept."""
        text, self._parts = "".join(self._parts), []
        if text:
            self._console.print(Text.from_ansi(text.removesuffix("\n")), soft_wrap=True)


def clock(seconds: float) -> str:
    """Return a duration as 1:23 or 1:02:03."""
    minutes, rest = divmod(int(seconds), 60)
    hours, minutes = divmod(minutes, 60)
    return f"{hours}:{minutes:02}:{rest:02}" if hours else f"{minutes}:{rest:02}"
