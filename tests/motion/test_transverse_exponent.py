"""The transverse exponent of chains: two blocks to 40 digits, other chains by two trajectories, and its error."""

import math

import numpy as np
import pytest

from burridge_knopoff import (
    ChainState,
    InitialState,
    multipliers,
    synchronized_orbit,
    transverse_exponent,
)
from burridge_knopoff.motion.mirror import symmetrized
from burridge_knopoff.running.runner import Runner
from tests.motion.chains import SAMPLE, model, two_block_exponent
from tests.refused import refused


@pytest.mark.parametrize(
    ("law", "a"), [*(("linearized", a) for a in (0.01, 0.03, 0.1, 0.3)), *(("nonlinear", a) for a in (0.02, 0.1))]
)
def test_transverse_exponent_of_two_blocks(law, a):
    """The error arises from the phases at which the window begins and ends."""
    chain = model(2, a, law)
    state = chain.begin(InitialState("state", (-1.0, -0.9), (0.1, 0.1)))
    exponent, error = transverse_exponent(chain, state, 2000.0, 10_000.0)
    assert exponent == pytest.approx(two_block_exponent(law, a), abs=2e-4)
    assert error < 1e-3


@pytest.mark.parametrize("blocks", [4, 7, 8, 10])
def test_transverse_exponent_against_two_trajectories(blocks, law):
    """A second trajectory is kept at 1e-7 from the symmetric one: their distance grows at the same rate.

    Only antisymmetric parts are compared, since errors of second order are symmetric.
    """
    chain = model(blocks, 0.2, law)
    runner = Runner(chain)
    state = chain.begin(SAMPLE.initial_states(blocks)[0])
    exponent, _ = transverse_exponent(chain, state, 100.0, 200.0)

    state = symmetrized(state)
    apart = np.cos(1.0 + 2.3 * np.arange(2 * blocks)).reshape(2, -1)
    logarithms = []
    for _ in range(30):
        apart = apart - apart[:, ::-1]
        apart[1, state.stuck] = 0.0
        apart *= 1e-7 / np.linalg.norm(apart)
        other = runner.state_after(ChainState(state.position + apart[0], state.velocity + apart[1], state.stuck), 10.0)
        state = symmetrized(runner.state_after(state, 10.0))
        apart = (other.vector() - state.vector()).reshape(2, -1)
        logarithms.append(math.log(np.linalg.norm(0.5 * (apart - apart[:, ::-1])) / 1e-7))
    assert sum(logarithms[10:]) / 200.0 == pytest.approx(exponent, abs=1e-5)


def test_a_window_of_several_parts_gives_their_mean():
    """The parts are whole windows of any length, each beginning where the previous one ends."""
    chain = model(5, 0.2)
    state = chain.begin(SAMPLE.initial_states(5)[0])
    whole, _ = transverse_exponent(chain, state, 100.0, 173.0)
    windows = [(100.0, 50.0), (150.0, 61.5), (211.5, 61.5)]
    parts = [transverse_exponent(chain, state, *times)[0] for times in windows]
    assert whole == pytest.approx(np.average(parts, weights=[window for _, window in windows]), abs=1e-9)
    assert transverse_exponent(chain, state) == transverse_exponent(chain, state, 200.0, 2500.0)


@pytest.mark.parametrize("window", [0.0, 1.0, 10.0, 49.9])
def test_a_window_that_is_too_short_for_an_error_is_refused(window):
    chain = model(3, 0.05)
    with refused(f"window: {window}"):
        transverse_exponent(chain, chain.begin(SAMPLE.initial_states(3)[0]), 200.0, window)


@pytest.mark.slow
@pytest.mark.parametrize("window", [500.0, 2500.0])
def test_deviations_from_the_multiplier_are_within_the_error(law, window):
    """A batch of 500 is close to 88 periods of synchrony: the scatter of batches alone may be 1e-17 there."""
    deviations = []
    for a in np.linspace(0.08, 0.09, 13).tolist():
        chain = model(3, a, law)
        orbit = synchronized_orbit(chain)
        exact = math.log(abs(multipliers(orbit).transverse)) / orbit.period
        start = chain.begin(InitialState("state", (-1.0, -1.0, -1.0), (0.1, 0.1, 0.1)))
        exponent, error = transverse_exponent(chain, start, 2500.0, window)
        deviations.append(abs(exponent - exact) / error)
        # Two instants of a period differ by less than a factor of 20.
        assert error < 3.0 / window
    assert np.mean(np.array(deviations) < 1.0) > 0.68
    assert max(deviations) < 3.0


@pytest.mark.slow
def test_in_chaos_the_error_is_the_scatter_of_whole_windows():
    """Consecutive windows scatter by the error of each."""
    chain = model(6, 0.25)
    state = chain.begin(SAMPLE.initial_states(6)[0])
    exponents = np.array([transverse_exponent(chain, state, 200.0 + 500.0 * k, 500.0) for k in range(40)])
    ratio = math.sqrt((exponents[:, 1] ** 2).mean()) / exponents[:, 0].std(ddof=1)
    assert 0.75 < ratio < 1.5


def test_a_perturbation_is_renewed_after_ten_time_units_at_most(monkeypatch):
    """All batches then have the same number of pieces of one length: 173 time units have five times four."""
    times, after = [], Runner.state_after
    monkeypatch.setattr(Runner, "state_after", lambda runner, at, time: times.append(time) or after(runner, at, time))
    chain = model(4, 0.05)
    transverse_exponent(chain, chain.begin(SAMPLE.initial_states(4)[0]), 95.0, 173.0)
    assert times == [9.5] * 10 + [173.0 / 20] * 20
