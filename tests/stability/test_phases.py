"""Initial states by their phases: what they say of themselves, and the normal mode that opposite phases are."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Instant, Model, law_of
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.stability.phases import common_phases, end_frequencies, oscillating_states, slipping_amplitude

MODEL = Model(Chain(3), law_of("linearized", 0.08))
UNEQUAL = Model(Chain(4, coupling=[1.0, 2.0, 3.0], pulling=0.5), law_of("nonlinear", 0.1), v=0.2)


@pytest.mark.parametrize("model", [MODEL, UNEQUAL])
def test_amplitude_and_phases_can_be_read_off_the_state(model):
    """(x, −(U' − v)/ω) is the point A (cos θ, sin θ) of each end block."""
    amplitude = np.array([0.01, 0.05, slipping_amplitude(model)])
    difference, common = np.array([0.0, 50.0, 180.0]), np.array([10.0, 200.0, 300.0])
    position, velocity, standing = oscillating_states(model, amplitude, difference, common)
    assert not standing.any()
    offset, swing = position - model.sliding_offset, model.v - velocity
    for block, frequency, phase in zip((0, -1), end_frequencies(model), (common, common + difference), strict=True):
        assert np.hypot(offset[:, block], swing[:, block] / frequency) == pytest.approx(amplitude)
        found = np.degrees(np.arctan2(swing[:, block] / frequency, offset[:, block]))
        assert (found - phase + 180.0) % 360.0 == pytest.approx(180.0)
    assert offset[:, 1:-1] == pytest.approx(0.0, abs=1e-15)
    assert swing[:, 1:-1] == pytest.approx(0.0, abs=1e-15)


def test_the_frequency_is_that_of_a_block_between_sliding_neighbours():
    assert end_frequencies(MODEL) == pytest.approx([np.sqrt(2.0)] * 2)
    assert slipping_amplitude(MODEL) == pytest.approx(0.1 / np.sqrt(2.0))
    # Springs to the driver and to the only neighbour.
    assert end_frequencies(UNEQUAL) ** 2 == pytest.approx([1.5, 3.5])
    assert slipping_amplitude(UNEQUAL) == pytest.approx(0.2 / np.sqrt(3.5))


def test_opposite_phases_are_a_normal_mode():
    """x_1 = −x_3 and x_2 = 0 for ever, an oscillation that grows as exp(aτ/2), until a block stops."""
    a, amplitude, phase = 0.08, 0.02, 40.0
    position, velocity, _ = oscillating_states(MODEL, *(np.array([x]) for x in (amplitude, 180.0, phase)))
    start = Instant(position[0] - MODEL.sliding_offset, velocity[0], np.zeros(3, dtype=bool))
    frequency = np.sqrt(2.0 - a**2 / 4.0)
    x, speed = start.position[0], start.velocity[0] - MODEL.v
    for time in (0.5, 3.0, 20.0):
        end = Runner(MODEL).after(start, time)
        sine, cosine = np.sin(frequency * time), np.cos(frequency * time)
        expected = np.exp(0.5 * a * time) * (x * cosine + (speed - 0.5 * a * x) / frequency * sine)
        assert end.position == pytest.approx([expected, 0.0, -expected], abs=1e-12)
        assert end.velocity[1] == pytest.approx(MODEL.v, abs=1e-12)


def test_no_block_slips_backward():
    """Beyond v/ω a block stands where the oscillation would take it back."""
    common = np.arange(0.0, 360.0, 5.0)
    amplitude = np.full(len(common), 0.2)
    position, velocity, standing = oscillating_states(MODEL, amplitude, np.full(len(common), 180.0), common)
    wanted = MODEL.v - 0.2 * np.sqrt(2.0) * np.sin(np.radians(np.stack([common, common + 180.0], axis=1)))
    assert velocity[:, [0, 2]] == pytest.approx(np.maximum(wanted, 0.0))
    assert standing.tolist() == (wanted < 0.0).any(axis=1).tolist()
    assert 0.5 < standing.mean() < 1.0
    # Whether it stands or not, it is where its phase says.
    assert position[:, 0] - MODEL.sliding_offset[0] == pytest.approx(0.2 * np.cos(np.radians(common)))


def test_common_phases_are_uniform_and_others_at_each_a():
    one, same, other, seeded = (
        common_phases(*x) for x in ((0.08, (4000,), 1), (0.08, (4000,), 1), (0.09, (4000,), 1), (0.08, (4000,), 2))
    )
    assert (one == same).all()
    assert np.histogram(one, 8, (0.0, 360.0))[0].min() > 430
    for two in (other, seeded):
        assert abs(np.corrcoef(one, two)[0, 1]) < 0.05
