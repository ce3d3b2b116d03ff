"""Statistics of slip events: the default range of the fit, the blocks of events, and recurrence at each block."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from burridge_knopoff.messages import refusal
from burridge_knopoff.values import real_number

#: Width and edges of the bins of magnitudes and of logarithms of intervals.
WIDTH = 0.5
EDGES = WIDTH * np.arange(-200, 201)


def fit_range(
    magnitude: np.ndarray,
    moment: np.ndarray,
    blocks: np.ndarray,
    low: float | None = None,
    high: float | None = None,
) -> tuple[float, float]:
    """Return the range of magnitudes in which the slope is fitted. Ends that are given are kept.

    magnitude, moment, blocks : of the events, shape (events,)

    The range begins one bin above the most frequent magnitude of events with more than one block. Below, the rate is
    affected by the size of a block, and at its maximum it is not yet exponential (J. Woessner and S. Wiemer, Bull.
    Seismol. Soc. Am. 95 (2005) 684). The range ends below the bin with the fewest events between there and the bin that
    releases most moment, that of the largest events; in many chains this bin lies in a gap. The ends are equal, or NaN,
    if there is no such range. Raises ValueError, one line, for an end that is not a number.
    """
    for key, end in (("low", low), ("high", high)):
        if end is not None and math.isnan(real_number(end)):
            raise refusal(key, end, "a number")
    several = magnitude[blocks > 1]
    if not len(several):
        return (np.nan if low is None else low), (np.nan if high is None else high)
    if low is None:
        low = float(EDGES[np.histogram(several, EDGES)[0].argmax() + 1])
    if high is None:
        count, released = (np.histogram(magnitude, EDGES, weights=weights)[0] for weights in (None, moment))
        between = np.flatnonzero(EDGES[: released.argmax() + 1] >= low)
        high = float(EDGES[between[count[between].argmin()]]) if len(between) else low
        # A single bin is not a range of magnitudes.
        high = high if high - low > WIDTH else low
    return low, high


def covered_blocks(first_block: np.ndarray, last_block: np.ndarray, blocks: int) -> list[np.ndarray]:
    """Return the blocks (1 …) of each event in a row or a ring: all blocks from its first to its last.

    first_block, last_block : of the events, shape (events,). In a ring, `first_block` exceeds `last_block` if the event
        spans the seam
    """
    length = (last_block - first_block) % blocks + 1
    return [(first - 1 + np.arange(count)) % blocks + 1 for first, count in zip(first_block, length, strict=True)]


def recurrence(
    time: np.ndarray, members: Sequence[np.ndarray], blocks: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return for each block the number of events, and the mean and standard deviation of the intervals between them.

    time : times of the events in ascending order, shape (events,)
    members : the blocks (1 …) of each event

    Returns three arrays of shape (blocks,), with NaN for blocks with too few events. Mean and variance are updated with
    each interval: B. P. Welford, Technometrics 4 (1962) 419.
    """
    count, before = np.zeros(blocks, dtype=int), np.full(blocks, np.nan)
    mean, squares = np.zeros(blocks), np.zeros(blocks)
    for at, several in zip(time.tolist(), members, strict=True):
        part = several - 1
        again = part[count[part] > 0]
        gap = at - before[again]
        deviation = gap - mean[again]
        mean[again] += deviation / count[again]
        squares[again] += deviation * (gap - mean[again])
        count[part] += 1
        before[part] = at
    gaps = np.maximum(count - 1, 1)
    spread = np.where(count > 2, np.sqrt(squares / gaps), np.nan)
    return count, np.where(count > 1, mean, np.nan), spread
