"""Properties of whole runs: symmetries, synchronization, energy, and how a run ends."""

import statistics
from dataclasses import replace
from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Chain, InitialState, Model, simulate
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.model.model import CONTACTS
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from tests.flows import SYMMETRIC

EVENT_DRIVEN = [
    (law, name)
    for name in RUN_SOLVERS
    for law in ("linearized", "nonlinear")
    if not SOLVERS[name].has_fixed_step and not (SOLVERS[name].closed_form and law == "nonlinear")
]
each_solver = pytest.mark.parametrize(("law", "solver"), EVENT_DRIVEN)


@each_solver
def test_a_synchronous_state_stays_synchronous(law, solver):
    run = simulate(
        Model(law, a=0.08), "minus", solver=solver, transient=1.8e5, window=2e4, events="none", sampling=100.0
    )
    assert run.status == "completed"
    assert run.distance[run.time >= 1e4].max() < 1e-13
    assert run.distance[0] > 1e-3


@each_solver
@pytest.mark.parametrize("contact", CONTACTS)
def test_mirror_symmetry(law, solver, contact):
    """Numbering the blocks from the other end changes nothing else."""
    state = PAPER_STATES["plus"]
    mirror = InitialState("mirror", state.position[::-1], state.velocity[::-1])
    options = {"solver": solver, "transient": 20.0, "window": 40.0, "events": "all"}
    run, other = (simulate(Model(law, a=0.12, contact=contact), initial, **options) for initial in (state, mirror))
    assert run.event_block.tolist() == (4 - other.event_block).tolist()
    assert np.allclose(run.event_time, other.event_time, rtol=0, atol=1e-11)
    assert run.mean_distance == pytest.approx(other.mean_distance, rel=1e-11)
    assert np.allclose(run.position, other.position[:, ::-1], atol=1e-11)


@given(st.integers(3, 25), st.sampled_from(EVENT_DRIVEN))
def test_time_shift(count, which):
    """A run started from the state at one of its events repeats what comes after it."""
    law, solver = which
    options = {"solver": solver, "events": "all", "transient": 0.0}
    run = simulate(Model(law, a=0.1), "plus", window=60.0, **options)
    # At this stop all other blocks move or clearly stick, so that `tested` decides by the force which blocks stick.
    k = count + int(np.argmax(run.event_kind[count:] == 0))
    time, position, velocity = run.event_time[k], run.event_position[k], run.event_velocity[k]
    later = InitialState("later", tuple(position), tuple(velocity))
    again = simulate(Model(law, a=0.1), later, window=60.0 - time, start="tested", **options)
    if ((velocity > 0.0) != (-Chain(3).stiffness @ position > 1.0)).any():
        return
    expected = run.event_time[run.event_time > time] - time
    assert len(again.event_time) == len(expected)
    assert np.allclose(again.event_time, expected, rtol=0, atol=1e-10)


def test_energy_balance():
    """Kinetic plus spring energy changes by the driver's work minus friction, over a dense trajectory."""
    a, v = 0.2, 0.1
    window = {"transient": 0.0, "window": 40.0, "batches": 2}
    run = simulate(Model("nonlinear", a=a), "plus", trajectory=40.0, trajectory_sampling=1e-3, **window)
    x, u = run.position, run.velocity
    driving = Chain(3).driving
    energy = 0.5 * (u**2 + driving * x**2).sum(axis=1) + 0.5 * (np.diff(x, axis=1) ** 2).sum(axis=1)
    power = -v * (driving * x).sum(axis=1) - (u / (1.0 + a * u)).sum(axis=1)
    work = np.concatenate([[0.0], np.cumsum(0.5e-3 * (power[1:] + power[:-1]))])
    assert np.allclose(energy - energy[0], work, atol=2e-7)


@pytest.mark.parametrize(("law", "a"), [*product(["linearized"], (0.05, 0.2)), *product(["nonlinear"], (0.08, 0.5))])
def test_a_block_exactly_at_its_threshold_starts_stuck(law, a):
    """s = (1, −1, 1) without rounding: `tested` stops all three, whatever Φ(av) rounds to."""
    state = InitialState("threshold", (-0.5, 0.0, -0.5), (0.1, 0.1, 0.1))
    # The text is joined, since a text from a config is a different object from that in the code.
    start = "".join(["tes", "ted"])
    run = simulate(
        Model(law, a=a), state, start=start, transient=0.0, window=5.0, trajectory=5.0, trajectory_sampling=5.0
    )
    assert run.velocity[0].tolist() == [0.0, 0.0, 0.0]
    assert run.position[-1, 0] == pytest.approx(run.position[-1, 2], abs=1e-12)


