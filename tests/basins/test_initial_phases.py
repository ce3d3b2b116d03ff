"""Initial states given by phases: their positions and velocities, and the normal mode of opposite phases."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.basins.initial_phases import (
    common_phases,
    has_free_ends,
    inner_phases,
    oscillating_states,
    single_block_frequencies,
    slipping_amplitude,
)
from burridge_knopoff.running.runner import Runner
from tests.refused import refused

MODEL = Model("linearized", a=0.08)
UNEQUAL = Model("nonlinear", a=0.1, blocks=4, coupling=[1.0, 2.0, 3.0], pulling=0.5, v=0.2)


@pytest.mark.parametrize("model", [MODEL, UNEQUAL])
def test_amplitude_and_phases_follow_from_the_state(model):
    """(x, −(U' − v)/ω) is the point A (cos θ, sin θ) of each end block."""
    amplitude = np.array([0.01, 0.05, slipping_amplitude(model)])
    difference, common = np.array([0.0, 50.0, 180.0]), np.array([10.0, 200.0, 300.0])
    position, velocity, standing = oscillating_states(model, amplitude, difference, common)
    assert not standing.any()
    offset, swing = position - model.sliding_offset, model.v - velocity
    for block, phase in ((0, common), (-1, common + difference)):
        frequency = single_block_frequencies(model)[block]
        assert np.hypot(offset[:, block], swing[:, block] / frequency) == pytest.approx(amplitude)
        angle = np.degrees(np.arctan2(swing[:, block] / frequency, offset[:, block]))
        assert (angle - phase + 180.0) % 360.0 == pytest.approx(180.0)
    assert offset[:, 1:-1] == pytest.approx(0.0, abs=1e-15)
    assert swing[:, 1:-1] == pytest.approx(0.0, abs=1e-15)


@pytest.mark.parametrize("model", [MODEL, UNEQUAL])
def test_inner_blocks_oscillate_with_a_share_of_the_amplitude(model):
    """(x, −(U' − v)/ω) is the point share · A (cos θ_i, sin θ_i) of each; the end blocks are unchanged."""
    share, amplitude = 0.6, np.array([0.01, 0.02, slipping_amplitude(model, 0.6)])
    difference, common = np.array([0.0, 50.0, 180.0]), np.array([10.0, 200.0, 300.0])
    phase = inner_phases(0.05, (3, model.chain.blocks - 2), 1)
    position, velocity, standing = oscillating_states(model, amplitude, difference, common, share, phase)
    assert not standing.any()
    swing = (model.v - velocity) / single_block_frequencies(model)
    angle = np.radians(phase)
    assert (position - model.sliding_offset)[:, 1:-1] == pytest.approx(share * amplitude[:, None] * np.cos(angle))
    assert swing[:, 1:-1] == pytest.approx(share * amplitude[:, None] * np.sin(angle))
    for oscillating, sliding in zip(
        (position, velocity), oscillating_states(model, amplitude, difference, common)[:2], strict=True
    ):
        assert (oscillating[:, [0, -1]] == sliding[:, [0, -1]]).all()


def test_with_no_share_inner_phases_change_no_bit():
    arguments = (np.array([0.01, 0.05]), np.array([15.0, 180.0]), np.array([10.0, 200.0]))
    drawn = oscillating_states(UNEQUAL, *arguments, 0.0, inner_phases(0.05, (2, 2), 1))
    for array, other in zip(drawn, oscillating_states(UNEQUAL, *arguments), strict=True):
        assert (array == other).all()
    position, velocity, _ = drawn
    assert (position[:, 1:-1] == UNEQUAL.sliding_offset[1:-1]).all()
    assert (velocity[:, 1:-1] == UNEQUAL.v).all()


@settings(max_examples=60, deadline=None)
@given(
    st.sampled_from([MODEL, UNEQUAL]),
    st.floats(0.0, 3.0),
    st.floats(0.01, 3.0),
    st.floats(0.0, 180.0),
    st.integers(0, 99),
)
def test_up_to_the_slipping_amplitude_no_block_is_at_rest(model, share, size, difference, seed):
    """Beyond it a block is at rest at some phases."""
    common, of_inner = common_phases(0.05, (500,), seed), inner_phases(0.05, (500, model.chain.blocks - 2), seed)
    amplitude = np.full(500, size * slipping_amplitude(model, share))
    _, velocity, standing = oscillating_states(model, amplitude, np.full(500, difference), common, share, of_inner)
    assert (velocity >= 0.0).all()
    assert not (size <= 1.0 and standing.any())
    assert not (size > 1.1 and not standing.any())


def test_an_inner_block_oscillates_at_its_frequency_while_its_neighbours_slide():
    """At a turning point of block i, with the others at rest, the equations of motion give x_i'' = −K_ii x_i."""
    position, _, _ = oscillating_states(
        UNEQUAL, *(np.array([x]) for x in (0.02, 0.0, 90.0)), 1.0, np.array([[0.0, 90.0]])
    )
    x = (position - UNEQUAL.sliding_offset)[0]
    # Only the second block is displaced, at its turning point.
    assert x == pytest.approx([0.0, 0.02, 0.0, 0.0], abs=1e-15)
    pull = -UNEQUAL.chain.stiffness @ x
    assert pull[1] == pytest.approx(-(single_block_frequencies(UNEQUAL)[1] ** 2) * x[1])


@pytest.mark.parametrize(
    "chain",
    [Chain(2), Chain(2, coupling=0.5), Chain(3, ends="ring"), Chain(5, ends="ring"), Chain(grid=(2, 1), coupling=0.5)],
)
def test_end_blocks_joined_by_a_spring_are_refused(chain):
    """Opposite and equal phases are then (nearly) normal modes with frequencies other than √K_11: they are refused."""
    assert not has_free_ends(chain)
    model = Model("linearized", a=0.08, chain=chain)
    with refused(f"chain: {chain.blocks}"):
        oscillating_states(model, *(np.array([x]) for x in (0.01, 180.0, 0.0)))
    if chain.blocks == 2:
        opposite, equal = (vector @ chain.stiffness @ vector / 2.0 for vector in (np.array([1.0, -1.0]), np.ones(2)))
        assert opposite - equal == pytest.approx(2.0 * chain.neighbours.strength[0])


def test_the_frequency_is_that_of_a_block_between_sliding_neighbours():
    assert single_block_frequencies(MODEL) ** 2 == pytest.approx([2.0, 4.0, 2.0])
    assert slipping_amplitude(MODEL, 1.0) == pytest.approx(0.05)
    # If inner blocks oscillate little, the end blocks decide.
    assert slipping_amplitude(MODEL, 0.7) == slipping_amplitude(MODEL, 0.0)
    assert slipping_amplitude(MODEL) == pytest.approx(0.1 / np.sqrt(2.0))
    # Springs to the driver and to the only neighbour.
    assert single_block_frequencies(UNEQUAL) ** 2 == pytest.approx([1.5, 3.5, 5.5, 3.5])
    assert slipping_amplitude(UNEQUAL) == pytest.approx(0.2 / np.sqrt(3.5))


def test_opposite_phases_are_a_normal_mode():
    """x_1 = −x_3 and x_2 = 0: an oscillation that grows as exp(aτ/2) until a block stops."""
    a, amplitude, phase = 0.08, 0.02, 40.0
    position, velocity, _ = oscillating_states(MODEL, *(np.array([x]) for x in (amplitude, 180.0, phase)))
    start = ChainState(position[0] - MODEL.sliding_offset, velocity[0], np.zeros(3, dtype=bool))
    frequency = np.sqrt(2.0 - a**2 / 4.0)
    x, speed = start.position[0], start.velocity[0] - MODEL.v
    for time in (0.5, 3.0, 20.0):
        end = Runner(MODEL).state_after(start, time)
        sine, cosine = np.sin(frequency * time), np.cos(frequency * time)
        expected = np.exp(0.5 * a * time) * (x * cosine + (speed - 0.5 * a * x) / frequency * sine)
        assert end.position == pytest.approx([expected, 0.0, -expected], abs=1e-12)
        assert end.velocity[1] == pytest.approx(MODEL.v, abs=1e-12)


def test_no_block_slips_backward():
    """Above v/ω a block is at rest where its oscillation would take it backward."""
    common = np.arange(0.0, 360.0, 5.0)
    amplitude = np.full(len(common), 0.2)
    position, velocity, standing = oscillating_states(MODEL, amplitude, np.full(len(common), 180.0), common)
    oscillation = MODEL.v - 0.2 * np.sqrt(2.0) * np.sin(np.radians(np.stack([common, common + 180.0], axis=1)))
    assert velocity[:, [0, 2]] == pytest.approx(np.maximum(oscillation, 0.0))
    assert standing.tolist() == (oscillation < 0.0).any(axis=1).tolist()
    assert 0.5 < standing.mean() < 1.0
    # At rest or not, its position is given by its phase.
    assert position[:, 0] - MODEL.sliding_offset[0] == pytest.approx(0.2 * np.cos(np.radians(common)))


@pytest.mark.parametrize(("drawn", "another"), [(common_phases, inner_phases), (inner_phases, common_phases)])
def test_phases_are_uniform_and_different_at_each_a(drawn, another):
    phases, same, other, seeded = (
        drawn(*x) for x in ((0.08, (4000,), 1), (0.08, (4000,), 1), (0.09, (4000,), 1), (0.08, (4000,), 2))
    )
    assert (phases == same).all()
    assert np.histogram(phases, 8, (0.0, 360.0))[0].min() > 430
    for two in (other, seeded, another(0.08, (4000,), 1)):
        assert abs(np.corrcoef(phases, two)[0, 1]) < 0.05
