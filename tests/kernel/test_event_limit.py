"""The limit on events in one unit of time: runs with far more events in all complete, from the start and continued."""

import pickle

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, InitialState, Model, event_exponents, record_events
from burridge_knopoff.kernel._core import Catalogue, EventLog
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS
from tests.refused import refused

LIMIT = "burridge_knopoff.running.runner.EVENTS_PER_BLOCK_AND_UNIT"


def at_rest(model, time=0.0):
    """Return a state of rest below the thresholds, at a time of the loading clock."""
    position = np.random.default_rng(1).uniform(-0.95, -0.6, model.blocks) / model.chain.driving
    rest = np.zeros(model.blocks)
    return ChainState(position - model.sliding_offset, rest, np.ones(model.blocks, dtype=bool), time=time)


def run_until(model, state, end, groups, loading):
    """Return the runner that has run from a state to a time, how it ended, and the times of its slip events."""
    catalogue = Catalogue(model.blocks, -np.inf, False, MOST_NUMBERS)
    runner = Runner(model, groups=groups, loading=loading, catalogue=catalogue)
    runner.begin(state)
    return runner, runner.run(end), catalogue.take()["time"]


def test_a_block_under_quasistatic_loading_has_all_its_events_in_a_continued_run():
    """A run from a final state once ended after 500 events: its unit of time was one of the loading clock."""
    model = Model("carlson_langer", a=0.5, sigma=0.1, blocks=1, v=1e-4)
    start = model.begin(InitialState("rest", (-0.9,), 0.0), "tested")
    whole, first = (record_events(model, start, end, loading="quasistatic") for end in (2e7, 2e6))
    later = record_events(model, first.final, 2e7, loading="quasistatic")
    assert [len(events.time) for events in (whole, first, later)] == [6399, 640, 5759]
    assert {events.status for events in (whole, first, later)} == {Status.COMPLETED}
    # Each slip is the same, and begins when the driver has advanced by its length.
    period = float(np.diff(whole.time).mean())
    assert period * model.v == pytest.approx(whole.moment[1], rel=1e-9)
    assert later.time[-1] == whole.time[-1]


@pytest.mark.parametrize("v", [1e-4, 0.01, 1.0])
def test_the_exponent_of_a_pair_from_a_settled_state(v):
    """−0.1326596 per event by an independent integration; the run from a settled state once ended after 667 events."""
    model = Model("carlson_langer", a=0.0, sigma=0.2, blocks=2, coupling=3.25, pulling=1, threshold=(1.0, 2.25), v=v)
    start = model.begin(InitialState("rest", (-0.5, -0.95), 0.0), "tested")
    settled = record_events(model, start, 1000.0 / v, loading="quasistatic").final
    found = event_exponents(model, settled, 3000.0 / v)
    assert (found.events, found.status) == (6551, Status.COMPLETED)
    assert abs(found.exponent[0] + 0.1326596) < 2.0 * found.error[0] < 2e-3


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("blocks", [1, 23, 24])
@pytest.mark.parametrize(("v", "time"), [(1e-3, 0.0), (0.3, 1e6), (0.02, -1e6)])
def test_far_more_events_than_the_limit(blocks, groups, loading, v, time, monkeypatch):
    """Ten stops and starts of a block in a unit of time are more than any slip makes; the limit is 1000."""
    monkeypatch.setattr(LIMIT, 10)
    chain = Chain(blocks, coupling=2.0, pulling=1.0) if blocks > 1 else Chain(1, pulling=1.0)
    model = Model("carlson_langer", a=0.5, sigma=0.1, chain=chain, v=v)
    start, length = at_rest(model, time), (30.0 if loading == "quasistatic" else 15.0) / v
    runner, status, events = run_until(model, start, time + length, groups, loading)
    assert status == Status.COMPLETED
    assert runner.log.count > 50 * blocks * (v < 0.1 or loading == "quasistatic")
    state, parts = start, []
    for share in (0.1, 0.35, 1.0):
        part, status, times = run_until(model, state, time + share * length, groups, loading)
        assert status == Status.COMPLETED
        # The state that continues a run also does so in another process.
        state = pickle.loads(pickle.dumps(part.final()))
        parts.append(times)
    assert np.array_equal(np.sort(np.concatenate(parts)), np.sort(events))
    assert np.array_equal(part.state().vector(), runner.state().vector())
    assert part.kernel.slip_clock == runner.kernel.slip_clock


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("groups", [True, False])
@pytest.mark.parametrize("blocks", [23, 24])
def test_events_beyond_the_limit_end_a_run(blocks, groups, loading, monkeypatch):
    """Equal blocks start at one instant, under quasi-static loading that at which they have stopped before."""
    model = Model("carlson_langer", a=0.5, blocks=blocks, coupling=2.0, pulling=1.0, v=0.01)
    equal = ChainState(np.full(blocks, -0.6) - model.sliding_offset, np.zeros(blocks), np.ones(blocks, dtype=bool))
    for limit, expected in ((2 * blocks, Status.COMPLETED), (blocks - 1, Status.ACCUMULATING_EVENTS)):

        def limited_log(blocks, states_from, keep, _, *others, limit=limit):
            return EventLog(blocks, states_from, keep, limit, *others)

        monkeypatch.setattr("burridge_knopoff.running.runner.EventLog", limited_log)
        loaded, status, _ = run_until(model, equal, 35.0, groups, loading)
        assert (status, loaded.log.count) == (Status.COMPLETED, 0)
        runner, status, _ = run_until(model, loaded.final(), 60.0, groups, loading)
        assert status == expected
        if expected == Status.COMPLETED:
            assert runner.log.count >= 2 * blocks
        else:
            assert (runner.log.count, runner.clock) == (blocks, pytest.approx(40.0, abs=1e-9))


def test_a_table_that_was_full_is_empty_in_the_next_run(monkeypatch):
    """The flag of a full table once outlived its rows."""
    monkeypatch.setattr("burridge_knopoff.running.runner.MOST_NUMBERS", 3 * 8)
    model = Model("linearized", a=0.3, blocks=1, pulling=1.0, v=0.1)
    runner = Runner(model, keep_events=True, events_from=np.inf)
    runner.begin(at_rest(model))
    with refused("events"):
        runner.run(200.0)
    runner.begin(at_rest(model))
    assert runner.run(20.0) == Status.COMPLETED


@pytest.mark.parametrize("most", [3, 10])
def test_events_that_are_left_out_fill_no_catalogue(most):
    """Only an event that would be stored makes a catalogue full, the first one that finds no room."""
    model = Model("linearized", a=0.3, blocks=1, pulling=1.0, v=0.1)
    time = record_events(model, at_rest(model), 400.0).time
    begin, end = (0.5 * (time[k] + time[k + 1]) for k in (4, 4 + most))
    catalogue = Catalogue(1, begin, False, most)
    runner = Runner(model, catalogue=catalogue)
    runner.begin(at_rest(model))
    assert runner.run(end) == Status.COMPLETED
    assert not catalogue.full
    with refused("catalogue"):
        runner.run(end + 50.0)
    assert len(catalogue.take()["time"]) == most
