"""Lyapunov exponents of long chains: perturbations propagated in groups grow as in the chain as a whole."""

import numpy as np
import pytest
from hypothesis import assume
from hypothesis import strategies as st

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.kernel._core import Exponents
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from tests.catalogue.test_stability import rests, rough
from tests.conftest import random_examples
from tests.kernel.test_groups import LAWS, MIXED, at_rest, events

#: Undamped, underdamped and overdamped slips; the last creep under quasi-static loading.
DASHPOTS = [(0.0, 0.0), (0.5, 0.0), (0.0, 0.2), (2.0, 0.1), (8.0, 4.0), (0.0, 12.0)]


def growth(model, start, edges, count, groups, loading="steady", clock=None, at_rest=False):
    """Return a runner that has run to the last edge, and the growth of each perturbation in each batch."""
    begin = start.time if clock is None else clock
    exponents = Exponents(model.blocks, count, begin, np.asarray(edges, dtype=float), at_rest)
    runner = Runner(model, groups=groups, exponents=exponents, loading=loading)
    runner.begin(start, clock)
    assert runner.run(edges[-1]) == Status.COMPLETED
    assert runner.kernel.local == groups
    return runner, exponents.results()


def end_of(model, start, loading, count):
    """Return a time by which a run has had so many events, or has taken long."""
    runner = Runner(model, groups=True, loading=loading)
    runner.begin(start)
    end = 0.0
    while runner.log.count < count and end < 3.0 / model.v + 200.0:
        end += 0.02 / model.v + 0.5
        assert runner.run(end) == Status.COMPLETED
    return end


@random_examples(
    50,
    150,
    st.integers(1, 40),
    st.sampled_from([*((law, "steady") for law in LAWS), ("carlson_langer", "quasistatic")]),
    st.sampled_from(["one_sided", "symmetric"]),
    st.sampled_from(["open", "ring"]),
    st.floats(0.2, 30.0),
    st.floats(-4.0, 0.0),
    st.sampled_from(DASHPOTS),
    st.integers(1, 8),
    st.integers(1, 60),
    st.integers(0, 10_000),
)
def test_growth_is_that_of_the_chain_as_a_whole(
    blocks, law_and_loading, contact, ends, coupling, speed, dashpots, vectors, count, seed
):
    law, loading = law_and_loading
    damping, pulling_damping = dashpots
    chain = Chain(
        blocks,
        coupling=coupling,
        pulling=1.0,
        ends=ends if blocks > 1 else "open",
        damping=damping,
        pulling_damping=pulling_damping,
        weakening=MIXED if seed % 2 else 1.0,
    )
    model = Model(law, a=LAWS[law], chain=chain, v=10.0**speed, contact=contact)
    start = at_rest(model, seed)
    # Under quasi-static loading batches of the chain as a whole begin and end with starts.
    edges = np.linspace(0.0, end_of(model, start, loading, count), 4 if loading == "steady" else 2)
    vectors = min(vectors, 2 * blocks)
    (grouped, local), (single, whole) = (
        growth(model, start, edges, vectors, groups, loading) for groups in (True, False)
    )
    # Chaos sets in with slips that reach far.
    assume(grouped.log.count == single.log.count)
    assume(np.abs(grouped.state().vector() - single.state().vector()).max() < 1e-13)
    assert local["duration"] == pytest.approx(whole["duration"], rel=1e-12)
    # Blocks that creep follow the others and remove further vectors; rounding decides whether some of it is left.
    creeps = loading == "quasistatic" and max(dashpots) > 1.0
    assert creeps or local["lost"] == whole["lost"]
    # A vector of which e⁻⁵ is left is known to fewer digits; so is the time at which an overdamped slip creeps.
    kept = whole["growth"].sum(axis=0) > -5.0
    error = np.abs(local["growth"][:, kept] - whole["growth"][:, kept])
    assert error.max(initial=0.0) < (1e-3 if creeps else 1e-9)


@pytest.mark.parametrize(
    ("law", "loading"),
    [
        ("nonlinear", "steady"),
        ("linearized", "steady"),
        ("carlson_langer", "steady"),
        ("carlson_langer", "quasistatic"),
    ],
)
def test_growth_does_not_depend_on_the_batches(law, loading):
    """The edge of a batch falls within the pieces of groups, whose perturbations are then determined at one instant."""
    model = Model(law, a=LAWS[law], blocks=60, coupling=20.0, pulling=1.0, v=0.02)
    start = at_rest(model, 4)
    runner, whole = growth(model, start, [0.0, 40.0], 4, True, loading)
    other, parts = growth(model, start, np.linspace(0.0, 40.0, 21), 4, True, loading)
    assert runner.log.count == other.log.count > 200
    assert (parts["duration"] > 0.0).sum() > 10
    assert parts["duration"].sum() == pytest.approx(40.0, abs=1e-12)
    assert np.abs(parts["growth"].sum(axis=0) - whole["growth"][0]).max() < 1e-9
    assert np.abs(whole["growth"]).max() > 1.0


