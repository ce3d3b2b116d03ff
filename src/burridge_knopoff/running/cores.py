"""The cores of this machine. The estimate of a run needs their number before the kernel is compiled."""

from __future__ import annotations

import os


def available_cores() -> int:
    """Return the number of cores on which this process may run."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
