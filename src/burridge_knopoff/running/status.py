"""The status of a run, with the numbers of the kernel. Reading results does not require the compiled kernel."""

from enum import IntEnum


class Status(IntEnum):
    """HALTED: at a stop of the halting block. FULL: too many numbers to store. The others also occur in files."""

    HALTED = -2
    FULL = -1
    COMPLETED = 0
    STEP_LIMIT = 1
    ACCUMULATING_EVENTS = 2
    DIVERGED = 3


#: The meanings of the status numbers in files.
STATUS_WORDS = {int(status): status.name.lower() for status in sorted(Status) if status >= Status.COMPLETED}

#: Exit code of a command whose run did not complete; its results are still written.
EXIT_CODE = 3


def early_end(status: int, time: float) -> str:
    """Return that a run did not complete, how it ended and when; empty if it completed."""
    if status == Status.COMPLETED:
        return ""
    return f"the run did not complete: {STATUS_WORDS[status].replace('_', ' ')} at tau = {time:g}"


def none_because(reason: str) -> str:
    """Return the words that stand in place of exponents, with the `missing_derivative` if there is one."""
    return f"none: {reason}: perturbations have no linear growth" if reason else "none"
