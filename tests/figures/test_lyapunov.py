"""Lyapunov exponents: none is hidden by the strip or above the frame."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.figures.lyapunov import STRIP, draw


@pytest.mark.parametrize("largest", [-0.01, 0.07, 0.21])
def test_the_largest_exponent_and_its_bar_lie_below_the_strip(largest):
    labels = {"law": ["linearized"], "initial": ["plus"], "a": [0.1, 0.2]}
    exponent = np.array([largest, 0.0, -np.inf]) * np.ones((1, 1, 2, 1))
    summary = xr.Dataset(
        {
            "lyapunov_exponent": ((*labels, "exponent"), exponent),
            "lyapunov_error": ((*labels, "exponent"), np.full(exponent.shape, 0.005)),
            "kind": (tuple(labels), np.ones((1, 1, 2), dtype=int)),
        },
        labels,
    )
    (panel,) = draw(summary).axes
    low, high = panel.get_ylim()
    assert low < largest - 0.015
    assert largest + 0.015 < low + STRIP * (high - low)
