"""The cores of this machine. The estimate of a run needs their number before the kernel is compiled."""

from __future__ import annotations

import os

#: Largest number of cores of a call.
MOST_CORES = 1024


def available_cores() -> int:
    """Return the number of cores on which this process may run, at most as many as a setting allows."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(available, MOST_CORES)