@each_solver
@pytest.mark.parametrize("a", [0.2, 0.21, 0.234])
def test_an_exactly_symmetric_state_stays_symmetric(law, solver, a):
    """Synchrony is unstable there, but its mirror symmetry is exact: no rounding may break it."""
    assert simulate(Model(law, a=a), SYMMETRIC, solver=solver, events="none").distance.max() == 0.0


@pytest.mark.parametrize(("window", "batches", "sampling"), [(0.7, 3, 0.7), (0.3, 2, 0.1), (14.7, 6, 4.9)])
def test_the_last_samples_are_stored_despite_rounding(window, batches, sampling):
    sampled = {"sampling": sampling, "trajectory": window, "trajectory_sampling": window / 2}
    run = simulate(Model("linearized", a=0.08), transient=0.0, window=window, batches=batches, **sampled)
    assert run.status == "completed"
    assert run.end_time == window
    assert np.isfinite(run.distance).all()
    assert np.isfinite(run.position).all()


def test_least_friction_in_the_window_is_not_that_of_the_transient():
    """A block with a high initial speed slows down before the window begins; friction is least at the highest speed."""
    state = InitialState("thrown", (0.0, 0.0, 0.0), (3.0, 0.1, 0.1))
    run = simulate(
        Model("nonlinear", a=0.2), state, transient=50.0, window=50.0, trajectory=50.0, trajectory_sampling=1e-3
    )
    assert run.least_friction == pytest.approx(1.0 / 1.6)
    assert run.window_least_friction == pytest.approx(1.0 / (1.0 + 0.2 * run.velocity.max()), abs=1e-6)
    assert run.window_least_friction > run.least_friction + 0.05


def test_without_sticks_there_are_no_events():
    run = simulate(
        Model("linearized", a=0.0), InitialState("uniform", (-5 / 6, -2 / 3, -5 / 6), (0.1,) * 3), window=100.0
    )
    assert run.event_count == 0
    assert run.mean_distance < 1e-13
    assert np.isnan(run.least_spring_force)


@pytest.mark.parametrize(("limit", "value"), [("EVENTS_PER_BLOCK_AND_UNIT", 0), ("STEP_LIMIT", 10)])
def test_a_limit_ends_the_run(monkeypatch, limit, value):
    """More events in one time unit, or more steps, than the limit give a status, and averages of NaN."""
    monkeypatch.setattr(f"burridge_knopoff.running.runner.{limit}", value)
    run = simulate(Model("linearized", a=0.08), "minus", transient=0.0, window=50.0, events="all")
    assert run.status == ("step_limit" if value else "accumulating_events")
    assert run.step_count == 10 or not value
    assert np.isnan(run.mean_distance)
    assert run.end_time < 50.0


@pytest.mark.parametrize("solver", RUN_SOLVERS)
def test_motion_without_bound_ends_the_run(solver):
    """Backward slip under the linearized law grows without limit: friction 1 − a|U'| becomes negative."""
    run = simulate(Model("linearized", a=1.9, contact="symmetric"), "minus", solver=solver, transient=0.0, window=1e4)
    assert run.status == "diverged"
    assert run.end_time < 1000.0
    assert np.isnan(run.mean_distance)


def test_states_of_events_are_stored_in_the_window_only():
    run = simulate(Model("linearized", a=0.08), "plus", transient=40.0, window=20.0, event_window=1e3)
    assert run.earlier_event_time.max() < 40.0 <= run.event_time.min()


def test_the_error_of_the_mean_is_that_of_independent_batches():
    run = simulate(Model("nonlinear", a=0.26), "minus", transient=50.0, window=300.0, batches=3)
    batch = run.batch_mean_distance.tolist()
    assert run.mean_distance_error == pytest.approx(statistics.stdev(batch) / 3**0.5, rel=1e-12)


def test_perturbations_align_no_longer_than_the_transient_lasts():
    """A longer alignment starts at the beginning of the run, with the same exponents and errors."""
    one, other = (
        simulate(Model("linearized", a=0.06), "plus", transient=100.0, window=700.0, lyapunov_alignment=alignment)
        for alignment in (100.0, 1e4)
    )
    assert one.lyapunov_exponent.tolist() == other.lyapunov_exponent.tolist()
    assert one.lyapunov_error.tolist() == other.lyapunov_error.tolist()


