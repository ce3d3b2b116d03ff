"""Catalogues of fixed steps converge to the exact one at first order; the closed form gives the exact one."""

import numpy as np
import pytest

from burridge_knopoff import Model
from burridge_knopoff.catalogue.events import record_events
from burridge_knopoff.running.solvers import SOLVERS
from tests.kernel.test_catalogue import at_rest
from tests.refused import refused

MODEL = Model("linearized", a=1.2, blocks=4, coupling=0.2, pulling=1.0, v=0.1)
START = at_rest(MODEL, spread=0.3)
END = 60.0
COLUMNS = ("duration", "epicentre", "blocks", "moment", "largest_slip", "peak_velocity", "energy_released", "interval")
FIXED = [name for name in SOLVERS if SOLVERS[name].has_fixed_step]
STEPS = (1e-3, 3e-4, 1e-4, 3e-5)


def order(errors):
    return np.polyfit(np.log(STEPS), np.log(errors), 1)[0]


@pytest.mark.parametrize("solver", FIXED)
def test_convergence_is_of_first_order_in_the_step(solver):
    """Stops and starts are late by half a step; Euler's method also errs in between."""
    exact = record_events(MODEL, START, END)
    assert exact.blocks.tolist() == [4, 1, 1, 1, 1, 3, 1]
    runs = [record_events(MODEL, START, END, solver=solver, step=step) for step in STEPS]
    for run in runs:
        for name in ("epicentre", "first_block", "last_block", "blocks"):
            assert np.array_equal(getattr(run, name), getattr(exact, name))
    late = [np.abs(run.time - exact.time).max() for run in runs]
    assert order(late) == pytest.approx(1.0, abs=0.2)
    for name in ("moment", "peak_velocity", "stress_drop", "energy_released"):
        errors = [np.abs(getattr(run, name) - getattr(exact, name)).max() for run in runs]
        # A block has no speed where it stops: a delay of h changes its position by h².
        assert order(errors) > 1.4 if SOLVERS[solver].order > 1 else order(errors) == pytest.approx(1.0, abs=0.1), name
        assert errors[-1] < (1e-8 if SOLVERS[solver].order > 1 else 5e-3), name


def test_the_closed_form_has_the_exact_catalogue():
    exact, mapped = (record_events(MODEL, START, END, solver=solver) for solver in ("series", "map"))
    for name in COLUMNS:
        assert np.allclose(getattr(mapped, name), getattr(exact, name), rtol=1e-9, atol=1e-12, equal_nan=True), name


def test_runs_of_fixed_steps_can_be_continued():
    options = {"solver": "rk4", "step": 2.0**-7}
    whole = record_events(MODEL, START, END, **options)
    middle = float(np.floor((whole.time[2] + 0.5 * whole.duration[2]) * 2**7) / 2**7)
    first = record_events(MODEL, START, middle, **options)
    second = record_events(MODEL, first.final, END, **options)
    for name in COLUMNS:
        values = np.concatenate([getattr(first, name), getattr(second, name)])
        assert np.allclose(values, getattr(whole, name), rtol=1e-12, equal_nan=True), name


def test_unknown_solvers_and_steps_are_refused():
    for solver in ("leapfrog", ["rk4"]):
        with refused("solver"):
            record_events(MODEL, START, END, solver=solver)
    for step in (0.0, -1e-3, float("nan"), "1"):
        with refused("step"):
            record_events(MODEL, START, END, solver="euler", step=step)


@pytest.mark.parametrize(("step", "limit"), [(1.0, "0.468"), (1e-30, "2.4e-08")])
def test_steps_that_miss_events_or_never_end(step, limit):
    """Steps of 1 once found 18 of 35 events, in a run that completed."""
    for solver in FIXED:
        with refused(f"step: {step!r}", limit):
            record_events(MODEL, START, END, solver=solver, step=step)
