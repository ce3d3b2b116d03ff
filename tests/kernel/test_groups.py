"""Long chains, in which blocks that slip together move in separate groups, have the events of the chain as a whole."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner, new_observer
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.status import Status
from tests.flows import check_events

LAWS = {"linearized": 0.3, "nonlinear": 3.0, "carlson_langer": 5.0, "exponential": 2.0}
#: Weakening of blocks of which few strengthen.
MIXED = {"random": "uniform", "low": -0.01, "high": 1.5, "seed": 1}


def at_rest(model, seed, spread=0.3):
    """Return a state in which all blocks stick, a little out of line."""
    generator = np.random.default_rng(seed)
    position = generator.uniform(-0.9 - spread, -0.9, model.blocks) / model.chain.driving - model.sliding_offset
    return ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))


def events(model, start, end, groups):
    runner = Runner(model, keep_events=True, groups=groups)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    time, block, kind = runner.events()
    return runner, list(zip(time.tolist(), (block + 1).tolist(), kind.tolist(), strict=True))


@given(
    st.integers(1, 40),
    st.sampled_from(list(LAWS)),
    st.sampled_from(CONTACTS),
    st.sampled_from(["open", "ring"]),
    st.floats(0.2, 30.0),
    st.floats(0.003, 0.3),
    st.sampled_from([(0.0, 0.0), (0.5, 0.0), (0.0, 0.2), (2.0, 0.1)]),
    st.integers(0, 10_000),
)
@settings(max_examples=100)
def test_events_are_those_of_the_chain_as_a_whole(blocks, law, contact, ends, coupling, v, dashpots, seed):
    dashpots = dict(zip(("damping", "pulling_damping"), dashpots, strict=True))
    options = {"ends": ends if blocks > 1 else "open", "weakening": MIXED if seed % 2 else 1.0, **dashpots}
    chain = Chain(blocks, coupling=coupling, pulling=1.0, **options)
    model = Model(law, a=LAWS[law], chain=chain, v=v, contact=contact)
    start = at_rest(model, seed)
    # Chaos sets in with the first slips that reach far.
    end = 0.6 / v + 2.0
    (grouped, many), (single, whole) = (events(model, start, end, groups) for groups in (True, False))
    assert grouped.kernel.local
    assert not single.kernel.local
    count = min(len(many), len(whole), 12)
    check_events(many[:count], whole[:count], 1e-9 / v)
    if len(many) == len(whole) <= 12:
        assert np.allclose(grouped.state().vector(), single.state().vector(), rtol=0.0, atol=1e-8)


def test_a_mirrored_chain_moves_as_its_mirror_image():
    model = Model("nonlinear", a=3.0, blocks=60, coupling=30.0, pulling=1.0, v=0.01)
    start = at_rest(model, 3)
    events_straight, events_mirrored = (events(model, state, 80.0, True)[1] for state in (start, start.mirrored()))
    assert len(events_straight) > 300
    mirrored = sorted((time, 61 - block, kind) for time, block, kind in events_mirrored)
    assert sorted(events_straight) == mirrored


@pytest.mark.parametrize("section", [SUM, Section("block", 17)])
def test_observables_are_those_of_the_chain_as_a_whole(section):
    """⟨J⟩, samples, section crossings, states and extremes, in a window that begins during the motion."""
    model = Model("nonlinear", a=0.2, blocks=40, coupling=4.0, pulling=1.0, v=0.1)
    start = at_rest(model, 5)
    results = []
    for groups in (True, False):
        edges, times = np.linspace(8.0, 24.0, 5), np.linspace(0.0, 24.0, 97)
        observer = new_observer(model, edges, times, times[60:], section=section)
        runner = Runner(model, observer=observer, groups=groups)
        runner.begin(start)
        assert runner.run() == Status.COMPLETED
        results.append(observer.results())
    for name, values in results[0].items():
        assert np.shape(values) == np.shape(results[1][name]), name
        assert np.allclose(values, results[1][name], rtol=0.0, atol=1e-7), name
    assert len(results[0]["crossing_time"]) >= 1


def test_a_continued_run_has_the_events_of_the_whole_run_to_the_bit():
    model = Model("nonlinear", a=3.0, blocks=50, coupling=20.0, pulling=1.0, v=0.02)
    start = at_rest(model, 7)
    whole = events(model, start, 60.0, True)[1]
    first, earlier = events(model, start, 33.3, True)
    later = events(model, first.final(), 60.0, True)[1]
    assert earlier + later == whole
    assert len(later) > 100


@pytest.mark.slow
def test_a_hundred_thousand_blocks():
    """An event costs no more than in a short chain, however many blocks stick."""
    model = Model("carlson_langer", a=5.0, blocks=100_000, coupling=100.0, pulling=1.0, v=0.001)
    runner = Runner(model)
    runner.begin(at_rest(model, 1, 0.001))
    assert runner.run(50.0) == Status.COMPLETED
    assert runner.log.count > 10_000
    # An event makes one piece or two, never one for each block.
    assert runner.kernel.steps < 10 * runner.log.count
