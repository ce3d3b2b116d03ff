"""Asymmetry of the end blocks beyond a_c: runs compared with orbits from Newton's method, and the fitted power law."""

import numpy as np
import pytest
from scipy.stats import linregress

from burridge_knopoff import Model
from burridge_knopoff.motion.synchronized_orbit import synchronized_orbits
from burridge_knopoff.periodic_orbits.pitchfork import branching_orbit
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.amplitude import fit_power_law, sweep

CRITICAL = {"linearized": 0.0869729046660773, "nonlinear": 0.0887172229711765}


@pytest.fixture(scope="module")
def families():
    return {law: synchronized_orbits(Model(law, a=0.0)) for law in PAPER_LAWS}


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
    x = np.array([1e-6, 5e-6, 3e-5, 8e-5, 2e-4, 1e-3])
    fit = fit_power_law(x, 0.3 * x**0.75)
    assert (fit.exponent, fit.coefficient) == pytest.approx((0.75, 0.3), abs=1e-9)
    assert max(fit.error, fit.coefficient_error) < 1e-9
    noisy = fit_power_law(x, 0.3 * x**0.75 * np.array([1.01, 0.99, 1.01, 0.99, 1.01, 0.99]))
    assert 1e-3 < noisy.error < 1e-1
    # The result has ten decimals, on which all machines agree.
    numbers = noisy.exponent, noisy.error, noisy.coefficient, noisy.coefficient_error
    assert numbers == tuple(round(value, 10) for value in numbers)


def test_the_errors_include_the_next_orders():
    """Offsets and terms as near a_c, ε^β exp(kε + mε²): a straight line in logarithms excludes β, by many errors."""
    generator = np.random.default_rng(1)
    offset = 21.0 * 1e-8 * 10 ** (np.arange(6) / 2.5)
    misses, of_lines = [], []
    for _ in range(300):
        beta, k, m = generator.choice([0.25, 0.5, 1.0]), generator.normal(0.0, 1.0), generator.normal(0.0, 1e4)
        amplitude = 0.2 * offset**beta * np.exp(k * offset + m * offset**2)
        shifted = offset + generator.normal(0.0, 1e-13)
        fit, line = fit_power_law(shifted, amplitude, 1e-13), linregress(np.log(shifted), np.log(amplitude))
        misses.append(((fit.exponent - beta) / fit.error, (fit.coefficient - 0.2) / fit.coefficient_error))
        of_lines.append((line.slope - beta) / line.stderr)
        assert fit.error < 1e-5
    covered = np.mean(np.abs(misses) < 1.0, axis=0)
    assert (covered > 0.63).all()
    assert np.median(np.abs(misses), axis=0) == pytest.approx(0.5, abs=0.3)
    assert np.mean(np.abs(of_lines) > 2.0) > 0.8


def test_an_error_of_the_origin_enters():
    offset = 1e-6 * 10 ** (np.arange(6) / 2.5)
    exact, shifted = fit_power_law(offset, offset**0.5), fit_power_law(offset + 1e-9, offset**0.5, 1e-9)
    assert exact.error < 1e-9
    assert 0.3 * shifted.error < abs(shifted.exponent - 0.5) < shifted.error
