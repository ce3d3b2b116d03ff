"""Frequencies of blocks, compared with normal modes, cycles of a periodic orbit, and motion by SciPy."""

import numpy as np
import pytest
from scipy.linalg import eigh

from burridge_knopoff import (
    Chain,
    ChainState,
    Model,
    block_frequencies,
    law_of,
    limit_cycle,
    simulate,
)
from tests.refused import refused
from tests.scipy_flow import model_events

THREE = Chain(3)


def detuned_model(a, detuning, law="linearized"):
    return Model(THREE, law_of(law, a)).at(**{"mass[3]": 1.0 + detuning})


def from_plus(model):
    return block_frequencies(model, simulate(model, initial="plus", transient=0.0, window=6000.0).final)


@pytest.mark.parametrize("detuning", [0.0, 0.3])
@pytest.mark.parametrize("mode", [0, 1, 2])
def test_a_normal_mode_has_its_frequency(mode, detuning):
    """At a = 0 friction is constant: small oscillations about sliding are those of the springs."""
    model = detuned_model(0.0, detuning)
    masses = np.diag(model.chain.masses)
    squares, shapes = eigh(model.chain.stiffness, masses)
    state = ChainState(0.03 * shapes[:, mode], np.full(3, model.v), np.zeros(3, bool))
    frequency, error = block_frequencies(model, state)
    moving = np.abs(shapes[:, mode]) > 1e-9
    assert frequency[moving] == pytest.approx(np.sqrt(squares[mode]) / (2.0 * np.pi), abs=1e-12)
    assert (error[moving] < 1e-11).all()
    # In the antisymmetric mode of equal masses the middle block slides.
    assert np.isnan(frequency[~moving]).all() or not moving.all()


def test_of_two_modes_each_block_has_the_frequency_with_the_larger_amplitude():
    model = detuned_model(0.0, 0.3)
    squares, shapes = eigh(model.chain.stiffness, np.diag(model.chain.masses))
    state = ChainState(0.02 * shapes[:, 1] + 0.012 * shapes[:, 2], np.full(3, model.v), np.zeros(3, bool))
    amplitude = np.abs([0.02, 0.012] * shapes[:, 1:] * np.sqrt(squares[1:]))
    expected = np.sqrt(squares[1:])[amplitude.argmax(axis=1)] / (2.0 * np.pi)
    assert len({*expected}) == 2
    assert block_frequencies(model, state)[0] == pytest.approx(expected, abs=1e-9)


def test_on_a_periodic_orbit_the_frequency_is_the_number_of_cycles_per_period():
    """With a mass larger by half the motion at a = 0.06 is periodic; SciPy gives the period, and cycles are counted."""
    model = detuned_model(0.06, 0.5)
    orbit = limit_cycle(model, simulate(model, initial="plus", transient=0.0, window=6000.0).final, settling=3000.0)
    events, end = model_events(model, orbit.reference, orbit.period)
    assert end == pytest.approx(orbit.reference.vector(), abs=1e-8)
    assert len(events) == len(orbit.events)
    run = simulate(model, initial=orbit.reference, transient=0.0, window=orbit.period, trajectory=orbit.period)
    speed = run.velocity - run.velocity.mean(axis=0)
    upward = ((speed[:-1] < 0.0) & (speed[1:] >= 0.0)).sum(axis=0)
    assert upward[0] == upward[2] < upward[1]
    frequency, error = block_frequencies(model, orbit.reference)
    assert frequency == pytest.approx(upward / orbit.period, abs=1e-9)
    assert (error < 1e-8).all()


@pytest.mark.parametrize("detuning", [0.0005, 0.1, 0.3, 0.5])
def test_the_end_blocks_keep_one_frequency(detuning):
    """Other integrators agree to 1e-9 from 0.0005 to 0.5."""
    frequency, _ = from_plus(detuned_model(0.06, detuning))
    assert frequency[2] == pytest.approx(frequency[0], abs=1e-9)
    assert frequency[1] > 1.5 * frequency[0]


def test_the_common_frequency_ends_at_a_detuning():
    assert from_plus(detuned_model(0.06, 0.8))[0][[0, 2]] == pytest.approx([0.2036, 0.1467], abs=5e-5)
    one, two = (from_plus(detuned_model(0.03, detuning))[0] for detuning in (0.3, 0.5))
    assert one[2] == pytest.approx(one[0], abs=1e-8)
    assert abs(two[2] - two[0]) > 0.04


def test_the_frequency_is_the_winding_rate_of_the_phase():
    """The mean rate of the phase of (x, U' − v), from samples of a run, is the same where the phase never jumps."""
    model = detuned_model(0.03, 0.1)
    run = simulate(model, initial="plus", transient=6000.0, window=4000.0, trajectory=4000.0)
    turn = np.unwrap(np.angle(run.position - model.sliding_offset + 1j * (run.velocity - model.v)), axis=0)
    assert np.abs(np.diff(turn, axis=0)).max() < 1.0
    # A straight line is fitted to the phase, with errors of the order of 1/T².
    rate = np.polyfit(run.trajectory_time - run.trajectory_time.mean(), turn, 1)[0]
    begin = simulate(model, initial="plus", transient=0.0, window=6000.0).final
    assert block_frequencies(model, begin)[0] == pytest.approx(-rate / (2.0 * np.pi), abs=2e-7)


def test_uniform_sliding_has_no_frequency():
    model = Model(THREE, law_of("linearized", 0.06))
    state = ChainState(np.zeros(3), np.full(3, model.v), np.zeros(3, bool))
    assert np.isnan(block_frequencies(model, state, 50.0)).all()


def test_a_duration_that_cannot_be_kept_is_refused():
    model = Model(Chain(300), law_of("linearized", 0.06))
    state = ChainState(np.zeros(300), np.full(300, model.v), np.zeros(300, bool))
    with refused("duration: 1000000.0", match="expected a shorter one"):
        block_frequencies(model, state, 1e6)
    with refused("duration: 0", match="expected a number above 0"):
        block_frequencies(model, state, 0)
