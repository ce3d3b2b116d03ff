"""Trajectories in lanes equal single runs to the bit, independent of other lanes."""

from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, FormulaLaw, Model, law_of
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.runner import Runner
from tests.conftest import quick_first
from tests.flows import carry, check_events
from tests.kernel.test_event_driven import GRAZES
from tests.scipy_flow import model_events


def states(model, count, seed=1):
    """Draw positions, velocities and which blocks stick."""
    generator = np.random.default_rng(seed)
    shape = count, model.blocks
    least = -0.1 if model.contact == "symmetric" else 0.0
    position = generator.uniform(-1.5, 1.0, shape) - model.sliding_offset
    return position, generator.uniform(least, 0.2, shape), generator.random(shape) < 0.2


def events_of(results, k):
    columns = (results[f"event_{name}"][k, : results["event_count"][k]].tolist() for name in ("time", "block", "kind"))
    return list(zip(*columns, strict=True))


def check_against_scalar(model, ensemble, count, end, start=None, tolerance=0.0):
    """Compare trajectories, random ones unless they are given, with single runs; return the number of events."""
    start = states(model, count) if start is None else start
    results = ensemble.run(*start, [end], events=3000)
    for k, (position, velocity, stuck) in enumerate(zip(*start, strict=True)):
        runner = Runner(model, keep_events=True, groups=False)
        runner.begin(ChainState(position, np.where(stuck, 0.0, velocity), stuck))
        assert results["status"][k] == runner.run(end)
        time, block, kind = runner.events()
        check_events(events_of(results, k), list(zip(time, block + 1, kind, strict=True)), tolerance)
        for name, expected in zip(("position", "velocity", "slip"), runner.kernel.values(), strict=True):
            assert np.abs(results[name][k, 0] - expected).max() <= tolerance
    return results["event_count"].sum()


@pytest.mark.parametrize("contact", CONTACTS)
@pytest.mark.parametrize("blocks", [2, 3, 5, 8])
@pytest.mark.parametrize("a", [0.02, 0.08, 0.3])
def test_events_of_random_states(law, blocks, contact, a):
    model = Model(law, a=a, blocks=blocks, v=0.1, contact=contact)
    assert check_against_scalar(model, new_ensemble(model), 40, 12.0) > 100


def test_a_block_that_is_pulled_back_from_its_threshold_starts_and_stops_once():
    """Rounding may leave its force beyond the threshold, which must not start it again and again."""
    model = Model("nonlinear", a=0.1, contact="symmetric")
    position = np.array([[0.2, (0.2 + 0.3 - 1.0) / 4.0, 0.3]] * 40) - model.sliding_offset
    position[:, 1] -= 2.0**-54 * np.arange(2, 42)
    # Its neighbours slip backward, so that its force falls.
    start = position, np.array([[-0.3, 0.0, -0.25]] * 40), np.array([[False, True, False]] * 40)
    assert check_against_scalar(model, new_ensemble(model), 40, 0.5, start) == 2 * 40


@pytest.mark.parametrize("v", [0.003, 0.5])
def test_slow_and_fast_drivers(v):
    model = Model("nonlinear", a=0.1, v=v)
    assert check_against_scalar(model, new_ensemble(model), 20, 1.0 / v) > 50


@pytest.mark.parametrize(
    "formula",
    ["(1 + a*u)**-1.5*sqrt(1 + a*u)", "exp(-log(1 + a*u))", "((1 + a*u)**-0.5)**2", "2/(1 + a*u) - 1/(1 + a*u)"],
)
def test_one_law_in_other_operations(formula):
    model, other = (Model(law) for law in (law_of("nonlinear", a=0.3), FormulaLaw(formula, a=0.3)))
    assert check_against_scalar(model, new_ensemble(other), 30, 10.0, tolerance=2e-12) > 100


@pytest.mark.parametrize("seed", quick_first(range(3), 1))
@pytest.mark.parametrize("ends", ["open", "ring"])
@pytest.mark.parametrize("drop", [0.0, 0.1])
def test_unequal_springs_and_thresholds_and_a_drop_at_the_start(drop, ends, seed):
    """Φ = (1 − drop) exp(−u / 2), on a ring and on an open chain whose blocks and springs are all different."""
    generator = np.random.default_rng(seed)
    coupling = generator.uniform(0.5, 1.5, 4 if ends == "ring" else 3)
    pulling, threshold = generator.uniform(0.5, 1.5, 4), generator.uniform(0.8, 1.2, 4)
    model = Model(
        FormulaLaw("(1 - drop)*exp(-a*u)", a=0.5, drop=drop), chain=Chain(4, coupling, pulling, threshold, ends)
    )
    position, velocity = generator.uniform(-0.4, 0.4, (2, 4)), generator.uniform(0.05, 0.2, (2, 4))
    results = new_ensemble(model).run(position, velocity, np.zeros((2, 4)), [12.0], events=100)
    for k in range(2):
        expected, _ = model_events(model, ChainState(position[k], velocity[k], np.zeros(4, dtype=bool)), 12.0)
        assert len(expected) > 8
        check_events(events_of(results, k), expected, 1e-8)


def members(result, order=slice(None)):
    """Return the bits of all results, with the members in a given order."""
    return {key: value[order].tobytes() for key, value in result.items()}


