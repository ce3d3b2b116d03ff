"""How a run ended, in the numbers of the kernel; readers of results need no compiled kernel for it."""

from enum import IntEnum


class Status(IntEnum):
    """HALTED: at a stop of the halting block. FULL: too much to keep. The others also occur in files."""

    HALTED = -2
    FULL = -1
    COMPLETED = 0
    STEP_LIMIT = 1
    ACCUMULATING_EVENTS = 2
    DIVERGED = 3


#: The words for the status numbers in files.
STATUS_WORDS = {int(status): status.name.lower() for status in sorted(Status) if status >= Status.COMPLETED}

#: Exit code of a command that wrote its results although its run did not complete.
EXIT_CODE = 3
