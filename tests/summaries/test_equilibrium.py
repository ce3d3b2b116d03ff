"""Uniform sliding: the paper's positions, an independent Jacobian, and two diverging runs."""

import numpy as np
import pytest

from burridge_knopoff import Chain, FormulaLaw, InitialState, Model, Settings, law_of, simulate
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.equilibrium import digest, eigenvalues, simulate_sliding, sliding_position, summarize

MODELS = [Model(law, a=0.0) for law in PAPER_LAWS]


@pytest.fixture(scope="module")
def dataset():
    return summarize(MODELS, [0.0, 0.08, 0.3])


def jacobian(model):
    """Return the Jacobian at uniform sliding with the slope of the friction from central differences."""
    n = model.blocks
    h = 1e-5
    slope = -float(model.law(model.v + h) - model.law(model.v - h)) / (2 * h)
    return np.block([[np.zeros((n, n)), np.eye(n)], [-model.chain.stiffness, slope * np.diag(model.chain.thresholds)]])


def test_the_positions_of_the_paper(dataset):
    for a in (0.0, 0.08, 0.3):
        friction = {"linearized": 1.0 - 0.1 * a, "nonlinear": 1.0 / (1.0 + 0.1 * a)}
        for law in PAPER_LAWS:
            expected = -friction[law] * np.array([5 / 6, 2 / 3, 5 / 6])
            assert dataset["equilibrium_position"].sel(law=law, a=a).values == pytest.approx(expected, abs=1e-15)


@pytest.mark.parametrize(
    "chain",
    [
        *(Chain(blocks) for blocks in (2, 5, 30)),
        Chain(4, ends="ring", pulling=0.5),
        Chain(3, coupling=(1.0, 2.0), pulling=(1.0, 0.3, 2.0), threshold=(1.0, 0.7, 1.3)),
    ],
    ids=["two", "five", "thirty", "ring", "unequal"],
)
@pytest.mark.parametrize("law", ["linearized", "nonlinear", "exponential", "stribeck", "carlson_langer"])
def test_the_equilibrium_of_any_chain(chain, law):
    model = Model(law, a=0.4, chain=chain, v=0.7)
    force = -chain.stiffness @ sliding_position(model)
    assert force == pytest.approx(chain.thresholds * float(model.law(0.7)), abs=1e-11)
    mine, theirs = eigenvalues(model), np.linalg.eigvals(jacobian(model))
    for value in theirs:
        assert np.abs(mine - value).min() < 1e-9
    assert (np.diff(np.abs(mine.imag)) > -1e-9).all()
    assert (mine.imag[0::2] >= 0.0).all()
    assert np.sort(mine.imag) == pytest.approx(np.sort(theirs.imag), abs=1e-9)
    drift, rate = simulate_sliding(model, sliding_position(model))
    assert drift < 1e-10
    assert rate == pytest.approx(theirs.real.max(), abs=1e-9)


@pytest.mark.parametrize(
    "chain",
    [
        Chain(3, mass=(1.0, 2.0, 0.5)),
        Chain(4, ends="ring", mass=2.0),
        Chain(4, mass=(1.0, 2.0, 2.0, 1.0), threshold=(1.0, 2.0, 2.0, 1.0)),
        Chain(grid=(3, 2), coupling=1.5),
        Chain(3, weakening=(1.0, -0.2, 0.5), threshold=(1.0, 2.0, 1.5)),
        Chain(4, weakening=(1.0, 0.0, 0.0, 1.0), damping=0.0),
    ],
)
def test_masses_networks_and_friction(chain):
    model = Model("nonlinear", a=0.4, chain=chain, v=0.7)
    assert sliding_position(model) == pytest.approx(model.sliding_offset, rel=1e-12)
    slope = -0.4 * chain.weakenings / (1.0 + 0.4 * 0.7 * chain.weakenings) ** 2
    blocks = np.zeros((chain.blocks, chain.blocks)), np.eye(chain.blocks)
    dense = np.block([[*blocks], [-chain.stiffness, np.diag(-chain.thresholds * slope)]])
    dense[chain.blocks :] /= chain.masses[:, None]
    theirs = np.linalg.eigvals(dense)
    mine = eigenvalues(model)
    assert np.sort(mine.imag) == pytest.approx(np.sort(theirs.imag), abs=1e-9)
    assert np.sort(mine.real) == pytest.approx(np.sort(theirs.real), abs=1e-9)
    drift, rate = simulate_sliding(model, sliding_position(model))
    assert drift < 1e-10
    assert rate == pytest.approx(theirs.real.max(), abs=1e-9)


def test_a_large_chain_has_no_modes_in_the_summary():
    assert np.isnan(summarize([Model("linearized", a=0.1, blocks=2000)], [0.1])["eigenvalue"]).all()


def test_eigenvalues_and_growth_rates(dataset):
    real, imaginary = (dataset["eigenvalue"].sel(part=part) for part in ("real", "imaginary"))
    assert real.sel(law="linearized", a=0.3).values.tolist() == [0.15] * 6
    assert real.sel(law="nonlinear", a=0.3).values == pytest.approx([0.15 / 1.03**2] * 6, rel=1e-15)
    assert (real.sel(a=0.0) == 0.0).all()
    squares = np.repeat([3.0 - 3.0**0.5, 2.0, 3.0 + 3.0**0.5], 2)
    assert imaginary.sel(law="linearized", a=0.0).values ** 2 == pytest.approx(squares, abs=1e-11)
    assert abs(dataset["growth_rate"] - real.max("mode")).max() < 1e-11
    assert (dataset["equilibrium_drift"] < 1e-13).all()