@pytest.fixture(params=[("linearized", 3, "one_sided"), ("nonlinear", 5, "one_sided"), ("nonlinear", 3, "symmetric")])
def model(request):
    law, blocks, contact = request.param
    return Model(law, a=0.2, blocks=blocks, v=0.1, contact=contact)


def test_no_lane_depends_on_another(model):
    """The results are the same in any order and in any grouping: alone, in threes, or all together."""
    start, times = states(model, 37), [0.5, 7.0, 30.0]
    whole = new_ensemble(model).run(*start, times, events=20)
    order = np.random.default_rng(3).permutation(37)
    assert members(new_ensemble(model).run(*(part[order] for part in start), times, events=20)) == members(whole, order)
    for size in (1, 3):
        ensemble = new_ensemble(model)
        for k in range(0, 37 - size, size):
            some = slice(k, k + size)
            assert members(ensemble.run(*(part[some] for part in start), times, events=20)) == members(whole, some)


def test_the_end_only_cuts_off(model):
    start, times = states(model, 20), np.linspace(0.3, 25.0, 40)
    ensemble = new_ensemble(model)
    long = ensemble.run(*start, [*times, 40.0], events=300)
    assert ensemble.run(*start, times)["position"].tobytes() == long["position"][:, :-1].tobytes()
    for end in (1.0, 11.1):
        short = ensemble.run(*start, [end], events=300)
        for k in range(20):
            assert [event[0] for event in events_of(short, k)] == [t for t, _, _ in events_of(long, k) if t <= end]


def own_images(start):
    """Return states that are their own mirror images, each half of one that is not."""
    blocks = start[0].shape[1]
    return [np.where(np.arange(blocks) < blocks // 2, part[:, ::-1], part) for part in start]


def test_mirror_images_move_as_mirror_images(model):
    """This holds to the bit, and a state that is its own image remains so."""
    start, ensemble = states(model, 30), new_ensemble(model)
    symmetric = own_images(start)
    for initial, images, times in (
        (start, [part[:, ::-1] for part in start], [3.0, 25.0]),
        (symmetric, symmetric, [25.0, 200.0]),
    ):
        straight, mirrored = ensemble.run(*initial, times), ensemble.run(*images, times)
        for key in ("position", "velocity", "slip"):
            assert (straight[key] == mirrored[key][:, :, ::-1]).all()


def test_blocks_that_stop_together_stop_in_one_step(model):
    """Otherwise steps would only approach the event; a symmetric state takes fewer steps per event than others."""
    start, rounds = states(model, 30), []
    for some in (start, own_images(start)):
        ensemble = new_ensemble(model)
        events = ensemble.run(*some, [200.0])["event_count"].sum()
        rounds.append(ensemble.rounds / events)
    assert rounds[1] < rounds[0]


def test_blocks_below_their_backward_thresholds_start_backward():
    backward = 0
    for seed in range(4):
        threshold = np.random.default_rng(seed).uniform(0.4, 2.0, 4)
        model = Model("nonlinear", a=0.3, chain=Chain(4, 3.0, 0.5, threshold), v=0.1, contact="symmetric")
        position, velocity, stuck = states(model, 40)
        start, ensemble = (2.0 * position, velocity, stuck), new_ensemble(model)
        assert check_against_scalar(model, ensemble, 40, 12.0, start) > 100
        slip = ensemble.run(*start, np.linspace(0.1, 12.0, 100))["slip"]
        backward += ((slip[:, 1:] < 0) & (slip[:, :-1] == 0)).sum()
    assert backward > 10


@pytest.mark.parametrize(("law", "initial", "before", "after"), GRAZES)
def test_grazing_touches(law, initial, before, after):
    """On one side a touch has just become a stick as short as 0.0013, on the other it has not."""
    counts = []
    for a in (before, after):
        model = Model(law, a=a)
        start = model.begin(PAPER_STATES[initial])
        results = new_ensemble(model).run(start.position[None], start.velocity[None], start.stuck[None], [200.0])
        counts.append(int(results["event_count"][0]))
        assert counts[-1] == len(carry(model, start, 200.0)[1])
    assert counts[1] >= counts[0] + 2


def test_threads_share_the_work():
    model = Model("nonlinear", a=0.2)
    start = states(model, 64)
    whole = new_ensemble(model).run(*start, [50.0])
    with ThreadPoolExecutor(4) as pool:
        parts = pool.map(lambda k: new_ensemble(model).run(*(values[k::4] for values in start), [50.0]), range(4))
        for k, part in enumerate(parts):
            assert members(part) == members(whole, slice(k, None, 4))


def test_a_trajectory_without_bound_ends_alone():
    """A fast block under a law that accelerates it without limit ends as diverged; another trajectory continues."""
    model = Model("linearized", a=1.9, v=0.1, contact="symmetric")
    position, velocity = np.array([[5.0, -5.0, 5.0], [0.0, 0.0, 0.0]]), np.array([[3.0, -3.0, 3.0], [0.1, 0.1, 0.1]])
    results = new_ensemble(model).run(position, velocity, np.zeros((2, 3)), [1.0, 300.0])
    alone = new_ensemble(model).run(position[1:], velocity[1:], np.zeros((1, 3)), [1.0, 300.0])
    assert results["status"][0] == 3
    assert results["end"][0] < 300.0
    assert np.isnan(results["position"][0, 1]).all()
    assert members(results, slice(1, 2)) == members(alone)
