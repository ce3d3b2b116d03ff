"""Dense networks, whose forces follow by increments from the blocks that slip, against sums over all springs."""

import time

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.kernel._core import Catalogue, Exponents, run_in_lockstep
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS
from tests.scipy_flow import model_events


def network(path, side, cut_off=np.inf, damping=0.0):
    """Return a square lattice with springs 9/r³ between all blocks up to a distance."""
    number = np.arange(side**2)
    x, y = number % side, number // side
    first, second = np.triu_indices(side**2, 1)
    distance = np.hypot(x[first] - x[second], y[first] - y[second])
    joined = distance <= cut_off
    springs = np.stack([first + 1, second + 1, 9.0 / distance**3, damping / distance], axis=1)[joined]
    np.savetxt(path, springs, fmt=["%d", "%d", "%.17g", "%.17g"])
    return Chain(springs=str(path), pulling=1.0)


#: Numbers of blocks and of their neighbours on both sides of the numbers from which on forces follow by increments
#: (24 blocks with 9 neighbours) and from which on the whole network is faster as a single group (28 with 10).
AT_SWITCHES = [(23, 22), (24, 23), (24, 8), (24, 9), (28, 8), (28, 9), (28, 10)]


def ring(path, blocks, neighbours):
    """Return blocks on a ring with springs 9/r³ to the nearest neighbours; an odd one is the block opposite."""
    steps = [*range(1, neighbours // 2 + 1), *[blocks // 2] * (neighbours % 2)]
    springs = {tuple(sorted((i, (i + step) % blocks))): 9.0 / step**3 for step in steps for i in range(blocks)}
    path.write_text("".join(f"{i + 1} {k + 1} {strength!r}\n" for (i, k), strength in springs.items()))
    chain = Chain(springs=str(path), pulling=1.0)
    assert (np.diff(chain.neighbours.start) == neighbours).all()
    return chain


def rest(model, seed=1):
    position = np.random.default_rng(seed).uniform(-0.905, -0.9, model.blocks) - model.sliding_offset
    return ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))


def model_of(chain, v=0.01):
    return Model("carlson_langer", a=2.0, sigma=0.2, chain=chain, v=v)


def run(model, start, end, **options):
    runner = Runner(model, keep_events=True, **options)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    return runner.final(), np.stack(runner.events())


@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("damping", [0.0, 0.2])
@pytest.mark.parametrize("cut_off", [np.inf, 2.0])
def test_events_equal_those_of_scipy(tmp_path, groups, damping, cut_off):
    """Another method with the whole matrix K, which adds all springs at each step."""
    model = model_of(network(tmp_path / "springs.txt", 5, cut_off, damping), v=0.05)
    start = rest(model)
    events, vector = model_events(model, start, 1.6)
    final, own = run(model, start, 1.6, groups=groups)
    assert len(events) > 20
    assert np.allclose(own[0], [event[0] for event in events], rtol=0.0, atol=1e-8)
    assert own[1:].T.tolist() == [[block - 1, kind] for _, block, kind in events]
    assert np.allclose(final.vector(), vector, rtol=0.0, atol=1e-7)


