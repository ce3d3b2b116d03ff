"""Initial states: those that cannot occur in a motion are refused, those that the program makes are accepted."""

import math

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    ChainState,
    InitialState,
    Model,
    Symmetry,
    event_exponents,
    event_multipliers,
    find_periodic_orbit,
    law_of,
    limit_cycle,
    record_events,
    simulate,
    transverse_exponent,
)
from burridge_knopoff.attractors.attractor import perturb
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.running.runner import ROUNDING, Runner
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.running.status import Status
from tests.refused import refused

CHAIN, LAW = Chain(3), law_of("nonlinear", a=0.5)
MODEL = Model(LAW, chain=CHAIN)
ZEROS, ONES, SLIPPING, STUCK = np.zeros(3), np.ones(3), np.zeros(3, bool), np.ones(3, bool)

BEGUN = {
    "simulate": lambda state: simulate(MODEL, initial=state, transient=0, window=5),
    "record_events": lambda state: record_events(MODEL, state, 5.0),
    "rk4": lambda state: record_events(MODEL, state, 5.0, solver="rk4", step=0.01),
    "limit_cycle": lambda state: limit_cycle(MODEL, state, window=100.0),
    "event_exponents": lambda state: event_exponents(MODEL, state, 5.0, loading="steady"),
    "event_multipliers": lambda state: event_multipliers(MODEL, state, 5.0, loading="steady"),
    "transverse_exponent": lambda state: transverse_exponent(MODEL, state, 100.0, 100.0),
    "find_periodic_orbit": lambda state: find_periodic_orbit(MODEL, state, 5.0, Symmetry.ASYMMETRIC),
}


@pytest.mark.parametrize("begin", BEGUN)
@pytest.mark.parametrize(
    ("state", "message"),
    [
        (ChainState(ZEROS, ZEROS, SLIPPING, math.nan), "state.time: nan"),
        (ChainState(ZEROS, -ONES, SLIPPING), "state.velocity: -1.0"),
        (ChainState(ZEROS, [0.0, 1.0, 1.0], STUCK), "state.velocity[1]: 1.0"),
        (ChainState(ZEROS, [0.0, np.nan, 0.0], SLIPPING), "state.velocity: nan"),
    ],
)
def test_states_that_cannot_occur_are_refused(begin, state, message):
    with refused(message):
        BEGUN[begin](state)


@pytest.mark.parametrize("position", [[0.0, np.nan, 0.0], [0.0, 0.0, np.inf]])
def test_positions_that_are_not_finite_are_refused(position):
    with refused(f"state.position: {np.sum(position)}"):
        record_events(MODEL, ChainState(np.array(position), ZEROS, STUCK), 5.0)


def test_a_clock_that_is_not_a_number_is_refused():
    with refused("state.time: 'now'"):
        Runner(MODEL).begin(ChainState(ZEROS, ZEROS, STUCK, "now"))


def test_blocks_slip_backward_under_symmetric_contact():
    model = Model(LAW, chain=CHAIN, contact="symmetric")
    run = simulate(model, initial=ChainState(ZEROS, -ONES, SLIPPING), transient=0, window=5)
    assert run.status == "completed"
    assert run.initially_slipping.all()


def test_rounding_may_leave_a_stop_a_velocity_of_either_sign():
    """The block stops at once; `Runner.state_after` accepts it, as Newton's method passes through such states."""
    runner = Runner(MODEL, keep_events=True)
    position = np.array([0.1, 0.2, 0.0])
    for rounding in (-0.5 * ROUNDING, -1e-17):
        runner.begin(ChainState(position, np.array([0.1, rounding, 0.2]), SLIPPING))
        assert runner.run(1.0) == Status.COMPLETED
        time, block, kind = (values[0] for values in runner.events())
        assert (block, kind) == (1, 0)
        assert time < 1e-11
    assert runner.state_after(ChainState(position, np.array([0.1, -0.01, 0.2]), SLIPPING), 1.0) is not None


