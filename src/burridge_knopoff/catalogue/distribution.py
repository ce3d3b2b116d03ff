"""Statistics of slip events: the default range of the fit, the blocks of events, and recurrence at each block."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.catalogue.batches import batch_index, batch_sums, ratio_error
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


@dataclass(frozen=True, eq=False)
class Recurrence:
    """Events that contain each block, and the intervals between them; arrays of shape (blocks,).

    count : number of events
    mean, spread : mean and standard deviation of the intervals, NaN for blocks with too few events
    mean_error, spread_error : their standard errors, NaN if nearly all intervals end in a few batches
    """

    count: np.ndarray
    mean: np.ndarray
    mean_error: np.ndarray
    spread: np.ndarray
    spread_error: np.ndarray


def recurrence(time: np.ndarray, members: Sequence[np.ndarray], blocks: int, begin: float, end: float) -> Recurrence:
    """Return how often the blocks slip.

    time : times of the events in ascending order, shape (events,)
    members : the blocks (1 …) of each event
    begin, end : of the catalogue
    """
    block = np.concatenate([np.zeros(0, dtype=int), *members]) - 1
    event = np.repeat(np.arange(len(time)), [len(part) for part in members])
    order = np.argsort(block, kind="stable")
    block, event = block[order], event[order]
    again = np.flatnonzero(np.diff(block) == 0) + 1
    row, gap = block[again], time[event[again]] - time[event[again - 1]]
    batch = batch_index(time, begin, end)[event[again]]

    def sums(values: np.ndarray | None) -> np.ndarray:
        return batch_sums(batch, values, row, blocks)

    number = sums(None)
    gaps = number.sum(axis=1)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = sums(gap).sum(axis=1) / gaps
        # The intervals may hardly differ: a second pass removes the rounding of the first.
        mean += sums(gap - mean[row]).sum(axis=1) / gaps
        deviation = gap - mean[row]
        spread = np.where(gaps > 1, np.sqrt(sums(deviation**2).sum(axis=1) / gaps), np.nan)
        return Recurrence(
            np.bincount(block, minlength=blocks),
            mean,
            ratio_error(sums(deviation), number),
            spread,
            ratio_error(sums(deviation**2), number) / (2.0 * spread),
        )