@pytest.mark.parametrize(("blocks", "neighbours"), AT_SWITCHES)
def test_networks_at_the_switches_of_the_method(tmp_path, blocks, neighbours):
    """Events are those of SciPy in groups and as a whole; parts and runs in lanes equal the whole run to the bit."""
    model = model_of(ring(tmp_path / "springs.txt", blocks, neighbours), v=0.05)
    starts, end = [rest(model, seed) for seed in range(3)], 5.0
    events, vector = model_events(model, starts[0], end)
    assert sum(kind == 0 for *_, kind in events) > 3
    for groups in (True, False):
        final, own = run(model, starts[0], end, groups=groups)
        assert np.allclose(own[0], [event[0] for event in events], rtol=0.0, atol=1e-8)
        assert own[1:].T.tolist() == [[block - 1, kind] for _, block, kind in events]
        assert np.allclose(final.vector(), vector, rtol=0.0, atol=1e-7)
    alone = [run(model, start, end) for start in starts]
    together = [Runner(model, keep_events=True) for _ in starts]
    for runner, start in zip(together, starts, strict=True):
        runner.begin(start)
        runner.kernel.end = end
    assert run_in_lockstep([runner.kernel for runner in together]) == [Status.COMPLETED] * 3
    for runner, start, (final, own) in zip(together, starts, alone, strict=True):
        first, earlier = run(model, start, 0.2 * end)
        last, later = run(model, first, end)
        for state, changes in ((last, np.concatenate([earlier, later], axis=1)), (runner.final(), runner.events())):
            assert np.array_equal(state.vector(), final.vector())
            assert np.array_equal(np.stack(changes), own)


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("damping", [0.0, 0.01])
def test_groups_and_the_whole_network_agree(tmp_path, loading, damping):
    """Over a time in which rounding errors remain small."""
    model = model_of(network(tmp_path / "springs.txt", 6, damping=damping))
    start = rest(model)
    tables = []
    for groups in (True, False):
        catalogue = Catalogue(model.blocks, 0.0, True, MOST_NUMBERS)
        run(model, start, 80.0, groups=groups, loading=loading, catalogue=catalogue)
        tables.append(catalogue.take())
    assert len(tables[0]["time"]) >= 4
    for name, values in tables[0].items():
        assert np.allclose(values, tables[1][name], rtol=1e-6, atol=1e-7, equal_nan=True), name


@pytest.mark.parametrize("groups", [None, True, False])
@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("cut_off", [np.inf, 3.0])
def test_a_run_in_parts_equals_the_whole_run_to_the_bit(tmp_path, groups, loading, cut_off):
    """Parts end within slips, and before and after the forces are added up anew."""
    model = model_of(network(tmp_path / "springs.txt", 6, cut_off))
    start = rest(model)
    end = 120.0
    whole, events = run(model, start, end, groups=groups, loading=loading)
    assert (events[2] == 0).sum() > 3 * model.blocks
    state, parts = start, []
    for k in range(1, 41):
        state, own = run(model, state, end * k / 40, groups=groups, loading=loading)
        parts.append(own)
    assert np.array_equal(np.concatenate(parts, axis=1), events)
    assert np.array_equal(state.vector(), whole.vector())


def test_a_ring_costs_as_much_on_both_sides_of_the_switch(tmp_path):
    """Many blocks slip together: a sum over all blocks for each of them would take 20 times as long."""
    seconds = []
    for neighbours in (8, 10):
        model = model_of(ring(tmp_path / "springs.txt", 600, neighbours), v=0.05)
        start = rest(model)
        times = []
        for _ in range(2):
            begun = time.process_time()
            _, events = run(model, start, 1.4)
            times.append(time.process_time() - begun)
        assert events.shape[1] > 300
        seconds.append(min(times) / events.shape[1])
    assert seconds[1] < 4.0 * seconds[0]


def test_rounding_does_not_accumulate(tmp_path):
    """After thousands of stops, sums over all springs give the next start."""
    model = model_of(network(tmp_path / "springs.txt", 6), v=0.001)
    state, events = run(model, rest(model), 4000.0, groups=False)
    assert events.shape[1] > 5000
    while not state.stuck.all():
        state, _ = run(model, state, state.time + 0.5, groups=False)
    rate = model.v * model.chain.driving
    left = (model.chain.thresholds * (1.0 - model.law(model.v)) - model.chain.force(state.position)) / rate
    time, block, _ = run(model, state, state.time + 2.0 * left.min(), groups=False)[1][:, 0]
    assert block == np.argmin(left)
    assert abs(time - (state.time + left.min())) * rate.max() < 2e-13


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
def test_exponents_in_groups_and_of_the_whole_network_agree(tmp_path, loading):
    model = model_of(network(tmp_path / "springs.txt", 6))
    growth = []
    for groups in (True, False):
        exponents = Exponents(model.blocks, 3, 0.0, np.array([0.0, 60.0]))
        run(model, rest(model), 60.0, groups=groups, loading=loading, exponents=exponents)
        growth.append(exponents.results()["growth"])
    assert np.allclose(growth[0], growth[1], rtol=1e-5)
    assert growth[0][0, 0] > 1.0
