"""Catalogues as arrays: the profiles, and runs that continue earlier ones."""

import numpy as np
import pytest

from burridge_knopoff import ChainState, Model
from burridge_knopoff.catalogue.events import record_events
from tests.kernel.test_catalogue import at_rest
from tests.refused import refused

MODEL = Model("carlson_langer", a=2.0, blocks=30, coupling=20.0, pulling=1.0, v=0.01)


def test_profiles_add_up_to_moments():
    events = record_events(MODEL, at_rest(MODEL), 200.0, profiles=True)
    assert len(events.time) > 50
    assert (np.diff(events.time) >= 0.0).all()
    parts = np.split(events.slip, events.slip_end[:-1])
    assert np.allclose([part.sum() for part in parts], events.moment, rtol=1e-13)
    assert [len(part) for part in parts] == events.blocks.tolist()
    assert [part.max() for part in parts] == events.largest_slip.tolist()
    assert len(record_events(MODEL, at_rest(MODEL), 200.0).slip) == 0


def test_events_before_the_beginning_are_excluded():
    whole, late = (record_events(MODEL, at_rest(MODEL), 200.0, begin=begin) for begin in (0.0, 100.0))
    assert np.array_equal(late.time, whole.time[whole.time >= 100.0])
    assert np.array_equal(late.interval, whole.interval[whole.time >= 100.0], equal_nan=True)


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("blocks", [5, 23, 24])
def test_consecutive_runs_have_the_catalogue_of_the_whole_run(blocks, loading):
    model = Model("carlson_langer", a=2.0, blocks=blocks, coupling=20.0, pulling=1.0, v=0.01)
    whole = record_events(model, at_rest(model), 300.0, profiles=True, loading=loading)
    parts, at = [], at_rest(model)
    # Under steady loading the first run ends within an event.
    for end in (float(whole.time[10] + 0.3 * whole.duration[10]), 177.7, 300.0):
        parts.append(record_events(model, at, end, profiles=True, loading=loading))
        at = parts[-1].final
    time = np.concatenate([part.time for part in parts])
    order = np.argsort(time, kind="stable")
    assert np.array_equal(time[order], whole.time)
    for name in ("duration", "epicentre", "moment", "peak_velocity", "energy_released", "interval"):
        values = np.concatenate([getattr(part, name) for part in parts])[order]
        assert np.allclose(values, getattr(whole, name), rtol=1e-12, atol=1e-15, equal_nan=True), name
    for name in ("slip_block", "slip", "slip_onset"):
        profiles = [column for part in parts for column in np.split(getattr(part, name), part.slip_end[:-1])]
        assert np.array_equal(np.concatenate([profiles[k] for k in order]), getattr(whole, name)), name


@pytest.mark.parametrize("ends", ["open", "ring"])
def test_ends_and_intervals(ends):
    """Events cover all blocks between their ends, also across the seam of a ring; intervals are those of the blocks."""
    model = Model("carlson_langer", a=3.0, blocks=30, coupling=9.0, pulling=1.0, ends=ends, v=0.01)
    events = record_events(model, at_rest(model), 1500.0, profiles=True)
    first, last = events.first_block, events.last_block
    blocks = [set(part.tolist()) for part in np.split(events.slip_block, events.slip_end[:-1])]
    for part, low, high in zip(blocks, first, last, strict=True):
        assert part == {(k - 1) % 30 + 1 for k in range(low, high + 1 + 30 * (low > high))}
    assert (first > last).any() == (ends == "ring")
    assert not (events.interval <= 0.0).any()
    stop, count = events.time + events.duration, 0
    for k, epicentre in enumerate(events.epicentre):
        before = [j for j in range(k) if epicentre in blocks[j]]
        # An event that has not ended, or that outlasted a later one, may have reached the block after it.
        if before and np.argmax(stop[before]) == len(before) - 1 and stop[before[-1]] < events.time[k]:
            count += 1
            assert events.interval[k] == pytest.approx(events.time[k] - events.time[before[-1]], rel=1e-12)
    assert count > 0.7 * len(events.time)


def test_the_largest_slip_may_be_backward():
    """A block ahead of the driver slips back."""
    model = Model("nonlinear", a=0.3, blocks=1, pulling=1.0, v=0.1, contact="symmetric")
    ahead = ChainState(1.5 - model.sliding_offset, np.zeros(1), np.ones(1, dtype=bool))
    events = record_events(model, ahead, 5.0)
    assert events.moment[0] < -0.5
    assert events.largest_slip[0] == -events.moment[0]


def test_empty_windows_are_refused():
    start = record_events(MODEL, at_rest(MODEL), 50.0).final
    for end in (-5.0, 50.0):
        with refused(f"end: {end}"):
            record_events(MODEL, start, end)
    for begin in (60.0, 70.0):
        with refused("end: 60.0"):
            record_events(MODEL, start, 60.0, begin=begin)


def test_all_events_count_unless_a_beginning_is_given():
    """Nothing depends on where the clock starts, also if it starts below 0."""
    start = at_rest(MODEL)
    early = ChainState(start.position, start.velocity, start.stuck, -1000.0)
    events, shifted = record_events(MODEL, start, 200.0), record_events(MODEL, early, -800.0)
    assert len(shifted.time) > 100
    # Before chaos amplifies the rounding of the clock.
    assert np.allclose(shifted.time[:20] + 1000.0, events.time[:20], rtol=0.0, atol=1e-9)