@pytest.mark.parametrize("solver", ["series", "map"])
@pytest.mark.parametrize("v", [0.1, 100.0])
def test_runs_continue_from_their_events(solver, v):
    """Mirror blocks stop together: at the stop of one, rounding leaves the other a small velocity."""
    model = Model("linearized", a=0.3, blocks=5, coupling=100.0, v=v)
    offset = np.array([0.01, -0.02, 0.0, -0.02, 0.01])
    run = simulate(
        model,
        initial=InitialState("own", tuple(offset - 0.9), 0.0),
        solver=solver,
        start="tested",
        events="all",
        transient=0,
        window=60,
    )
    assert len(run.event_time) > 20
    assert v < 1.0 or run.event_velocity.min() < 0.0
    generator = np.random.default_rng(1)
    for position, velocity in zip(run.event_position, run.event_velocity, strict=True):
        state = state_of(np.concatenate([position - model.sliding_offset, velocity]))
        runner = Runner(model, solver)
        runner.begin(state)
        assert runner.run(1.0) == Status.COMPLETED
        pushed = perturb(state, 1e-3, generator)
        assert (pushed.velocity >= 0.0).all()
        runner.begin(pushed)


@pytest.mark.parametrize("blocks", [3, 23, 24])
@pytest.mark.parametrize("solver", [name for name in RUN_SOLVERS if not SOLVERS[name].closed_form])
def test_a_run_continues_from_wherever_it_went(blocks, solver):
    """Only a state that a user writes has a range, up to 1e6; blocks accelerate without limit under the linearized law.

    The two parts are the whole run to the bit, with a single group of blocks (23) and with local ones (24).
    """
    begin = InitialState("own", tuple(np.linspace(-0.9, -0.99, blocks)), 0.1)
    options = {"solver": solver, "step": 2.0**-7, "transient": 0.0, "batches": 2}
    whole = simulate(Model("linearized", a=6.0, blocks=blocks), begin, window=3.5, **options)
    first = simulate(Model("linearized", a=6.0, blocks=blocks), begin, window=3.25, **options)
    assert first.status == "completed"
    assert np.abs(first.final.position).max() > 1e6
    rest = simulate(first.model, initial=first.final, window=0.25, **options)
    assert rest.status == "completed"
    assert np.array_equal(rest.final.vector(), whole.final.vector())
    data = rest.to_dataset()
    assert np.array_equal(data.initial_position, first.final.position + first.model.sliding_offset)
    assert np.array_equal(data.initial_velocity, first.final.velocity)
    again = simulate(first.model, initial=rest.initial, window=0.25, **options)
    assert np.allclose(again.final.vector(), whole.final.vector(), rtol=1e-9)
    assert first.catalogue(0.25).status.name == "COMPLETED"
    # Further on it diverges, and says so.
    assert "diverged at tau" in repr(simulate(first.model, initial=first.final, window=50.0, **options))


def test_blocks_on_soft_springs_are_farther_away_than_states_of_a_user_may_be():
    """A spring of strength 1e-6 that is stretched by 5e6 does not overcome static friction of 10."""
    model = Model("linearized", a=0.08, blocks=2, coupling=1e-6, pulling=1e-6, threshold=10.0)
    rest = ChainState(np.full(2, 5e6), np.zeros(2), np.ones(2, bool))
    run = simulate(model, initial=rest, transient=0, window=50, lyapunov_exponents=0)
    assert run.status == "completed"
    assert simulate(model, initial=run.final, transient=0, window=50, lyapunov_exponents=0).status == "completed"
    with refused("position[0]"):
        InitialState("own", tuple(run.final.position + model.sliding_offset), 0.0)


def test_a_state_may_be_written_as_lists():
    state = MODEL.begin(InitialState("own", (-0.9, -1.1, -1.2), (0.1, 0.0, 0.2)), "tested")
    written = ChainState(state.position.tolist(), state.velocity.tolist(), state.stuck.tolist())
    ends = [simulate(MODEL, initial=at, transient=0, window=5).final.vector() for at in (state, written)]
    assert np.array_equal(*ends)
