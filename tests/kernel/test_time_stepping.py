"""rk4 converges to the event-driven solvers: of fourth order without events, of first order with them."""

import numpy as np
import pytest

from burridge_knopoff import InitialState, Model, simulate
from tests.flows import check_events, listed

OPTIONS = {"transient": 0.0, "batches": 2, "events": "all"}


def order(steps, errors):
    return np.polyfit(np.log(steps), np.log(errors), 1)[0]


def test_fourth_order_without_events(law):
    state = InitialState("near", (-0.83, -0.67, -0.84), (0.1, 0.1, 0.1))
    exact = simulate(Model(law, a=0.1), state, window=6.0, **OPTIONS)
    assert exact.event_count == 0
    steps = (0.1, 0.05, 0.025, 0.0125)
    runs = [simulate(Model(law, a=0.1), state, solver="rk4", step=step, window=6.0, **OPTIONS) for step in steps]
    position = [np.abs(run.position[-1] - exact.position[-1]).max() for run in runs]
    assert 3.8 < order(steps, position) < 4.3
    assert order(steps, [abs(run.mean_distance - exact.mean_distance) for run in runs]) > 3.5
    assert position[-1] < 1e-8


@pytest.mark.slow
def test_first_order_with_events(law):
    """Events at step ends are late by half a step on average, whatever the order in between."""
    exact = simulate(Model(law, a=0.08), "minus", window=15.0, **OPTIONS)
    steps = (1e-3, 3e-4, 1e-4, 3e-5, 1e-5)
    runs = [simulate(Model(law, a=0.08), "minus", solver="rk4", step=step, window=15.0, **OPTIONS) for step in steps]
    for run in runs:
        check_events(listed(run), listed(exact), 0.1)
    late = [np.abs(run.event_time - exact.event_time).max() for run in runs]
    assert order(steps, late) == pytest.approx(1.0, abs=0.15)
    assert late[-1] < 1e-4


def test_the_last_step_ends_at_the_end(law):
    run = simulate(Model(law, a=0.08), "minus", solver="rk4", step=0.03, transient=0.1, window=0.1, batches=2)
    assert run.end_time == 0.2
    assert run.step_count == 7


def test_blocks_held_by_friction_at_the_start_stop_at_once(law):
    """They do not stop one step later."""
    state = InitialState("at rest", (-1.8, 0.5, 1.2), (0.0, 0.0, 0.0))
    run = simulate(Model(law, a=0.08), state, solver="rk4", step=0.1, window=0.5, **OPTIONS)
    assert run.event_time.tolist() == [0.0, 0.0]
    assert run.event_block.tolist() == [2, 3]