@pytest.mark.parametrize(
    ("law", "a", "initial"), [("linearized", 0.05, "plus"), ("linearized", 0.01, "minus"), ("nonlinear", 0.025, "plus")]
)
def test_exponents_are_in_descending_order_with_their_errors_and_batches(law, a, initial):
    """On tori, and in synchrony, two exponents differ by less than their errors."""
    run = simulate(Model(law, a=a), initial)
    assert (np.diff(run.lyapunov_exponent) <= 0.0).all()
    batch = run.batch_lyapunov_exponent
    assert batch.mean(axis=0) == pytest.approx(run.lyapunov_exponent, abs=5e-6)
    scatter = batch.std(axis=0, ddof=1) / np.sqrt(len(batch))
    resolution = np.sqrt(run.lyapunov_error**2 - scatter**2)
    assert resolution == pytest.approx(np.full(3, resolution[0]))


@pytest.mark.parametrize(("law", "solver"), [("linearized", "series"), ("linearized", "map"), ("nonlinear", "series")])
@pytest.mark.parametrize("time", [37.0, 50.0, 61.3])
def test_a_continued_run_equals_the_whole_run(law, solver, time):
    """A run that is split between events, within a piece, has the events and crossings of the whole run, to the bit."""
    settings = {"solver": solver, "transient": 0, "events": "all", "batches": 2}
    whole = simulate(Model(law, a=0.08), "plus", window=120.0, **settings)
    first = simulate(Model(law, a=0.08), "plus", window=time, **settings)
    rest = simulate(first.model, initial=first.final, window=120.0 - time, **settings)
    assert (first.final.time, rest.begin_time, rest.end_time) == (time, time, 120.0)
    for name in ("event_time", "event_block", "event_kind", "event_position", "event_velocity", "crossing_time"):
        assert np.array_equal(np.concatenate([getattr(first, name), getattr(rest, name)]), getattr(whole, name)), name
    for name in ("crossing_velocity", "crossing_direction"):
        assert np.array_equal(np.concatenate([getattr(first, name), getattr(rest, name)]), getattr(whole, name)), name
    assert np.array_equal(rest.final.vector(), whole.final.vector())


def test_a_run_continues_step_by_step_with_a_fixed_step():
    settings = {"solver": "rk4", "step": 2.0**-8, "transient": 0, "events": "all", "batches": 2}
    whole = simulate(Model("nonlinear", a=0.08), "plus", window=40.0, **settings)
    first = simulate(Model("nonlinear", a=0.08), "plus", window=15.0, **settings)
    rest = simulate(first.model, initial=first.final, window=25.0, **settings)
    assert first.event_count + rest.event_count == whole.event_count > 0
    assert np.array_equal(rest.final.vector(), whole.final.vector())


def test_a_run_under_another_law_starts_at_the_given_state():
    """The step in which the first run ended is repeated only with the same model."""
    first = simulate(Model("linearized", a=0.08), "plus", transient=0, window=37.0)
    other = first.model.at(a=0.2)
    bare = replace(first.final)
    from_final, from_bare = (simulate(other, initial=at, transient=0, window=20.0) for at in (first.final, bare))
    assert np.array_equal(from_final.final.vector(), from_bare.final.vector())
    assert from_final.begin_time == 37.0


@pytest.mark.parametrize("start", ["moving", "tested"])
def test_slips_include_those_in_progress_at_the_beginning(start):
    """Each stop ends a slip, including slips in progress at the beginning."""
    state = {"position": [-0.9, -1.1, 0.5], "velocity": [0.1, 0.1, 0.1]}
    run = simulate(Model("nonlinear", a=0.1), state, start=start, transient=0, window=50.0, events="all")
    force = run.model.chain.force(np.array(state["position"]))
    assert run.initially_slipping.tolist() == ((force > 1.0) | (start == "moving")).tolist()
    for block in (1, 2, 3):
        kinds = run.event_kind[run.event_block == block]
        slips = run.initially_slipping[block - 1] + (kinds == 1).sum()
        assert slips - (kinds == 0).sum() in (0, 1)
        # Stops and starts alternate, and the first is a stop if and only if the block slips at the beginning.
        assert not len(kinds) or kinds[0] == 1 - run.initially_slipping[block - 1]
        assert (kinds[1:] != kinds[:-1]).all()