def test_other_positions_are_not_an_equilibrium():
    model = Model("linearized", a=0.08)
    drift, _ = simulate_sliding(model, sliding_position(model) + np.array([1e-3, 0.0, 0.0]))
    assert drift > 1e-4


def growth(model, mode, rate, duration, push):
    """Return the growth of a perturbation along a mode in a run without events, without the tangent flow."""
    rest, shift = sliding_position(model), push * np.array(mode)
    # Initially its velocity is the growth rate times its displacement.
    state = InitialState("pushed", tuple(rest + shift), tuple(model.v + rate * shift))
    run = simulate(model, initial=state, settings=Settings(transient=0.0, window=duration, batches=2, trajectory=0.0))
    assert run.event_count == 0
    return (run.position[-1, 0] - rest[0]) / push


@pytest.mark.parametrize("periods", [1, 3])
def test_a_small_perturbation_grows_at_the_growth_rate(dataset, periods):
    rate, frequency = dataset.sel(law="linearized", a=0.3)["eigenvalue"].sel(mode=3).values
    duration = periods * 2 * np.pi / frequency
    # κ = 2: the mode's eigenvector is (1, 0, −1).
    grown = growth(Model("linearized", a=0.3), (1.0, 0.0, -1.0), rate, duration, 1e-5)
    assert grown == pytest.approx(np.exp(rate * duration), rel=1e-8)


def test_the_numbers_are_reproducible(dataset):
    assert dataset.identical(summarize(MODELS, [0.0, 0.08, 0.3]))


@pytest.mark.parametrize(
    ("law", "rate"),
    [
        (law_of("exponential", a=1.0), 0.5 * np.exp(-0.5)),
        (FormulaLaw("exp(-a*u)", a=1.0), 0.5 * np.exp(-0.5)),
        # −Φ'(v)/2 = a (exp(−av/σ) − η)/2: beyond the least friction perturbations decay.
        (law_of("stribeck", a=0.2, sigma=0.2), 0.1 * (np.exp(-0.5) - 0.2)),
        (law_of("stribeck", a=1.0), 0.5 * (np.exp(-10.0) - 0.2)),
    ],
)
def test_the_growth_rate_is_that_of_a_simulated_perturbation(law, rate):
    """At v = 0.5 the slower mirror-symmetric perturbation grows or decays at this rate."""
    model = Model(law, blocks=2, v=0.5)
    spectrum = eigenvalues(model)
    assert spectrum.real == pytest.approx([rate] * 4, abs=1e-12)
    assert simulate_sliding(model, sliding_position(model))[1] == pytest.approx(rate, abs=1e-10)
    # K = [[2, −1], [−1, 2]]: the mode (1, 1) has κ = 1.
    period = 2 * np.pi / spectrum[0].imag
    assert np.log(growth(model, (1.0, 1.0), rate, period, 1e-6)) / period == pytest.approx(rate, abs=1e-6)


def test_strong_damping_has_modes_that_do_not_oscillate():
    """κ = 1 and 3 with g = 2.5: g²/4 lies between."""
    model = Model("linearized", a=2.5, blocks=2)
    spectrum = eigenvalues(model)
    assert spectrum == pytest.approx(
        [1.25 + 0.75, 1.25 - 0.75, *(1.25 + s * 1j * (3 - 1.25**2) ** 0.5 for s in (1, -1))]
    )
    drift, rate = simulate_sliding(model, sliding_position(model))
    assert rate == pytest.approx(2.0, abs=1e-9)
    assert drift < 1e-5


@pytest.mark.parametrize("law", PAPER_LAWS)
def test_the_energy_about_sliding_grows_until_a_block_stops(law):
    """This holds for any motion under a law that decreases with velocity, so sticks are unavoidable."""
    model = Model(law, a=0.3)
    for seed in range(4):
        shift = 0.02 * np.random.default_rng(seed).uniform(-1.0, 1.0, 6)
        state = InitialState("near", tuple(model.sliding_offset + shift[:3]), tuple(model.v + shift[3:]))
        run = simulate(model, initial=state, transient=0.0, window=60.0, batches=2, trajectory=60.0, events="all")
        assert run.event_kind[0] == 0
        before = run.trajectory_time < run.event_time[0]
        assert before.sum() > 50
        velocity = run.velocity[before] - model.v
        position = run.position[before] - model.sliding_offset
        energy = 0.5 * (velocity**2).sum(axis=1) + 0.5 * np.einsum(
            "ti,ij,tj->t", position, model.chain.stiffness, position
        )
        assert (np.diff(energy) > 0.0).all()


def test_a_single_value_of_a_is_not_named():
    """A law without a has one; its growth rate is half the slope less the damping, (exp(−2) − 0.1)/2."""
    law = law_of({"belt": {"formula": "mud + (mus - mud)*exp(-u/v0)"}}, mus=1.0, mud=0.5, v0=0.5)
    model = Model(law, pulling=1.0, pulling_damping=0.1, v=1.0)
    rate = 0.5 * (np.exp(-2.0) - 0.1)
    assert digest(summarize([model], [0.0])) == (
        f"belt: perturbations of uniform sliding grow in every case; the largest growth rate is {rate:.4g}"
    )
