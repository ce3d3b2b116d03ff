"""Fitted powers and rates of claims, and their errors, on numbers with a known next order."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff.claims.paper.laws import _power
from burridge_knopoff.claims.paper.synchronization import _decay_rate

A = np.linspace(0.0025, 0.1, 40)


def test_the_error_of_a_power_includes_its_change_with_a():
    """The power is 2 as a → 0, and 2 − a/0.1 + a²/0.04 locally."""
    power, error = _power(A, A**2 * np.exp(-A / 0.1))
    assert 2.0 - power == pytest.approx(error, rel=1e-9)
    assert error > 0.2
    power, error = _power(A, A**2 * np.exp(-A / 0.1 + 0.5 * A**2 / 0.04))
    assert abs(power - 2.0) < 1.5 * error
    exact, none = _power(A, 3.0 * A**2)
    assert (exact, none) == pytest.approx((2.0, 0.0), abs=1e-12)
    assert _power(A[:3], A[:3] ** 2) == (pytest.approx(2.0), None)


@pytest.mark.parametrize("phase", np.linspace(0.0, 6.0, 13))
def test_the_error_of_a_decay_rate_includes_the_oscillation(phase):
    """J = exp(−0.0074 τ)·|cos|, with levels that it last exceeds at any phase."""
    time = np.linspace(0.0, 2000.0, 400_001)
    distance = np.exp(-0.0074 * time) * (0.1 + 0.9 * np.abs(np.cos(np.pi * time / 5.67 + phase)))
    levels = np.array([1e-2, 1e-3, 1e-6])
    settled = [time[np.flatnonzero(distance >= level)[-1]] for level in levels]
    runs = xr.Dataset({"settling_time": ("level", settled)}, {"level": levels})
    rate, error = _decay_rate(runs, 1e-6, 2.0 * 5.67)
    assert abs(rate - 0.0074) < error < 2e-4
    assert np.isnan(_decay_rate(runs.isel(level=[2]), 1e-6, 11.0)).all()
