"""Progress on a terminal: a line for each stage, all jobs with the time left, and the jobs that run long."""

from __future__ import annotations

import threading
import time
from typing import TextIO

from rich.console import Console, Group
from rich.file_proxy import FileProxy
from rich.live import Live
from rich.progress_bar import ProgressBar
from rich.table import Table
from rich.text import Text

from snakemake_logger_plugin_study.tally import RUNNING, Tally
from snakemake_logger_plugin_study.wording import elapsed, failures, time_left

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
        # Long lines are left to the terminal: a command in a message can be copied.
        self._console = Console(file=stream, no_color=nocolor, highlight=False, soft_wrap=True)
        self.above = FileProxy(self._console, stream)
        self._live = Live(
            get_renderable=self.picture,
            console=self._console,
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
            counts = self._tally.counts()
            left, failed = time_left(self._tally.time_left(now)), failures(self._tally)
            running = sorted((job.begin, job.message or job.name) for job in self._tally.jobs(RUNNING))
        table = Table.grid(padding=(0, 1))
        for stage in counts:
            is_all = stage is counts[-1]
            style = "bold" if stage.running or is_all else "dim"
            bar = ProgressBar(max(stage.total, 1), stage.done if stage.total else 1, BAR_WIDTH)
            at_work = f"{stage.running} running" if stage.running and not is_all else ""
            cells = [Text(words, style) for words in (stage.name, f"{stage.done} of {stage.total}", at_work)]
            table.add_row(cells[0], *([bar] if self._console.width >= NARROW else []), *cells[1:])
        table.columns[-2].justify = "right"
        words = ", ".join(part for part in (failed, left, f"{elapsed(now - self._begin)} so far") if part)
        long = [(message, now - begin) for begin, message in running if now - begin > LONG_JOB][:LONG_JOBS]
        lines = [Text(words, "bold red" if failed else "bold", no_wrap=True, overflow="ellipsis")]
        for message, seconds in long:
            lines.append(Text(f"{message}: {elapsed(seconds)}", "dim", no_wrap=True, overflow="ellipsis"))
        return Group(table, *lines)

    def close(self) -> None:
        """Take the display away and give the cursor back."""
        self._live.stop()
