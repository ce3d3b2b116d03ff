"""Asymmetry of the end blocks beyond a_c: runs compared with orbits from Newton's method, and the fitted power law."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model, law_of
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.amplitude import fit_power_law, sweep

CRITICAL = {"linearized": 0.0869729046660773, "nonlinear": 0.0887172229711765}


@pytest.fixture(scope="module")
def families():
    return {law: synchronized_orbits(Model(Chain(3), law_of(law, 0.0))) for law in PAPER_LAWS}


@pytest.mark.parametrize("law", PAPER_LAWS)
def test_no_hysteresis(families, law):
    values = CRITICAL[law] + np.array([-2e-3, -1e-3, 1e-3, 2e-3])
    up, down = sweep(families[law], values), sweep(families[law], values[::-1])[::-1]
    assert up == pytest.approx(down, abs=1e-9)
    assert (up[:2] < 1e-9).all()
    assert (up[2:] > 5e-3).all()


@pytest.mark.parametrize("law", PAPER_LAWS)
def test_a_sweep_ends_on_the_branch(families, law):
    """While both stick, the distance of blocks 1 and 3 is that on the orbit found by Newton's method."""
    orbit = branching_orbit(families[law].at(CRITICAL[law]), 1e-2)
    assert sweep(families[law], np.array([orbit.a])) == pytest.approx([1e-2], abs=1e-9)


def test_a_sweep_gives_nan_where_end_blocks_do_not_stick_together(families):
    amplitude = sweep(families["linearized"], np.array([0.08, 0.25, 0.08]))
    assert np.isnan(amplitude).tolist() == [False, True, True]


def test_power_law_of_a_power_law():
    x = np.array([1e-6, 3e-5, 2e-4, 1e-3])
    fit = fit_power_law(x, 0.3 * x**0.75)
    assert (fit.exponent, fit.coefficient) == pytest.approx((0.75, 0.3), abs=1e-9)
    assert fit.error < 1e-9
    noisy = fit_power_law(x, 0.3 * x**0.75 * np.array([1.01, 0.99, 1.01, 0.99]))
    assert 1e-4 < noisy.error < 1e-2
    # The result has ten decimals, on which all machines agree.
    numbers = noisy.exponent, noisy.error, noisy.coefficient
    assert numbers == tuple(round(value, 10) for value in numbers)
