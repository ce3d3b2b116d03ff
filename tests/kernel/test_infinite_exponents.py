"""Which Lyapunov exponents are 0, and which −∞."""

import numpy as np
import pytest

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.running.simulation import simulate
from tests.kernel.flows import carry, growth_from

LAWS = ("linearized", "nonlinear")


@pytest.mark.parametrize(
    ("law", "initial", "a", "zeros"),
    [
        ("linearized", "minus", 0.06, 1),
        ("linearized", "plus", 0.1, 1),
        ("linearized", "minus", 0.3, 1),
        ("nonlinear", "plus", 0.24, 1),
        ("linearized", "plus", 0.06, 2),
        ("nonlinear", "plus", 0.06, 2),
        ("nonlinear", "plus", 0.08, 2),
    ],
)
def test_zero_exponents_of_regular_motion(law, initial, a, zeros):
    """One along the flow, a second one on a torus; both within their error, the next one far from 0."""
    run = simulate(law, a, initial, events="none")
    exponent, error = run.lyapunov_exponent, run.lyapunov_error
    assert (np.abs(exponent[:zeros]) < 2.0 * error[:zeros]).all()
    assert exponent[zeros] < -10.0 * error[zeros]
    assert (error < 2e-3).all()


def test_growth_like_a_power_of_time_is_within_the_error():
    """Linear growth gains ln(1 + T/A) through a window T after an alignment A; batches alone see an exponent there."""
    run = simulate("linearized", 0.06, "plus", events="none")
    window, alignment = 7000.0, 1000.0
    linear = np.log(1.0 + window / alignment) / window
    assert (run.lyapunov_error > 0.99 * linear).all()
    edges = alignment + np.linspace(0.0, window, 8)
    batch = np.diff(np.log(edges)) / 1000.0
    assert batch.mean() > 3.0 * batch.std(ddof=1) / np.sqrt(7)


def most_stuck(run, begin_time):
    """Return the most blocks stuck at once after a time; every block slips at τ = 0."""
    stuck = np.zeros(run.model.blocks, dtype=bool)
    most = 0
    following = np.append(run.event_time[1:], np.inf)
    for time, next_time, block, kind in zip(run.event_time, following, run.event_block, run.event_kind, strict=True):
        stuck[block - 1] = kind == 0
        if next_time > max(time, begin_time):
            most = max(most, int(stuck.sum()))
    return most


@pytest.mark.parametrize(
    ("law", "initial", "a", "contact"),
    [
        ("linearized", "minus", 0.02, "one_sided"),
        ("linearized", "minus", 0.08, "one_sided"),
        ("linearized", "plus", 0.08, "one_sided"),
        ("linearized", "plus", 0.2, "symmetric"),
        ("linearized", "plus", 0.25, "one_sided"),
        ("nonlinear", "plus", 0.15, "one_sided"),
        ("nonlinear", "plus", 0.15, "symmetric"),
        ("nonlinear", "plus", 0.25, "one_sided"),
    ],
)
def test_as_many_are_infinite_as_blocks_are_stuck_at_once(law, initial, a, contact):
    run = simulate(law, a, initial, contact=contact, events="all", lyapunov_exponents=6, transient=1000.0)
    expected = most_stuck(run, 1000.0)
    assert run.lyapunov_infinite_count == expected
    assert np.isneginf(run.lyapunov_exponent).sum() == expected
    assert np.isneginf(run.batch_lyapunov_exponent).sum() == 7 * expected
    assert np.isneginf(run.lyapunov_exponent[6 - expected :]).all()
    assert np.isnan(run.lyapunov_error[6 - expected :]).all()
    assert np.isfinite(run.lyapunov_error[: 6 - expected]).all()


def test_what_was_stuck_in_the_transient_only_costs_nothing():
    """Three blocks stuck at once before the window, one within it."""
    options = {"events": "all", "lyapunov_exponents": 6, "start": "tested"}
    state = InitialState("held", (0.3, 0.3, 0.25), (0.1, 0.1, 0.1))
    assert (-Chain(3).stiffness @ state.position < 1.0).all()
    run = simulate("linearized", 0.25, state, transient=2000.0, lyapunov_alignment=2000.0, **options)
    assert most_stuck(run, 1990.0) == 1
    assert run.lyapunov_infinite_count == 1
    assert np.isfinite(run.lyapunov_exponent[:5]).all()
    later_start = simulate("linearized", 0.25, state, transient=2000.0, lyapunov_alignment=500.0, **options)
    difference = np.abs(run.lyapunov_exponent - later_start.lyapunov_exponent)[:5]
    assert (difference < 4.0 * later_start.lyapunov_error[:5]).all()


def test_parts_of_a_chain_lose_perturbations_one_after_the_other():
    """Block 2 is held and parts its neighbours: block 1 stops and starts, then block 3 stops.

    Never more than two blocks are stuck at once; but what block 1 has lost block 3 cannot restore, so that the map has
    rank 3. The vectors that are lost are gone: their remainders are rounding and must not pass for finite exponents.
    """
    model = Model(Chain(3), law_of("linearized", 0.1), 0.1)
    start = Instant(np.array([0.17, 0.3, 0.345]), np.array([0.003, 0.0, 0.3]), np.array([False, True, False]))
    solver, events = carry(model, start, 1.0, np.diag([1.0, 1.0, 1.0, 1.0, 0.0, 1.0]))
    assert [(block, kind) for _, block, kind in events] == [(1, 0), (1, 1), (3, 0)]
    values = np.linalg.svd(solver.perturbations, compute_uv=False)
    assert (values > 1e-12).sum() == 3
    found = growth_from(model, start, 1.0, 6)
    assert found["lost"] == 3
    assert np.isneginf(found["growth"][0]).tolist() == [False] * 3 + [True] * 3
