"""Progress without a terminal: a line now and then."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

from snakemake_logger_plugin_study.tally import Tally
from snakemake_logger_plugin_study.wording import progress_line

#: Seconds between two lines at least; and after which there is one even if little was done.
SHORTEST, LONGEST = 10.0, 60.0
#: Share of all jobs between two lines.
STEP = 0.05


class PlainDisplay(threading.Thread):
    """Says progress lines from a thread of its own, as long jobs leave nothing in the log.

    tally, lock : the state of the run, and what guards it
    say : writes a line between all other messages
    """

    def __init__(self, tally: Tally, lock: threading.RLock, say: Callable[[str], None]) -> None:
        super().__init__(daemon=True)
        self._tally, self._lock, self._say = tally, lock, say
        self._time, self._done = time.time(), 0
        self._closed = threading.Event()
        self.start()

    def run(self) -> None:
        """Say a line whenever one is due."""
        while not self._closed.wait(1.0):
            with self._lock:
                line = self.line(time.time())
            if line:
                self._say(line)

    def line(self, now: float) -> str:
        """Return a progress line if one is due, else ""."""
        total, waited = self._tally.counts()[-1], now - self._time
        little = total.done - self._done < STEP * total.total and waited < LONGEST
        if total.done == total.total or waited < SHORTEST or little:
            return ""
        self._time, self._done = now, total.done
        return progress_line(self._tally, now)

    def close(self) -> None:
        """End the thread; no line comes after this."""
        self._closed.set()
        self.join()
