"""The range of a fit in catalogues composed of known parts, and the recurrence of blocks by brute force."""

import numpy as np
import pytest

from burridge_knopoff.catalogue.distribution import covered_blocks, fit_range, recurrence
from burridge_knopoff.catalogue.slope import fit_slope
from tests.catalogue.test_slope import draw_magnitudes


def parts():
    """Return magnitudes and blocks of events of one block, of a power law, and of large events beyond a gap."""
    single = np.random.default_rng(1).normal(-6.2, 0.05, 5000)
    several = draw_magnitudes(0.7, -5.0, 1.0, 3000, 2)
    large = np.random.default_rng(3).normal(4.2, 0.3, 200)
    blocks = np.concatenate([np.ones(5000, dtype=int), np.full(3000, 4), np.full(200, 50)])
    return np.concatenate([single, several, large]), blocks


def test_the_range_lies_between_single_blocks_and_the_gap():
    magnitude, blocks = parts()
    low, high = fit_range(magnitude, np.exp(magnitude), blocks)
    assert (low, high) == (-4.5, 1.0)
    fit = fit_slope(magnitude, low, high)
    assert abs(fit.b - 0.7) < 3.0 * fit.error
    assert fit.p_value > 0.05


def test_given_ends_are_kept():
    magnitude, blocks = parts()
    moment = np.exp(magnitude)
    assert fit_range(magnitude, moment, blocks, low=-4.3) == (-4.3, 1.0)
    assert fit_range(magnitude, moment, blocks, high=0.2) == (-4.5, 0.2)
    assert fit_range(magnitude, moment, blocks, -4.3, 0.2) == (-4.3, 0.2)


def test_there_is_no_range_without_events_of_several_blocks():
    assert np.isnan(fit_range(np.zeros(0), np.zeros(0), np.zeros(0))).all()
    assert np.isnan(fit_range(np.zeros(9), np.ones(9), np.ones(9))).all()


def test_the_range_begins_where_the_rate_no_longer_bends():
    """Small events are missing, by a normal distribution around −1: a range from the mode gives too low a slope."""
    slopes = []
    for seed in range(40):
        everything = draw_magnitudes(0.8, -6.0, 6.0, 40_000, seed)
        chance = np.random.default_rng(100 + seed).normal(-1.0, 0.25, len(everything))
        magnitude = everything[chance < everything]
        fit = fit_slope(magnitude, *fit_range(magnitude, np.ones(len(magnitude)), np.full(len(magnitude), 2), high=4.0))
        slopes.append((fit.b - 0.8) / fit.error)
    assert abs(np.mean(slopes)) < 0.5


def test_recurrence():
    generator = np.random.default_rng(1)
    time = np.sort(generator.uniform(0.0, 100.0, 60))
    # In a ring, the first block of an event that spans the seam is above its last.
    first, last = generator.integers(1, 7, (2, 60))
    members = covered_blocks(first, last, 8)
    found = recurrence(time, members, 8, 0.0, 100.0)
    for block in range(1, 9):
        inside = (first <= block) & (block <= last) | (first > last) & ((block >= first) | (block <= last))
        assert inside.tolist() == [block in part for part in members]
        gaps = np.diff(time[inside])
        assert found.count[block - 1] == inside.sum()
        np.testing.assert_allclose(found.mean[block - 1], gaps.mean())
        np.testing.assert_allclose(found.spread[block - 1], gaps.std(), rtol=1e-12)
    single = recurrence(time[:1], [np.array([2, 3])], 3, 0.0, 100.0)
    assert single.count.tolist() == [0, 1, 1]
    assert np.isnan([single.mean, single.mean_error, single.spread, single.spread_error]).all()
    assert recurrence(time[:0], [], 2, 0.0, 1.0).count.tolist() == [0, 0]


def test_errors_of_recurrence_are_its_scatter():
    """Intervals of a gamma distribution: mean 2, standard deviation √2; two blocks with the same law."""
    rows = []
    for seed in range(150):
        time = np.cumsum(np.random.default_rng(seed).gamma(2.0, 1.0, 700))
        time = time[time < 1000.0]
        found = recurrence(time, [np.array([1])] * len(time), 1, 0.0, 1000.0)
        rows.append([found.mean[0], found.spread[0], found.mean_error[0], found.spread_error[0]])
    mean, spread, mean_error, spread_error = np.array(rows).T
    assert mean.mean() == pytest.approx(2.0, rel=0.01)
    assert spread.mean() == pytest.approx(np.sqrt(2.0), rel=0.01)
    for values, errors in ((mean, mean_error), (spread, spread_error)):
        assert np.sqrt((errors**2).mean()) == pytest.approx(values.std(ddof=1), rel=0.2)


def test_spread_of_intervals_that_hardly_differ():
    """A slow driver: the intervals are 10⁸ with a spread of 10⁻³."""
    gaps = 2.0**27 + np.random.default_rng(1).normal(0.0, 1e-3, 200)
    time = np.cumsum(gaps)
    found = recurrence(time, [np.array([1])] * len(time), 1, time[0], time[-1])
    np.testing.assert_allclose(found.mean[0], np.diff(time).mean(), rtol=1e-14)
    np.testing.assert_allclose(found.spread[0], np.diff(time).std(), rtol=1e-6)
    # Fluctuations of independent intervals: 10⁻³/√199 of the mean, 10⁻³/√398 of the standard deviation.
    assert found.mean_error[0] == pytest.approx(1e-3 / np.sqrt(199), rel=0.5)
    assert found.spread_error[0] == pytest.approx(1e-3 / np.sqrt(398), rel=0.5)
