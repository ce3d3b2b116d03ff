"""What a failed job said last, from its log."""

from __future__ import annotations

import re
from collections.abc import Sequence
from pathlib import Path

#: Of a log only its end is read.
_TAIL = 20_000
#: Longer reasons are cut.
_LONGEST = 500
# The class of an error of ours says less than its line.
_CLASS = re.compile(r"^burridge_knopoff(\.\w+)+: ")

SILENT = "nothing in its log: it was killed, or could not begin"


def last_words(log: str | Path) -> str:
    """Return the last line of a log that says something: of a traceback the error. Nothing if there is none."""
    try:
        with open(log, "rb") as file:
            file.seek(max(Path(log).stat().st_size - _TAIL, 0))
            text = file.read().decode("utf-8", errors="replace")
    except OSError:
        return ""
    lines = [line.strip() for line in text.splitlines() if line.strip()]
    words = _CLASS.sub("", lines[-1]) if lines else ""
    return words if len(words) <= _LONGEST else f"{words[: _LONGEST - 3]}..."


def failure(job: str, logs: Sequence[str | Path]) -> str:
    """Return the line that tells of a failed job: the job, its reason, and where its log lies."""
    reason = next((words for log in logs if (words := last_words(log))), SILENT)
    return f"failed: {job}: {reason} (log {', '.join(map(str, logs)) or 'none'})"
