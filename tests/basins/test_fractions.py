"""The number of states for basin fractions: the smallest at which every interval is narrow enough."""

import numpy as np
import pytest

from burridge_knopoff.basins.fractions import LABELLED_AT_ONCE, STEP, further_states, required_states
from burridge_knopoff.model.sampling import fraction_interval, half_width, required_samples


@pytest.mark.parametrize("width", [0.3, 0.1, 0.02, 0.005])
def test_a_fraction_of_one_half_needs_the_most_states(width):
    most = required_samples(width)
    assert max(half_width(hits, most) for hits in range(0, most + 1, max(1, most // 50))) <= width
    assert half_width(int(0.48 * most), int(0.97 * most)) > width or most < 50
    assert required_samples(0.5) == 0


@pytest.mark.parametrize("share", [0.0, 0.03, 0.2, 0.5])
def test_no_more_states_are_drawn_than_narrow_intervals_require(share):
    labels = np.where(np.random.default_rng(5).random(3000) < share, 1, -1)
    count = required_states(labels, 0.02)

    def widest(n):
        hits = {0, *np.unique(labels[:n], return_counts=True)[1].tolist()}
        return max(0.5 * np.ptp(fraction_interval(hit, n)[1:]) for hit in hits)

    assert widest(count) <= 0.02
    assert count == STEP or widest((count - 1) // STEP * STEP) > 0.02
    # Later states do not matter, and one state fewer is not enough.
    assert required_states(labels[:count], 0.02) == count
    assert required_states(labels[: count - 1], 0.02) is None


def test_a_small_fraction_needs_fewer_states_than_a_large_one():
    counts = [required_states(np.arange(3000) % 100 < 100 * share, 0.02) for share in (0.05, 0.2, 0.5)]
    assert counts == sorted(counts)
    assert counts[0] < counts[-1] / 3


@pytest.mark.parametrize("shares", [(1.0,), (0.5, 0.5), (0.9, 0.1), (0.2, 0.3, 0.5)])
def test_about_as_many_states_are_labelled_as_are_needed(shares):
    """After the first states, hardly more than the required number."""
    labels = np.random.default_rng(1).choice(len(shares), size=5000, p=shares)
    width, total, batches = 0.03, 0, 0
    while required_states(labels[:total], width) is None:
        count = further_states(labels[:total], width)
        assert 0 < count <= LABELLED_AT_ONCE
        total, batches = total + count, batches + 1
    assert total - required_states(labels[:total], width) < (2 * STEP if len(shares) > 1 else LABELLED_AT_ONCE)
    assert batches <= 7
