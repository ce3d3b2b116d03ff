"""The reason why a job failed, from its log."""

from __future__ import annotations

import re
import shlex
import shutil
from collections.abc import Iterable, Sequence
from contextlib import suppress
from pathlib import Path

from burridge_knopoff.provenance.bad_file import REMEDY
from burridge_knopoff.provenance.files import nearest_folder, read_regular

#: Only the end of a log is read.
_TAIL = 20_000
#: Longer reasons are cut.
_LONGEST = 500
# The calls of a traceback are indented. The message that follows is not; it may have several lines.
_CALLS = re.compile(r"\A(?:[ \t].*\n?|\n)*")
# The class of our own errors adds nothing to the message.
_CLASS = re.compile(r"^burridge_knopoff(\.\w+)+: ")

_TRACEBACK = "Traceback (most recent call last):\n"

SILENT = "no error in its log: it was killed, could not start, or its disk was full for a moment"
FULL = "no error in its log: no space left on its disk"
#: The message of `bk` after Ctrl-C, which follows the name of its command.
INTERRUPTED = "interrupted, nothing was written"
#: With fewer bytes left on the disk, there may have been no room for a log.
ROOM = 1 << 16

#: A line that reports no failure: a note, or the times of calls and the progress that `running.processes` logs.
_NO_FAILURE = re.compile(r"note: |.+: \d+, [\d.]+ s, the longest [\d.]+ s|progress [\d.]+$")
_PROGRESS = re.compile(rb"^progress ([\d.]+)$", re.MULTILINE)


def logged_error(log: str | Path) -> str:
    """Return, in one line, the error of the last traceback in a log, or its last line if that reports a failure.

    The command that recreates a bad file is cut off: all jobs that read the file name it, see `bad_files`.
    """
    words = _last_error(log).partition(REMEDY)[0]
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST - 3]}..."


def progress_of(logs: Iterable[str | Path], since: float = 0.0) -> float:
    """Return the share of a running job that is done by its logs, from 0 to 1; 0 if it reports none.

    since : the time at which it began; an older log is that of an earlier run
    """
    shares = [0.0]
    for log in map(Path, logs):
        with suppress(OSError):
            if log.stat().st_mtime >= since:
                shares += map(float, _PROGRESS.findall(read_regular(log)[-_TAIL:]))
    return min(max(shares), 1.0)


def bad_files(logs: Iterable[str | Path]) -> list[str]:
    """Return the bad files at which jobs stopped, each once, by the last words of the commands that recreate them."""
    files = []
    for log in logs:
        _, remedy, command = _last_error(log).rpartition(REMEDY)
        with suppress(ValueError):
            files += shlex.split(command.rpartition(" -R ")[2])[:1] if remedy else []
    return [*dict.fromkeys(files)]


def _last_error(log: str | Path) -> str:
    try:
        text = read_regular(log)[-_TAIL:].decode("utf-8", errors="replace")
    except OSError:
        return ""
    _, traceback, message = text.rpartition(_TRACEBACK)
    lines = [line for line in message.splitlines() if line.strip() and not _NO_FAILURE.match(line)]
    message = _CALLS.sub("", message) if traceback else "".join(lines[-1:])
    return _CLASS.sub("", " ".join(message.split()))


def is_interrupted(logs: Sequence[str | Path], *, stopping: bool = False) -> bool:
    """Return whether Ctrl-C ended a job.

    stopping : whether the run was interrupted, which leaves the log of a job that had not started empty
    """
    # `bk` writes a line. Scripts write a traceback, as does `bk` before it has read its command.
    messages = [words for log in logs if (words := logged_error(log))]
    return any(words.endswith((f": {INTERRUPTED}", "KeyboardInterrupt")) for words in messages) or (
        stopping and not messages
    )


def failure_line(job: str, logs: Sequence[str | Path]) -> str:
    """Return the line that reports a failed job: the job, the reason and the path of its log."""
    return f"failed: {job}: {failure_reason(logs)} (log {', '.join(map(str, logs)) or 'none'})"


def failure_reason(logs: Sequence[str | Path]) -> str:
    """Return the reason why a job failed, from its logs: FULL or SILENT if they contain none."""
    return next((words for log in logs if (words := logged_error(log))), FULL if _is_full(logs) else SILENT)


def _is_full(logs: Sequence[str | Path]) -> bool:
    """Return whether the disk of any log is full."""
    return any(shutil.disk_usage(nearest_folder(Path(log).parent)).free < ROOM for log in logs)
