"""Progress without a terminal: a line now and then."""

from __future__ import annotations

import threading
import time
from logging import StreamHandler

from snakemake_logger_plugin_study.tally import Tally
from snakemake_logger_plugin_study.wording import progress_line

#: Seconds between two lines at least; and after which there is one even if little was done.
SHORTEST, LONGEST = 10.0, 60.0
#: Share of all jobs between two lines.
STEP = 0.05


class Pace:
    """Tells when a line is due: not before SHORTEST, then after STEP of all jobs or after LONGEST."""

    def __init__(self, now: float) -> None:
        self._time = now
        self._done = 0

    def due(self, done: int, total: int, now: float) -> bool:
        """Tell whether a line is due; if so, it counts as written."""
        waited = now - self._time
        if waited < SHORTEST or (done - self._done < STEP * total and waited < LONGEST):
            return False
        self._time, self._done = now, done
        return True


class PlainDisplay:
    """Writes progress lines from a thread of its own, as long jobs leave nothing in the log.

    tally, lock : the state of the run, and what guards it
    text : handler of all other messages, on whose stream the lines come between its own
    """

    def __init__(self, tally: Tally, lock: threading.RLock, text: StreamHandler) -> None:
        self._tally, self._lock, self._text = tally, lock, text
        self._pace = Pace(time.time())
        self._stop = threading.Event()
        self._thread = threading.Thread(target=self._watch, daemon=True)
        self._thread.start()

    def _watch(self) -> None:
        while not self._stop.wait(1.0):
            with self._lock:
                now, total = time.time(), self._tally.total()
                due = total.done < total.total and self._pace.due(total.done, total.total, now)
                line = progress_line(self._tally, now) if due else ""
            if line:
                self._text.acquire()
                try:
                    self._text.stream.write(line + "\n")
                    self._text.flush()
                finally:
                    self._text.release()

    def close(self) -> None:
        """End the thread; no line comes after this."""
        self._stop.set()
        self._thread.join()
