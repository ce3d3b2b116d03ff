"""Continued runs equal the whole run: to the bit with the same division into groups, otherwise to rounding."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.catalogue.events import record_events
from burridge_knopoff.catalogue.stability import event_exponents, event_multipliers
from burridge_knopoff.kernel._core import Catalogue, Exponents
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.runner import Runner, new_observer
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run as simulation
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS
from tests.refused import refused

LAWS = {"linearized": 0.3, "nonlinear": 3.0, "exponential": 0.3, "carlson_langer": 5.0}
#: A law that is steep enough to let one block slip at a time, and drops at the start, as quasi-static loading needs.
DROP = "carlson_langer"


@st.composite
def symmetric_cases(draw, loadings=("steady", "quasistatic")):
    """A model, a state of rest that is its own mirror image, the order of the blocks in it, loading and an end."""
    loading = draw(st.sampled_from(loadings))
    law = DROP if loading == "quasistatic" else draw(st.sampled_from(list(LAWS)))
    form = draw(st.sampled_from(["open", "ring", "grid"]))
    springs = {"coupling": 10.0 ** draw(st.floats(-0.5, 1.5)), "pulling": 1.0}
    springs |= {name: draw(st.sampled_from([0.0, 0.0, 0.4])) for name in ("damping", "pulling_damping")}
    if form == "grid":
        columns, rows = draw(st.integers(2, 10)), draw(st.integers(2, 6))
        chain = Chain(grid=(columns, rows), **springs)
        image = np.arange(columns * rows).reshape(rows, columns)[:, ::-1].ravel()
    else:
        chain = Chain(draw(st.integers(3, 60)), ends=form, **springs)
        image = np.arange(chain.blocks)[::-1]
    model = Model(
        law, a=LAWS[law], chain=chain, v=10.0 ** draw(st.floats(-2.0, -0.7)), contact=draw(st.sampled_from(CONTACTS))
    )
    generator = np.random.default_rng(draw(st.integers(0, 2**32 - 1)))
    drawn = generator.uniform(-1.2, -0.9, model.blocks) / model.chain.driving - model.sliding_offset
    position = drawn[np.minimum(np.arange(model.blocks), image)]
    start = ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))
    end = 3.0 / model.v if loading == "quasistatic" else 0.6 / model.v + 10.0
    return model, start, image, loading, end


def follow_run(model, start, end, groups, loading):
    """Return the runner at a time, the events and, under steady loading, the section crossings until then."""
    observer = new_observer(model, [start.time, end]) if loading == "steady" else None
    runner = Runner(model, keep_events=True, groups=groups, loading=loading, observer=observer)
    runner.begin(start)
    assert runner.run(end) == Status.COMPLETED
    crossings = observer.results() if observer else {"crossing_time": np.zeros(0), "crossing": np.zeros((0, 2))}
    return runner, (np.stack(runner.events()), np.column_stack([crossings["crossing_time"], crossings["crossing"]]))


@settings(max_examples=150)
@given(symmetric_cases(), st.sampled_from([None, True, False]))
def test_a_state_that_is_its_own_mirror_image_stays_so(case, groups):
    model, start, image, loading, end = case
    state = follow_run(model, start, end, groups, loading)[0].state()
    assert np.array_equal(state.position, state.position[image])
    assert np.array_equal(state.velocity, state.velocity[image])


def test_24_blocks_synchronize_exactly():
    """⟨J⟩ was once 0.0104, and exactly 0 for 23 blocks: mirror images were processed one after the other."""
    for blocks in (23, 24):
        model = Model("exponential", a=0.3, blocks=blocks, coupling=2.0, pulling=1.0, v=0.01)
        half = np.random.default_rng(1).uniform(-0.9, -0.5, (blocks + 1) // 2)
        position = np.concatenate([half, half[: blocks // 2][::-1]]) - model.sliding_offset
        start = ChainState(position, np.zeros(blocks), np.ones(blocks, dtype=bool))
        run = simulation(model, start, Settings(transient=0.0, window=2000.0, lyapunov_exponents=0))
        assert run.event_count > 10_000
        assert run.mean_distance == 0.0


@settings(max_examples=100)
@given(symmetric_cases(), st.sampled_from([None, True, False]), st.lists(st.floats(0.02, 0.98), min_size=1, max_size=3))
def test_a_run_in_parts_equals_the_whole_run_to_the_bit(case, groups, cuts):
    model, start, _, loading, end = case
    runner, whole = follow_run(model, start, end, groups, loading)
    state, legs = start, []
    for time in sorted(end * cut for cut in cuts):
        part, rows = follow_run(model, state, time, groups, loading)
        state = part.final()
        legs.append(rows)
    part, rows = follow_run(model, state, end, groups, loading)
    legs.append(rows)
    assert np.array_equal(part.state().vector(), runner.state().vector())
    for expected, parts in zip(whole, zip(*legs, strict=True), strict=True):
        axis = 1 if expected is whole[0] else 0
        assert np.array_equal(np.concatenate(parts, axis=axis), expected)


@pytest.mark.parametrize("groups", [True, False])
def test_runs_of_length_zero_change_nothing(groups):
    """They once changed a bit of a crossing."""
    model = Model("linearized", a=0.3, chain=Chain(3, 1.1, 1.0, ends="ring"), v=0.03)
    for seed in range(40):
        position = np.random.default_rng(seed).uniform(-1.2, -0.9, 3) - model.sliding_offset
        start = ChainState(position, np.zeros(3), np.ones(3, dtype=bool))
        whole = follow_run(model, start, 30.0, groups, "steady")[1]
        state, legs = start, []
        for time in (1.6, 1.6, 1.6, 30.0):
            part, rows = follow_run(model, state, time, groups, "steady")
            state = part.final()
            legs.append(rows)
        for axis, (expected, parts) in zip((1, 0), zip(whole, zip(*legs, strict=True), strict=True), strict=True):
            assert np.array_equal(np.concatenate(parts, axis=axis), expected)


def test_a_run_may_be_divided_within_its_first_piece():
    """At this point the side of the section is still unknown."""
    model = Model("linearized", a=0.3, chain=Chain(3, 1.78, 1.0), v=0.056)
    for seed in range(130):
        ends, middle = np.random.default_rng(seed).uniform(-1.2, -0.9, 2)
        position = np.array([ends, middle, ends]) - model.sliding_offset
        start = ChainState(position, np.zeros(3), np.ones(3, dtype=bool))
        crossings = follow_run(model, start, 5.0, None, "steady")[1][1]
        first, before = follow_run(model, start, 0.484, None, "steady")
        after = follow_run(model, first.final(), 5.0, None, "steady")[1][1]
        assert np.array_equal(np.concatenate([before[1], after]), crossings)


WAYS = ("whole", "groups", "exponents", "catalogue", "any")


def leg(model, state, end, way, loading):
    """Move a state to a time in one of the modes, and return the state there."""
    blocks = model.blocks
    options = {
        "whole": {"groups": False},
        "groups": {"groups": True},
        "any": {},
        "exponents": {"exponents": Exponents(blocks, 2, state.time, np.array([state.time, end]))},
        "catalogue": {"catalogue": Catalogue(blocks, state.time, True, MOST_NUMBERS)},
    }[way]
    runner = Runner(model, loading=loading, **options)
    runner.begin(state)
    assert runner.run(end) == Status.COMPLETED
    return runner.final()


def ends_after(model, start, loading):
    """Return a time, some 60 stops and starts later, at which no slip is in progress and rounding errors are small."""
    if loading == "steady":
        return start.time + 8.0
    events = record_events(model, start, start.time + 20.0, loading=loading)
    last = max(1, int(np.searchsorted(np.cumsum(2 * events.blocks), 60)))
    return 0.5 * (events.time[last - 1] + events.time[last])


@settings(max_examples=100)
@given(
    st.integers(2, 40),
    st.sampled_from(["steady", "quasistatic"]),
    st.integers(0, 2**32 - 1),
    st.lists(st.tuples(st.sampled_from(WAYS), st.floats(0.05, 1.0)), min_size=2, max_size=6),
)
def test_a_state_can_be_continued_in_any_mode(blocks, loading, seed, legs):
    """The mode changes and changes back, over a time in which rounding errors remain small."""
    law = DROP if loading == "quasistatic" else "nonlinear"
    model = Model(law, a=1.0, blocks=blocks, coupling=3.0, pulling=1.0, v=0.05)
    position = np.random.default_rng(seed).uniform(-1.1, -0.7, blocks) / model.chain.driving - model.sliding_offset
    start = state = ChainState(position, np.zeros(blocks), np.ones(blocks, dtype=bool), time=-3.0)
    duration = (ends_after(model, start, loading) - start.time) / sum(share for _, share in legs)
    for way, share in legs:
        state = leg(model, state, state.time + share * duration, way, loading)
    whole = leg(model, start, state.time, "whole", loading)
    assert np.allclose(state.vector(), whole.vector(), rtol=0.0, atol=1e-8)
    assert np.array_equal(state.stuck, whole.stuck)


def test_slip_events_can_be_continued_in_any_mode():
    """An event in progress when the mode changes keeps its slips."""
    model = Model(DROP, a=2.0, blocks=30, coupling=5.0, pulling=1.0, v=0.02)
    position = np.random.default_rng(2).uniform(-0.95, -0.6, 30) - model.sliding_offset
    start = ChainState(position, np.zeros(30), np.ones(30, dtype=bool))
    tables = []
    for ways in ((False, False), (False, True), (True, False), (True, True)):
        state, rows = start, []
        for end, groups in zip((15.0, 20.0), ways, strict=True):
            catalogue = Catalogue(30, 0.0, True, MOST_NUMBERS)
            runner = Runner(model, groups=groups, catalogue=catalogue)
            runner.begin(state)
            assert runner.run(end) == Status.COMPLETED
            state = runner.final()
            assert end == 20.0 or not state.stuck.all()
            table = catalogue.take()
            rows.append(np.array([table[name] for name in ("time", "moment", "energy_released", "peak_velocity")]))
        tables.append(np.concatenate(rows, axis=1))
        tables[-1] = tables[-1][:, np.argsort(tables[-1][0])]
    assert tables[0].shape[1] > 10
    for table in tables[1:]:
        assert np.allclose(table, tables[0], rtol=1e-9, atol=1e-9)


@pytest.mark.slow
def test_the_end_of_a_catalogue_is_accepted_wherever_a_state_is():
    """Each of these once ended in a segmentation fault from 24 blocks on."""
    model = Model(DROP, a=1.0, blocks=30, coupling=3.0, pulling=1.0, v=0.05)
    position = np.random.default_rng(3).uniform(-1.0, -0.7, 30) - model.sliding_offset
    start = ChainState(position, np.zeros(30), np.ones(30, dtype=bool))
    for loading in ("steady", "quasistatic"):
        final = record_events(model, start, 200.0, loading=loading).final
        exponents = Settings(transient=0.0, window=20.0, lyapunov_exponents=2)
        assert simulation(model, final, exponents).status == "completed"
        assert event_exponents(model, final, 400.0, count=2, loading=loading).status == Status.COMPLETED
        if loading == "quasistatic":
            values = event_multipliers(model, final, 200.2, loading=loading)
            assert abs(values[-1]) < 1e-9 * abs(values[0]) < 1e3
            with refused("end: 400.0"):
                event_multipliers(model, final, 400.0, loading=loading)
