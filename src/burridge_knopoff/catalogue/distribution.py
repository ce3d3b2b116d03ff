"""Counts of events by magnitude and by interval, and the range in which a slope is fitted if none is given."""

from __future__ import annotations

import numpy as np

#: Width of the bins of magnitudes and of logarithms of intervals, and their edges.
WIDTH = 0.5
EDGES = WIDTH * np.arange(-200, 201)


def fit_range(
    magnitude: np.ndarray,
    moment: np.ndarray,
    blocks: np.ndarray,
    low: float | None = None,
    high: float | None = None,
) -> tuple[float, float]:
    """Return the range in which a slope is fitted, with the ends that are not given.

    magnitude, moment, blocks : of the events, shape (events,)

    The range begins with the bin of the most frequent events of several blocks: below it the rate shows that the chain
    consists of blocks. It ends below the rarest bin between there and the bin that releases most moment, that of the
    largest events: in many chains this is a gap. The ends are equal, or NaN, if there is no such range.
    """
    several = magnitude[blocks > 1]
    if not len(several):
        return (np.nan if low is None else low), (np.nan if high is None else high)
    if low is None:
        low = float(EDGES[np.histogram(several, EDGES)[0].argmax()])
    if high is None:
        count, released = (np.histogram(magnitude, EDGES, weights=weights)[0] for weights in (None, moment))
        between = np.flatnonzero(EDGES[: released.argmax() + 1] >= low)
        high = float(EDGES[between[count[between].argmin()]]) if len(between) else low
        # A range of one bin is no range of magnitudes.
        high = high if high - low > WIDTH else low
    return low, high


def recurrence(
    time: np.ndarray, first_block: np.ndarray, last_block: np.ndarray, blocks: int
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return for each block how many events contain it, and mean and standard deviation of the intervals between them.

    time, first_block, last_block : of the events in their order, shape (events,); an event contains all blocks from its
        first to its last, in a ring also over the joint, where the first is above the last

    Returns three arrays of shape (blocks,); NaN for blocks of too few events.
    """
    count, squares = np.zeros(blocks, dtype=int), np.zeros(blocks)
    first, before = np.full(blocks, np.nan), np.full(blocks, np.nan)
    for at, low, high in zip(time.tolist(), (first_block - 1).tolist(), last_block.tolist(), strict=True):
        for part in (slice(low, high),) if low < high else (slice(low, blocks), slice(high)):
            gap = at - before[part]
            before[part] = at
            count[part] += 1
            squares[part] += np.nan_to_num(gap * gap)
            first[part] = np.where(np.isnan(first[part]), at, first[part])
    gaps = np.maximum(count - 1, 0)
    with np.errstate(invalid="ignore", divide="ignore"):
        mean = (before - first) / gaps
        spread = np.sqrt(np.maximum(squares / gaps - mean**2, 0.0))
    return count, mean, np.where(gaps > 1, spread, np.nan)
