"""Uniform sliding: the paper's positions, the Jacobian by other means, and two simulated runs that part."""

import numpy as np
import pytest

from burridge_knopoff.chain import Chain
from burridge_knopoff.friction import LAWS, Friction
from burridge_knopoff.initial import InitialState
from burridge_knopoff.simulation import simulate
from burridge_knopoff.stability.flow import Model
from burridge_knopoff.summaries.equilibrium import eigenvalues, simulate_sliding, sliding_position, summarize


@pytest.fixture(scope="module")
def found():
    return summarize(3, [0.0, 0.08, 0.3], 0.1)


def jacobian(model):
    """Return the Jacobian at uniform sliding with the slope of the friction from central differences."""
    n = model.chain.blocks
    h = 1e-5
    slope = -float(model.friction(model.v + h) - model.friction(model.v - h)) / (2 * h)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-model.chain.stiffness, slope * np.eye(n)]])


def test_the_positions_of_the_paper(found):
    for a in (0.0, 0.08, 0.3):
        friction = {"linearized": 1.0 - 0.1 * a, "nonlinear": 1.0 / (1.0 + 0.1 * a)}
        for law in LAWS:
            expected = -friction[law] * np.array([5 / 6, 2 / 3, 5 / 6])
            assert found["equilibrium_position"].sel(law=law, a=a).values == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize("blocks", [2, 5, 30])
@pytest.mark.parametrize("law", LAWS)
def test_any_chain(blocks, law):
    model = Model(Chain(blocks), Friction(law, 0.4), 0.7)
    force = model.chain.driving * 0.0 - model.chain.stiffness @ sliding_position(model)
    assert force == pytest.approx(np.full(blocks, float(model.friction(0.7))), abs=1e-14)
    mine, theirs = eigenvalues(model), np.linalg.eigvals(jacobian(model))
    for value in theirs:
        assert np.abs(mine - value).min() < 1e-9
    assert (mine.real > 0.0).all()
    assert np.sort(mine.imag) == pytest.approx(np.sort(theirs.imag), abs=1e-9)
    drift, rate = simulate_sliding(model, sliding_position(model))
    assert drift < 1e-12
    assert rate == pytest.approx(theirs.real.max(), abs=1e-9)


def test_eigenvalues_and_growth_rates(found):
    real, imaginary = (found["eigenvalue"].sel(part=part) for part in ("real", "imaginary"))
    assert real.sel(law="linearized", a=0.3).values.tolist() == [0.15] * 6
    assert real.sel(law="nonlinear", a=0.3).values == pytest.approx([0.15 / 1.03**2] * 6, rel=1e-15)
    assert (real.sel(a=0.0) == 0.0).all()
    assert imaginary.sel(law="linearized", a=0.0).values ** 2 == pytest.approx(
        np.repeat([3.0 - 3.0**0.5, 2.0, 3.0 + 3.0**0.5], 2), abs=1e-11
    )
    assert abs(found["growth_rate"] - real.max("mode")).max() < 1e-11
    assert (found["equilibrium_drift"] < 1e-13).all()


def test_elsewhere_is_no_equilibrium():
    model = Model(Chain(3), Friction("linearized", 0.08))
    drift, _ = simulate_sliding(model, sliding_position(model) + np.array([1e-3, 0.0, 0.0]))
    assert drift > 1e-4


def test_a_small_push_grows_at_that_rate(found):
    """Two whole runs, without the tangent flow: a push along the mode (1, 0, −1) after whole periods of that mode."""
    a, push = 0.3, 1e-5
    point = found.sel(law="linearized", a=a)
    rest = point["equilibrium_position"].values
    rate, frequency = point["eigenvalue"].sel(mode=3).values
    # κ = 2: the mode's eigenvector is (1, 0, −1), its velocity the growth rate times its displacement at first.
    period = 2 * np.pi / frequency
    velocity = 0.1 + rate * push * np.array([1.0, 0.0, -1.0])
    state = InitialState("pushed", tuple(rest + push * np.array([1.0, 0.0, -1.0])), tuple(velocity))
    for n in (1, 3):
        run = simulate("linearized", a, state, transient=0.0, window=n * period, batches=2, trajectory=0.0)
        assert run.event_count == 0
        assert run.position[-1, 0] - rest[0] == pytest.approx(push * np.exp(rate * n * period), rel=1e-8)


def test_the_same_numbers_again(found):
    assert found.identical(summarize(3, [0.0, 0.08, 0.3], 0.1))
