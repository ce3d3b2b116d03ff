"""The cores of this machine. The estimate of a run needs their number before the kernel is compiled."""

from __future__ import annotations

import os

from burridge_knopoff.model.ranges import Whole

MOST_CORES = 1024
#: Numbers of cores of a call.
CORES = Whole(1, MOST_CORES)


def available_cores() -> int:
    """Return the number of cores on which this process may run, at most as many as a setting allows."""
    available = len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1
    return min(available, MOST_CORES)


def chosen_cores(cores: int | None) -> int:
    """Return the cores of a call: those given, or by default all that are available.

    Raises ValueError, one line, for another number than `CORES` allows.
    """
    return available_cores() if cores is None else CORES.form(cores, "cores")
