"""No result depends on τ: every public function gives the same result for a state at any time of its clock."""

from dataclasses import replace

import numpy as np
import pytest

from burridge_knopoff import (
    InitialState,
    Model,
    OrbitError,
    Symmetry,
    event_exponents,
    event_multipliers,
    find_periodic_orbit,
    limit_cycle,
    record_events,
    simulate,
    transverse_exponent,
)
from burridge_knopoff.motion.chain_synchronization import Watch, watch_state
from burridge_knopoff.motion.section_returns import visit
from burridge_knopoff.periodic_orbits.flow import flow, mean_distance
from burridge_knopoff.running.runner import Runner
from tests.refused import refused

#: Times at which the clock starts; sums with them are exact for dyadic steps.
CLOCKS = (-(2.0**20), -1.0, 2.0**13, 2.0**20)

PAPER = Model("linearized", a=0.08)
ROUGH = Model("carlson_langer", a=2.0, blocks=5, coupling=5.0, pulling=1.0, v=0.125)


def settled(model=PAPER):
    run = simulate(model, initial="plus", transient=0.0, window=3000.0, lyapunov_exponents=0)
    return replace(run.final, time=0.0)


def at_rest(model=ROUGH):
    position = (-0.62, -0.65, -0.63, -0.66, -0.64)
    return model.begin(InitialState("rest", position, 0.0), "tested")


def run_of(state, **options):
    run = simulate(PAPER, initial=state, transient=64.0, window=512.0, sampling=4.0, batches=4, events="all", **options)
    shift = state.time
    times = np.concatenate([run.event_time, run.time, run.trajectory_time, run.crossing_time]) - shift
    assert (run.begin_time, run.end_time) == (shift, shift + 576.0)
    return run.status, times, run.distance, run.crossing_velocity, run.lyapunov_exponent, run.lyapunov_error


def events_of(state, **options):
    catalogue = record_events(ROUGH, state, state.time + 512.0, **options)
    return catalogue.status.name, catalogue.time - state.time, catalogue.moment, catalogue.interval, catalogue.blocks


def events_later(state):
    catalogue = record_events(ROUGH, state, state.time + 512.0, begin=state.time + 256.0)
    return catalogue.time - state.time, catalogue.moment, catalogue.interval


def exponent_count(state, loading="quasistatic"):
    exponents = event_exponents(ROUGH, state, state.time + 64.0, count=3, loading=loading)
    return exponents.status.name, exponents.events, exponents.exponent[:2], exponents.error[:2]


def orbit_of(orbit):
    return orbit.period, orbit.symmetry.name, orbit.stop_counts


def watched(state):
    fate = watch_state(Runner(PAPER), state, Watch(time_limit=800.0))
    return fate.outcome.name, fate.mean_distance


CALLS = {
    "simulate": (settled, run_of),
    "simulate by rk4": (settled, lambda state: run_of(state, solver="rk4", step=2.0**-6)[:4]),
    "simulate by map": (settled, lambda state: run_of(state, solver="map")),
    "record_events": (at_rest, events_of),
    "record_events, quasi-static": (at_rest, lambda state: events_of(state, loading="quasistatic")),
    "record_events by rk4": (at_rest, lambda state: events_of(state, solver="rk4", step=2.0**-6)),
    "record_events, some": (at_rest, events_later),
    "event_exponents": (at_rest, exponent_count),
    "event_exponents, steady": (at_rest, lambda state: exponent_count(state, "steady")),
    "event_multipliers": (at_rest, lambda state: np.abs(event_multipliers(ROUGH, state, state.time + 0.25))),
    "limit_cycle": (settled, lambda state: orbit_of(limit_cycle(PAPER, state, window=1000.0))),
    "find_periodic_orbit": (
        lambda: limit_cycle(PAPER, settled()).reference,
        lambda state: orbit_of(find_periodic_orbit(PAPER, state, 157.2451476 / 2, Symmetry.SYMMETRIC)),
    ),
    "transverse_exponent": (settled, lambda state: transverse_exponent(PAPER, state, 64.0, 256.0)),
    "visit": (settled, lambda state: visit(PAPER, state, 64.0, 512.0).returns),
    "watch_state": (settled, watched),
    "flow": (settled, lambda state: np.stack(flow(PAPER, state, 32.0).events())),
    "mean_distance": (settled, lambda state: mean_distance(PAPER, state, 32.0)),
}


@pytest.mark.parametrize("name", CALLS)
def test_results_do_not_depend_on_the_clock(name):
    make, call = CALLS[name]
    state = make()
    expected = call(replace(state, time=0.0))
    for clock in CLOCKS:
        # The clock resolves times to 1e-10 or better.
        _same(call(replace(state, time=clock)), expected)


def _same(actual, expected):
    if isinstance(expected, tuple | list) and not all(isinstance(item, int | float) for item in expected):
        assert len(actual) == len(expected)
        for one, other in zip(actual, expected, strict=True):
            _same(one, other)
    elif isinstance(expected, str):
        assert actual == expected
    else:
        assert np.allclose(actual, expected, rtol=1e-7, atol=1e-9, equal_nan=True)


def test_a_cycle_is_found_from_the_end_of_a_long_run():
    """It was once not found from τ = 8000 on, since the clock of the state was taken for elapsed time."""
    run = simulate(PAPER, initial="plus", transient=0.0, window=9000.0, lyapunov_exponents=0)
    assert limit_cycle(PAPER, run.final).period == pytest.approx(157.2451476, abs=1e-6)
    with refused(f"a = {PAPER.parameter('a'):g}", "no periodic orbit", error=OrbitError):
        limit_cycle(PAPER, run.final, window=1.0)


@pytest.mark.parametrize("clock", [0.0, -1e6])
def test_events_of_a_long_chain_do_not_accumulate_at_any_clock(clock):
    """From a clock below 0 all of them once counted as events of one time unit."""
    model = Model("linearized", a=0.2)
    state = replace(model.begin(InitialState("own", (-0.9, -1.0, -0.95), (0.1, 0.1, 0.1))), time=clock)
    run = simulate(model, initial=state, transient=0.0, window=5000.0, lyapunov_exponents=0)
    assert run.event_count > 3000
    assert run.status == "completed"


@pytest.mark.parametrize("blocks", [3, 30])
@pytest.mark.parametrize("time", [0.0, 100.0])
def test_a_run_that_fails_ends_at_its_last_instant(blocks, time):
    """The clock of its last state was once 0."""
    model = Model("linearized", a=3.0, blocks=blocks, contact="symmetric")
    at = model.begin(InitialState("rough", tuple([5.0, -5.0, 5.0] * (blocks // 3)), 0.0), "tested")
    start = replace(at, time=time)
    ended = simulate(model, initial=start, transient=10.0, window=100.0)
    assert ended.status == "diverged"
    assert time < ended.final.time == ended.end_time < time + 100.0
    # A run in groups diverges if one group does.
    assert time < record_events(model, start, time + 500.0).final.time < time + 100.0
