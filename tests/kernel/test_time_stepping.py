"""Fixed steps converge to the event-driven solvers: of their own order without events, of first order with them."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, simulate
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from tests.flows import check_events, listed

FIXED = [name for name in RUN_SOLVERS if SOLVERS[name].has_fixed_step]
OPTIONS = {"transient": 0.0, "batches": 2, "events": "all"}


def order(steps, errors):
    return np.polyfit(np.log(steps), np.log(errors), 1)[0]


@pytest.mark.parametrize("solver", FIXED)
def test_the_order_without_events(law, solver):
    state = InitialState("near", (-0.83, -0.67, -0.84), (0.1, 0.1, 0.1))
    exact = simulate(Model(law, a=0.1), state, window=6.0, **OPTIONS)
    assert exact.event_count == 0
    steps = (0.1, 0.05, 0.025, 0.0125)
    runs = [simulate(Model(law, a=0.1), state, solver=solver, step=step, window=6.0, **OPTIONS) for step in steps]
    position = [np.abs(run.position[-1] - exact.position[-1]).max() for run in runs]
    expected = SOLVERS[solver].order
    assert expected - 0.2 < order(steps, position) < expected + 0.3
    assert order(steps, [abs(run.mean_distance - exact.mean_distance) for run in runs]) > expected - 0.5
    assert position[-1] < 1e-8


@pytest.mark.slow
@pytest.mark.parametrize("solver", FIXED)
def test_first_order_with_events(law, solver):
    """Events at step ends are late by half a step on average, whatever the order in between."""
    exact = simulate(Model(law, a=0.08), "minus", window=15.0, **OPTIONS)
    steps = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
    runs = [simulate(Model(law, a=0.08), "minus", solver=solver, step=step, window=15.0, **OPTIONS) for step in steps]
    for run in runs:
        check_events(listed(run), listed(exact), 0.1)
    late = [np.abs(run.event_time - exact.event_time).max() for run in runs]
    assert order(steps, late) == pytest.approx(1.0, abs=0.15)
    assert late[-1] < 1e-4


@pytest.mark.parametrize("solver", FIXED)
def test_the_last_step_ends_at_the_end(law, solver):
    run = simulate(Model(law, a=0.08), "minus", solver=solver, step=0.03, transient=0.1, window=0.1, batches=2)
    assert run.end_time == 0.2
    assert run.step_count == 7


@pytest.mark.parametrize("solver", FIXED)
def test_blocks_held_by_friction_at_the_start_stop_at_once(law, solver):
    """They do not stop one step later."""
    state = InitialState("at rest", (-1.8, 0.5, 1.2), (0.0, 0.0, 0.0))
    run = simulate(Model(law, a=0.08), state, solver=solver, step=0.1, window=0.5, **OPTIONS)
    assert run.event_time.tolist() == [0.0, 0.0]
    assert run.event_block.tolist() == [2, 3]
