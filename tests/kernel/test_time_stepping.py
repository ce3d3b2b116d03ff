"""rk4 converges to the event-driven solvers: of fourth order without events, of first order with them."""

import numpy as np
import pytest

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.running.simulation import simulate

STEPS = (0.1, 0.05, 0.025, 0.0125)


def slope(errors):
    return np.polyfit(np.log(STEPS[: len(errors)]), np.log(errors), 1)[0]


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_fourth_order_without_events(law):
    state = InitialState("near", (-0.83, -0.67, -0.84), (0.1, 0.1, 0.1))
    options = {"transient": 0.0, "window": 6.0, "batches": 2, "events": "all"}
    exact = simulate(law, 0.1, state, **options)
    assert exact.event_count == 0
    runs = [simulate(law, 0.1, state, solver="rk4", step=step, **options) for step in STEPS]
    position = [np.abs(run.position[-1] - exact.position[-1]).max() for run in runs]
    mean = [abs(run.mean_distance - exact.mean_distance) for run in runs]
    assert 3.8 < slope(position) < 4.3
    assert slope(mean) > 3.5
    assert position[-1] < 1e-8


@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
def test_first_order_with_events(law):
    """Events at step ends are late by half a step on average, whatever the order in between."""
    options = {"transient": 0.0, "window": 15.0, "batches": 2, "events": "all"}
    exact = simulate(law, 0.08, "minus", **options)
    steps = np.array([1e-3, 3e-4, 1e-4, 3e-5, 1e-5])
    late = []
    for step in steps:
        run = simulate(law, 0.08, "minus", solver="rk4", step=float(step), **options)
        assert run.event_block.tolist() == exact.event_block.tolist()
        late.append(np.abs(run.event_time - exact.event_time).max())
    assert np.polyfit(np.log(steps), np.log(late), 1)[0] == pytest.approx(1.0, abs=0.15)
    assert late[-1] < 1e-4


def test_the_last_step_ends_at_the_end():
    run = simulate("linearized", 0.08, "minus", solver="rk4", step=0.3, transient=1.0, window=1.0, batches=2)
    assert run.end_time == 2.0
    assert run.step_count == 7
