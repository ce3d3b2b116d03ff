"""What a failed job said last, from its log."""

from __future__ import annotations

import re
from collections.abc import Sequence
from itertools import dropwhile
from pathlib import Path

#: Of a log only its end is read.
_TAIL = 20_000
#: Longer reasons are cut.
_LONGEST = 500
# The class of an error of ours says less than its line.
_CLASS = re.compile(r"^burridge_knopoff(\.\w+)+: ")

_TRACEBACK = "Traceback (most recent call last):"

SILENT = "nothing in its log: it was killed, or could not begin"


def last_words(log: str | Path) -> str:
    """Return in one line what a log says last: of a traceback the error, else its last line. Nothing if it is empty."""
    try:
        with open(log, "rb") as file:
            file.seek(max(Path(log).stat().st_size - _TAIL, 0))
            text = file.read().decode("utf-8", errors="replace")
    except OSError:
        return ""
    lines = [line for line in text.splitlines() if line.strip()]
    if _TRACEBACK in lines:
        # What is not indented after the calls is the message, which may have several lines.
        calls = lines[len(lines) - lines[::-1].index(_TRACEBACK) :]
        lines = [" ".join(line.strip() for line in dropwhile(lambda line: line[0].isspace(), calls))]
    words = _CLASS.sub("", lines[-1].strip()) if lines else ""
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST - 3]}..."


def failure(job: str, logs: Sequence[str | Path]) -> str:
    """Return the line that tells of a failed job: the job, its reason, and where its log lies."""
    reason = next((words for log in logs if (words := last_words(log))), SILENT)
    return f"failed: {job}: {reason} (log {', '.join(map(str, logs)) or 'none'})"
