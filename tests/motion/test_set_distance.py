"""Distances between sets of returns."""

import numpy as np
import pytest

from burridge_knopoff.motion.set_distance import distance, is_near, minimum_distance
from tests.motion.stand_in import nearest


def test_a_bound_changes_no_distance_within_it():
    """Whether a set is near another agrees with its distance, at the limit and on either side of it."""
    generator = np.random.default_rng(8)
    for size in (9, 20, 21, 200):
        first, second = generator.normal(size=(size, 6)), generator.normal(size=(150, 6))
        least, far = minimum_distance(first, second), distance(first, second)
        assert far == pytest.approx(np.quantile(nearest(first, second, 0), 0.95), rel=1e-12)
        assert least == nearest(first, second, 0).min()
        assert minimum_distance(first, second, least) == least
        assert minimum_distance(first, second, 0.999 * least) == np.inf
        for limit in (0.5 * far, 0.9999 * far, far, 1.0001 * far, 2.0 * far):
            assert is_near(first, second, limit) == (far <= limit)
