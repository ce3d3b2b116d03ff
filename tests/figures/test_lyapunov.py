"""Lyapunov exponents: none is hidden by the strip or above the frame, and the frame follows their size."""

import numpy as np
import pytest
import xarray as xr
from matplotlib.colors import to_hex

from burridge_knopoff.figures.lyapunov import STRIP, draw
from burridge_knopoff.figures.palette import KINDS
from burridge_knopoff.motion.kind import MotionKind


def frame(exponent, error=0.005):
    """Return what the frame of the exponents reaches down to, and where its strip begins.

    exponent : of one law and one initial state, shape (a, exponent)
    """
    labels = {"law": ["linearized"], "initial": ["plus"], "a": np.linspace(0.1, 0.2, len(exponent))}
    summary = xr.Dataset(
        {
            "lyapunov_exponent": ((*labels, "exponent"), exponent[np.newaxis, np.newaxis]),
            "lyapunov_error": ((*labels, "exponent"), np.full((1, 1, *exponent.shape), error)),
        },
        labels,
    )
    kinds = xr.Dataset({"kind": (tuple(labels), np.ones((1, 1, len(exponent)), dtype=int))}, labels)
    (panel,) = draw(summary, kinds).axes
    low, high = panel.get_ylim()
    return low, low + STRIP * (high - low)


@pytest.mark.parametrize("largest", [-0.01, 0.07, 0.21])
def test_the_largest_exponent_and_its_bar_lie_below_the_strip(largest):
    low, strip = frame(np.array([[largest, 0.0, -np.inf]] * 2))
    assert low < largest - 0.015
    assert largest + 0.015 < strip


@pytest.mark.parametrize("springs", [0.2, 1.0, 30.0])
def test_the_frame_follows_the_exponents_but_not_those_that_are_very_negative(springs):
    exponent = springs * np.array([[0.05, -0.1, -5.0]] * 20)
    exponent[7, 1], exponent[8, 1] = -40.0, -np.inf
    low, strip = frame(exponent, error=0.0)
    assert low == pytest.approx(-0.2 * springs)
    assert strip == pytest.approx(0.11 * springs, rel=0.1)


@pytest.mark.parametrize("exponents", [1, 3])
def test_exponents_of_noise_are_seen_as_next_to_zero(exponents):
    low, strip = frame(np.full((5, exponents), 1e-5), error=0.0)
    assert low == -0.01
    assert strip > 0.005
    assert frame(np.full((5, exponents), np.nan))[0] == -0.01


def test_the_strip_shows_the_kinds_that_verdicts_are_on():
    """Where a run leaves its kind open they are those of its attractor."""
    labels = {"law": ["linearized"], "initial": ["plus"], "a": [0.1, 0.2]}
    exponents = (*labels, "exponent"), np.zeros((1, 1, 2, 3))
    kind = tuple(labels), np.full((1, 1, 2), MotionKind.QUASIPERIODIC)
    runs = xr.Dataset({"lyapunov_exponent": exponents, "lyapunov_error": exponents, "kind": kind}, labels)
    told = np.array([[[MotionKind.PERIODIC, MotionKind.CHAOTIC]]])
    (panel,) = draw(runs, xr.Dataset({"kind": (tuple(labels), told)}, labels)).axes
    strip = [to_hex(patch.get_facecolor()) for patch in panel.patches[:2]]
    assert strip == [to_hex(KINDS[kind]) for kind in told.ravel().tolist()]
