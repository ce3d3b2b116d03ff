"""A chain in other units is the same chain: the kernel's limits are in the chain's own units of time."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, Model, simulate
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.running.ensemble import new_ensemble
from tests.flows import wave

WHOLE = {"transient": 0.0, "events": "all", "trajectory": 0.0}


def run_of(model, initial, window, exponents=0):
    return simulate(
        model, initial=initial, **WHOLE, window=window, sampling=window, batches=2, lyapunov_exponents=exponents
    )


@settings(max_examples=40)
@given(
    st.sampled_from([1, 3, 8, 30]),
    st.sampled_from(["linearized", "nonlinear"]),
    st.sampled_from([False, True]),
    st.integers(1, 12),
)
def test_shorter_units_of_time_and_length_change_no_bit(blocks, law, symmetric, power):
    """Springs 2ⁿ times as stiff, masses 2ⁿ times as light: everything is 2ⁿ times as fast and as short."""
    factor, contact = 2.0**power, "symmetric" if symmetric else "one_sided"
    ends = [
        Model(law, a=0.3, chain=Chain(blocks, size, size, mass=1.0 / size), v=0.125, contact=contact)
        for size in (1.0, factor)
    ]
    initial = wave(blocks)
    short = InitialState("short", tuple(np.array(initial.position) / factor), initial.velocity)
    one, other = (run_of(*case) for case in ((ends[0], initial, 50.0), (ends[1], short, 50.0 / factor)))
    assert one.status == other.status == "completed"
    assert np.array_equal(one.event_time, other.event_time * factor)
    assert np.array_equal(one.event_block, other.event_block)
    assert np.array_equal(one.event_velocity, other.event_velocity)


def test_a_stiff_light_block_moves_as_one_of_the_paper():
    """(pulling, mass, a, v) = (1e6, 0.05, 22.36, 4.47e-4) is (1, 1, 0.1, 0.1) in other units."""
    time, length = (0.05 / 1e6) ** 0.5, 1e-6
    paper_model = Model("linearized", a=0.1, blocks=1, pulling=1.0, v=0.1)
    stiff = Model("linearized", a=0.1 * time / length, blocks=1, pulling=1e6, mass=0.05, v=0.1 * length / time)
    paper_run = run_of(paper_model, ((-0.9,), (0.1,)), 200.0)
    other = run_of(stiff, ((-0.9 * length,), (0.1 * length / time,)), 200.0 * time)
    assert other.status == "completed"
    assert len(paper_run.event_time) > 20
    assert paper_run.event_time == pytest.approx(other.event_time / time, abs=1e-9)
    assert paper_run.event_kind.tolist() == other.event_kind.tolist()
    # Many periods fall into one unit of time.
    longer = run_of(stiff, ((-0.9 * length,), (0.1 * length / time,)), 10.0)
    assert longer.status == "completed"
    assert longer.event_count == pytest.approx(len(paper_run.event_time) / 200.0 / time * 10.0, rel=0.05)
    at = stiff.begin(InitialState("own", (-0.9 * length,), (0.1 * length / time,)))
    lanes = new_ensemble(stiff).run(at.position[None], at.velocity[None], at.stuck[None], np.array([10.0]))
    assert lanes["event_count"][0] == longer.event_count


def test_exponents_of_a_fast_chain():
    """Perturbations are orthonormalized as often as events occur; once per unit of time would lose all of them."""
    factor, initial = 1024.0, wave(3)
    short = InitialState("short", tuple(np.array(initial.position) / factor), initial.velocity)
    paper, fast = (
        Model("linearized", a=0.2, chain=Chain(3, size, (size, 2.0 * size, size), mass=1.0 / size), v=0.125)
        for size in (1.0, factor)
    )
    slow_run, fast_run = run_of(paper, initial, 4000.0, 3), run_of(fast, short, 4000.0 / factor, 3)
    assert slow_run.lyapunov_exponent[0] > 0.005
    assert fast_run.lyapunov_exponent / factor == pytest.approx(slow_run.lyapunov_exponent, abs=5e-3)
    assert fast_run.lyapunov_infinite_count == slow_run.lyapunov_infinite_count
