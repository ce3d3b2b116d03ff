"""Slopes of drawn catalogues, whose slope is known."""

import numpy as np
import pytest

from burridge_knopoff.catalogue.slope import fit_slope
from tests.refused import refused


def drawn(b, low, high, count, seed):
    """Draw magnitudes from exp(−bm) between two magnitudes, by the inverse of their distribution."""
    share = np.random.default_rng(seed).random(count)
    if b == 0.0:
        return low + (high - low) * share
    return low - np.log1p(share * np.expm1(-b * (high - low))) / b


@pytest.mark.parametrize(("b", "low", "high"), [(0.5, -3.0, 4.0), (1.0, 0.0, 2.0), (-0.4, 0.0, 3.0), (0.0, 1.0, 2.0)])
def test_slope_and_its_error(b, low, high):
    found = [fit_slope(drawn(b, low, high, 500, seed), low, high) for seed in range(300)]
    slopes = np.array([item.b for item in found])
    errors = np.array([item.error for item in found])
    assert abs(slopes.mean() - b) < 4.0 * slopes.std() / np.sqrt(300)
    assert slopes.std() == pytest.approx(errors.mean(), rel=0.15)
    # The slope was fitted to the same events: hardly any is refused.
    assert np.mean([item.p_value < 0.01 for item in found]) < 0.02


def test_events_outside_the_range_do_not_count():
    magnitude = drawn(1.0, 0.0, 3.0, 1000, 1)
    with_others = np.concatenate([magnitude, [-5.0, 9.0]])
    assert fit_slope(with_others, 0.0, 3.0) == fit_slope(magnitude, 0.0, 3.0)


def test_another_distribution_is_told():
    """A bump of large events is no straight line."""
    magnitude = np.concatenate([drawn(1.0, 0.0, 5.0, 2000, 1), np.random.default_rng(2).normal(4.0, 0.2, 300)])
    assert fit_slope(magnitude, 0.0, 5.0).p_value < 1e-6


def test_what_has_no_slope():
    with refused("magnitude: got 3 events between 0 and 2, expected 10 or more"):
        fit_slope(np.array([0.5, 1.0, 1.5]), 0.0, 2.0)
    with refused("magnitude: got only 1 between 0 and 2, expected a spread"):
        fit_slope(np.ones(20), 0.0, 2.0)
