"""How a run ended, in the numbers of the kernel, for all that reads results and needs no kernel."""

from enum import IntEnum


class Status(IntEnum):
    """HALTED at a stop of the block to halt at, FULL if it would keep too much; the others are in files."""

    HALTED = -2
    FULL = -1
    COMPLETED = 0
    STEP_LIMIT = 1
    ACCUMULATING_EVENTS = 2
    DIVERGED = 3


#: How runs end, in words, by the number in files.
ENDS = {int(status): status.name.lower() for status in sorted(Status) if status >= Status.COMPLETED}

#: Of a command whose run did not complete, but whose results are written.
EXIT_CODE = 3
