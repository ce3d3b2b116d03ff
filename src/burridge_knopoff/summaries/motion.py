"""What kind of motion a run ended in, told from its section points, and how long two runs keep the same event order."""

from __future__ import annotations

import numpy as np

#: Kinds of motion; `aperiodic` does not tell quasiperiodic from chaotic motion.
KINDS = {-1: "undetermined", 0: "synchronized", 1: "periodic", 2: "aperiodic"}
UNDETERMINED, SYNCHRONIZED, PERIODIC, APERIODIC = KINDS

# Events of different blocks closer than this are simultaneous: their order is a matter of rounding.
SIMULTANEOUS = 1e-9

# A sequence has a period if it is seen this many times at least.
REPETITIONS = 3

# More events than this at one instant are not looked for.
LARGEST_CLUSTER = 32


def section_period(section: np.ndarray, tolerance: float, longest: int) -> int:
    """Return after how many points a sequence of section points W' repeats within tolerance; 0 if it does not.

    section : shape (n,); its second half is judged, so that a slow approach does not hide a period
    longest : largest period looked for
    """
    settled = section[len(section) // 2 :]
    for period in range(1, min(longest, len(settled) // REPETITIONS) + 1):
        turns = settled[: len(settled) // period * period].reshape(-1, period)
        if np.ptp(turns, axis=0).max() <= tolerance:
            return period
    return 0


def motion_kind(completed: bool, mean_distance: float, threshold: float, period: int) -> int:
    """Return the kind of motion, a key of KINDS: synchronized where ⟨J⟩ is below the threshold."""
    if not completed:
        return UNDETERMINED
    if mean_distance < threshold:
        return SYNCHRONIZED
    return PERIODIC if period else APERIODIC


def common_order(
    first: tuple[np.ndarray, np.ndarray, np.ndarray], second: tuple[np.ndarray, np.ndarray, np.ndarray]
) -> tuple[int, float]:
    """Return how many events of two sequences (time, block, kind) come in the same order, and until which time.

    The time is that of the first event, in either sequence, that differs or that the other does not have; infinite
    where the sequences are the same. Events that are simultaneous in one of the runs may come in any order.
    """
    count = min(len(first[0]), len(second[0]))
    codes = [(2 * block[:count].astype(int) + kind[:count]).tolist() for _, block, kind in (first, second)]
    times = [sequence[0][:count] for sequence in (first, second)]
    n = 0
    while n < count:
        if codes[0][n] == codes[1][n]:
            n += 1
            continue
        cluster = _reordered(codes, times, n)
        if not cluster:
            return n, float(min(time[n] for time in times))
        n += cluster
    longer = max(first, second, key=lambda sequence: len(sequence[0]))[0]
    return count, float(longer[count]) if len(longer) > count else np.inf


def _reordered(codes: list[list[int]], times: list[np.ndarray], n: int) -> int:
    """Return how many simultaneous events from the n-th on are the same but for their order; 0 if they are not."""
    for size in range(2, min(LARGEST_CLUSTER, len(codes[0]) - n) + 1):
        if min(time[n + size - 1] - time[n] for time in times) > SIMULTANEOUS:
            return 0
        if sorted(codes[0][n : n + size]) == sorted(codes[1][n : n + size]):
            return size
    return 0
