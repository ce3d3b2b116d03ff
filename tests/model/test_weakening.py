"""Blocks that differ in friction: θ_i Φ(w_i U') is the friction of a law with w_i a in place of a."""

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    FormulaLaw,
    InitialState,
    Model,
    hopf_bifurcations,
    law_of,
    simulate,
    sweep,
    synchronized_orbit,
)
from burridge_knopoff.running.kernel_model import creep_speed
from tests.flows import carry, differences, directions
from tests.refused import refused
from tests.scipy_flow import model_events

STATE = InitialState("drawn", (-0.9, -1.0, -1.1), (0.1, 0.12, 0.09))
OPTIONS = {"initial": STATE, "transient": 0.0, "events": "all"}


@pytest.mark.parametrize("name", ["linearized", "nonlinear", "exponential", "carlson_langer"])
def test_equal_weakening_is_a_factor_of_a(name):
    runs = [
        simulate(Model(name, a=a, weakening=w, contact="symmetric"), window=40.0, **OPTIONS)
        for w, a in ((0.25, 0.4), (1.0, 0.1))
    ]
    one, other = runs
    assert one.event_count > 20
    assert np.array_equal(one.event_block, other.event_block)
    assert one.event_time == pytest.approx(other.event_time, rel=0.0, abs=1e-9)
    assert one.mean_distance == pytest.approx(other.mean_distance, rel=1e-9)
    assert one.lyapunov_exponent == pytest.approx(other.lyapunov_exponent, rel=1e-6)
    assert one.model.sliding_offset == pytest.approx(other.model.sliding_offset, rel=1e-14)
    assert one.least_friction == pytest.approx(other.least_friction, rel=1e-12)


def test_without_weakening_friction_is_that_of_coulomb():
    """All laws, and any a, then give the same motion, in which no energy is gained."""
    chain = Chain(3, weakening=0.0)
    runs = [
        simulate(Model(law, a=a, chain=chain), window=40.0, **OPTIONS)
        for law, a in (("linearized", 0.0), ("nonlinear", 3.0))
    ]
    assert np.array_equal(*(run.event_time for run in runs))
    assert runs[0].least_friction == 1.0
    assert chain.a_unit == Chain(3).a_unit


def test_distances_are_in_proportion_to_v_under_the_linearized_law():
    chain, means = Chain(3, weakening=(1.0, -0.5, 0.0)), []
    for v in (0.1, 0.05):
        model = Model("linearized", a=0.3, chain=chain, v=v)
        x = v * np.array([1.0, -2.0, 0.5])
        state = InitialState("scaled", tuple(model.sliding_offset + x), (v, 1.1 * v, 0.9 * v))
        means.append(simulate(model, initial=state, transient=0.0, window=40.0).mean_distance / model.scale)
    assert means[0] == pytest.approx(means[1], rel=1e-9)


def test_the_least_friction_is_a_bound_over_all_blocks():
    """It is that of the block that weakens most at the speed of the fastest block."""
    model = Model("linearized", a=0.2, weakening=(1.0, -0.5, 2.0))
    run = simulate(model, window=20.0, trajectory=20.0, trajectory_sampling=1e-3, **OPTIONS)
    assert run.least_friction == pytest.approx(1.0 - 0.4 * run.velocity.max(), rel=1e-6)


def test_one_block_slides_where_its_dashpot_outweighs_its_friction():
    """The velocity of sliding obeys u'' = −u − (γ − g) u' with g = a w/(1 + a w v)², which is γ at the bifurcation."""
    a, v, gamma = 0.5, 0.4, 0.1
    model = Model("nonlinear", a=a, blocks=1, pulling=1.0, pulling_damping=gamma, v=v, contact="symmetric")
    (at,) = hopf_bifurcations(model, (-0.1, 0.6), parameter="weakening[1]")
    slope = a * at.value / (1.0 + a * at.value * v) ** 2
    assert slope == pytest.approx(gamma, rel=1e-12)
    assert at.period == pytest.approx(2.0 * np.pi, rel=1e-9)


def test_an_orbit_of_blocks_that_weaken_and_strengthen():
    """Its return against SciPy, and its monodromy matrix against finite differences."""
    orbit = synchronized_orbit(Model("nonlinear", a=0.15, weakening=(1.0, -0.3, 1.0)))
    _, end = model_events(orbit.model, orbit.reference, orbit.period)
    assert end == pytest.approx(orbit.reference.vector(), abs=1e-8)
    expected, _ = differences(orbit.model, orbit.reference, orbit.period, 1e-4)
    free = directions(orbit.reference).any(axis=0)
    assert orbit.monodromy[:, free] == pytest.approx(expected[:, free], abs=1e-6)


def test_perturbations_where_friction_grows_exponentially():
    """Against finite differences, also from a speed at which the friction of the second block is ten thresholds."""
    model = Model(FormulaLaw("0.95*exp(-a*u)", a=2.0), weakening=(1.0, -1.0, 0.5))
    start = ChainState(np.array([0.3, -0.2, 0.1]), np.array([0.1, 1.2, 0.3]), np.zeros(3, dtype=bool))
    perturbations = carry(model, start, 3.0, directions(start))[0].perturbations
    expected, _ = differences(model, start, 3.0, 1e-4)
    assert perturbations == pytest.approx(expected, abs=1e-6)


def test_a_sweep_over_the_weakening_of_one_block():
    model = Model("linearized", a=0.2)
    runs = sweep(model, initial="plus", **{"weakening[2]": [1.0, -0.5]}, transient=0.0, window=20.0)
    for factor in (1.0, -0.5):
        run = simulate(model.at(**{"weakening[2]": factor}), initial="plus", transient=0.0, window=20.0)
        assert runs["mean_distance"].sel(weakening_2=factor).item() == run.mean_distance
    assert run.model.chain.weakening == (1.0, -0.5, 1.0)
    assert run.model.parameter("a") == 0.2


def test_friction_that_grows_must_be_analytic_too():
    """1/(1 − w a u) has a pole at u = 1/(w a)."""
    assert Model("nonlinear", a=0.3, weakening=-0.3).parameter("a") == 0.3
    with refused("chain.weakening: (1.0, -0.5, 0.0)", "the law nonlinear is analytic"):
        Model("nonlinear", a=0.3, weakening=(1.0, -0.5, 0.0))
    with refused("chain.weakening: 20.0", "analytic"):
        Model(FormulaLaw("1/(1 + a*u) + 0.0001*log(1 - u/64)", a=0.1), weakening=20.0)


def test_only_blocks_that_strengthen_creep():
    law = law_of("carlson_langer", a=0.05, sigma=0.1)
    assert creep_speed(Model(law), "quasistatic") == 0.0
    assert creep_speed(Model(law, weakening=(1.0, -0.1, 1.0)), "quasistatic") > 0.0


def test_what_requires_equal_blocks_says_so():
    with refused("solver: 'map'", "uniform"):
        simulate(Model("linearized", a=0.1, weakening=0.5), solver="map")
    model = Model("linearized", a=0.1, weakening=(1.0, 1.0, 0.5))
    with refused("chain", "its own mirror image"):
        synchronized_orbit(model)
