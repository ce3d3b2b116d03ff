"""Common event orders."""

import numpy as np

from burridge_knopoff.summaries.event_order import common_order


def sequence(time, block, kind):
    return np.array(time, float), np.array(block), np.array(kind)


def test_common_order():
    first = sequence([1, 2, 3, 4], [1, 2, 3, 1], [0, 0, 1, 1])
    assert common_order(first, first) == (4, np.inf)
    second = sequence([1.1, 2.1, 2.9, 3.0], [1, 2, 2, 1], [0, 0, 1, 1])
    assert common_order(first, second) == (2, 2.9)
    # One run continues where the other has no more events.
    assert common_order(first, sequence([1, 2], [1, 2], [0, 0])) == (2, 3.0)
    assert common_order(sequence([], [], []), sequence([], [], [])) == (0, np.inf)
    # The kind of the event matters as well as the block.
    assert common_order(first, sequence([1, 2], [1, 2], [0, 1])) == (1, 2.0)


def test_simultaneous_events_may_come_in_either_order():
    first = sequence([1, 2, 2 + 1e-13, 4], [2, 1, 3, 2], [0, 0, 0, 1])
    swapped = sequence([1, 2, 2 + 1e-13, 4], [2, 3, 1, 2], [0, 0, 0, 1])
    assert common_order(first, swapped) == (4, np.inf)
    apart = sequence([1, 2, 2.1, 4], [2, 3, 1, 2], [0, 0, 0, 1])
    far = sequence([1, 2, 2.1, 4], [2, 1, 3, 2], [0, 0, 0, 1])
    assert common_order(far, apart) == (1, 2.0)
    rotated = [sequence([1, 1, 1, 2], blocks, [0, 0, 0, 1]) for blocks in ([1, 2, 3, 1], [3, 1, 2, 1])]
    assert common_order(*rotated) == (4, np.inf)