def test_batches_of_whole_slips_grow_as_in_the_chain_as_a_whole():
    """Their edges lie in times at which all blocks stick."""
    model = Model("carlson_langer", a=1.5, blocks=12, coupling=3.0, pulling=1.0, v=0.002)
    start = rough(model)
    edges = rests(model, start, 240.0)[::3]
    assert len(edges) > 5
    (runner, local), (_, whole) = (growth(model, start, edges, 3, groups, at_rest=True) for groups in (True, False))
    assert runner.log.count > 20
    assert np.abs(whole["growth"]).max() > 1.0
    assert np.abs(local["growth"] - whole["growth"]).max() < 1e-9


def test_perturbations_that_start_within_the_pieces_of_groups():
    """A continued run repeats the pieces in which the run before has ended; a new run begins with pieces of its own."""
    model = Model("nonlinear", a=3.0, blocks=50, coupling=20.0, pulling=1.0, v=0.05)
    runner, _ = events(model, at_rest(model, 2), 17.3, True)
    middle = runner.final()
    assert not middle.stuck.all()
    continued, local = growth(model, middle, [17.3, 20.0], 3, True)
    anew = ChainState(middle.position, middle.velocity, middle.stuck, 17.3)
    single, whole = growth(model, anew, [17.3, 20.0], 3, False)
    assert continued.log.count == single.log.count > 10
    assert np.abs(local["growth"] - whole["growth"]).max() < 1e-9


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
def test_perturbations_do_not_change_the_motion(loading):
    model = Model("carlson_langer", a=5.0, blocks=60, coupling=20.0, pulling=1.0, v=0.02)
    start = at_rest(model, 9)
    bare = Runner(model, groups=True, loading=loading, keep_events=True)
    exponents = Exponents(60, 3, 0.0, np.linspace(5.0, 40.0, 8))
    followed = Runner(model, groups=True, loading=loading, keep_events=True, exponents=exponents)
    for runner in (bare, followed):
        runner.begin(start)
        assert runner.run(40.0) == Status.COMPLETED
    assert bare.log.count > 300
    for one, other in zip(bare.events(), followed.events(), strict=True):
        assert (one == other).all()


@pytest.mark.slow
@pytest.mark.parametrize(("v", "loading"), [(0.01, "steady"), (0.3, "steady"), (0.01, "quasistatic")])
def test_exponents_of_long_runs_agree_within_their_errors(v, loading):
    model = Model("carlson_langer", a=5.0, sigma=0.01, blocks=30, coupling=20.0, pulling=1.0, v=v)
    start = Runner(model).state_after(at_rest(model, 1), 2.0 / v)
    edges = np.linspace(0.0, 60.0 / v, 21)
    means, errors = [], []
    for groups in (True, False):
        _, results = growth(model, start, edges, 4, groups, loading, 0.0)
        rates = results["growth"] / results["duration"][:, None]
        means.append(rates.mean(axis=0))
        errors.append(rates.std(axis=0, ddof=1) / np.sqrt(len(rates)))
    assert means[0][0] > 5.0 * errors[0][0]
    assert (np.abs(means[0] - means[1]) < 4.0 * np.hypot(*errors)).all()


@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("dashpots", [(8.0, 4.0), (20.0, 30.0)])
def test_perturbations_that_dashpots_shorten_at_once_are_not_lost(dashpots, groups):
    """Exponents of uniform sliding are the eigenvalues of its linear equations, however strong its dashpots."""
    damping, pulling_damping = dashpots
    a = 0.1
    model = Model("linearized", a=a, blocks=2, damping=damping, pulling_damping=pulling_damping, v=1.0)
    sliding = ChainState(np.zeros(2), np.ones(2), np.zeros(2, dtype=bool))
    runner, results = growth(model, sliding, [0.0, 500.0, 1500.0], 4, groups, clock=-500.0)
    stiffness = np.array([[2.0, -1.0], [-1.0, 2.0]])
    drag = np.array([[damping + pulling_damping, -damping], [-damping, damping + pulling_damping]]) - a * np.eye(2)
    expected = np.linalg.eigvals(np.block([[np.zeros((2, 2)), np.eye(2)], [-stiffness, -drag]])).real
    assert runner.log.count == results["lost"] == 0
    exponents = results["growth"][1] / results["duration"][1]
    assert np.abs(exponents - np.sort(expected)[::-1]).max() < 1e-5
