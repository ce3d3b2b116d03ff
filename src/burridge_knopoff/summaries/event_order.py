"""The time for which two runs have the same order of events."""

from __future__ import annotations

import numpy as np

# Events of different blocks closer than this count as simultaneous: rounding decides their order.
SIMULTANEOUS = 1e-9

# Largest number of simultaneous events that is considered.
LARGEST_CLUSTER = 32


def common_order(
    first: tuple[np.ndarray, np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray, np.ndarray]
) -> tuple[int, float]:
    """Return how many events of two sequences (time, block, kind) occur in the same order, and until which time.

    The time is that of the first event, in either sequence, that differs or is missing in the other; it is infinite if
    the sequences agree. Events that are simultaneous in one of the runs may occur in any order.
    """
    count = min(len(first[0]), len(second[0]))
    codes = [(2 * block[:count].astype(int) + kind[:count]).tolist() for _, block, kind in (first, second)]
    times = [sequence[0][:count] for sequence in (first, second)]
    n = 0
    while n < count:
        if codes[0][n] == codes[1][n]:
            n += 1
            continue
        cluster = _cluster_size(codes, times, n)
        if not cluster:
            return n, float(min(time[n] for time in times))
        n += cluster
    longer = max(first, second, key=lambda sequence: len(sequence[0]))[0]
    return count, float(longer[count]) if len(longer) > count else np.inf


def _cluster_size(codes: list[list[int]], times: list[np.ndarray], n: int) -> int:
    """Return how many simultaneous events from the n-th on agree except for their order; 0 if they do not agree."""
    for size in range(2, min(LARGEST_CLUSTER, len(codes[0]) - n) + 1):
        if min(time[n + size - 1] - time[n] for time in times) > SIMULTANEOUS:
            return 0
        if sorted(codes[0][n : n + size]) == sorted(codes[1][n : n + size]):
            return size
    return 0
