"""What a failed job said last, from its log."""

from __future__ import annotations

import re
import shutil
from collections.abc import Sequence
from pathlib import Path

from burridge_knopoff.provenance.files import nearest_folder

#: Of a log only its end is read.
_TAIL = 20_000
#: Longer reasons are cut.
_LONGEST = 500
# The calls of a traceback; what is not indented after them is the message, which may have several lines.
_CALLS = re.compile(r"\A(?:[ \t].*\n?|\n)*")
# The class of an error of ours says less than its line.
_CLASS = re.compile(r"^burridge_knopoff(\.\w+)+: ")

_TRACEBACK = "Traceback (most recent call last):\n"

SILENT = "no error in its log: it was killed, or could not begin"
FULL = "no error in its log: no space left on its disk"
#: What `bk` says at Ctrl-C, after the name of its command.
INTERRUPTED = "interrupted, nothing was written"
#: Of a disk with fewer bytes left a log may have had no room.
ROOM = 1 << 16

#: A line that tells of no failure: a note, or what calls have taken, which `running.processes` says of a long job.
_NO_FAILURE = re.compile(r"note: |.+: \d+, [\d.]+ s, the longest [\d.]+ s")


def last_words(log: str | Path) -> str:
    """Return in one line what a log says last: of a traceback the error, else its last line, if that tells of one."""
    try:
        text = Path(log).read_bytes()[-_TAIL:].decode("utf-8", errors="replace")
    except OSError:
        return ""
    _, traceback, said = text.rpartition(_TRACEBACK)
    lines = [line for line in said.splitlines() if line.strip() and not _NO_FAILURE.match(line)]
    said = _CALLS.sub("", said) if traceback else "".join(lines[-1:])
    words = _CLASS.sub("", " ".join(said.split()))
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST - 3]}..."


def interrupted(logs: Sequence[str | Path], *, stopping: bool = False) -> bool:
    """Tell whether a job was ended by Ctrl-C.

    stopping : whether the run was: a job that it ended before its program had begun left no word
    """
    # `bk` has a line for it, and scripts have a traceback, as `bk` has before it has read its command.
    said = [words for log in logs if (words := last_words(log))]
    return any(words.endswith((f": {INTERRUPTED}", "KeyboardInterrupt")) for words in said) or (stopping and not said)


def failure(job: str, logs: Sequence[str | Path]) -> str:
    """Return the line that tells of a failed job: the job, its reason, and where its log lies."""
    reason = next((words for log in logs if (words := last_words(log))), FULL if _is_full(logs) else SILENT)
    return f"failed: {job}: {reason} (log {', '.join(map(str, logs)) or 'none'})"


def _is_full(logs: Sequence[str | Path]) -> bool:
    """Tell whether a disk on which logs lie has no room for them."""
    return any(shutil.disk_usage(nearest_folder(Path(log).parent)).free < ROOM for log in logs)
