"""The units of a chain: 1 for the paper's chain of any length, and powers of 2 that scale with any other chain."""

import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff import Chain
from burridge_knopoff.model.own_units import OwnUnits

PAPER = OwnUnits()


@pytest.mark.parametrize("blocks", [1, 2, 3, 8, 300])
def test_chains_like_the_papers_have_units_of_1(blocks):
    assert Chain(blocks).own_units == Chain(blocks, pulling=1.0, threshold=1.1, mass=0.9).own_units == PAPER
    if blocks > 1:
        assert Chain(blocks, ends="ring").own_units == PAPER


@given(
    st.integers(-6, 6), st.integers(-6, 6), st.integers(-2, 2), st.lists(st.floats(0.1, 10.0), min_size=9, max_size=9)
)
def test_units_scale_with_the_chain(time, length, force, values):
    """The units of time, length and force differ by powers of 2."""
    one = Chain(3, coupling=values[:2], pulling=values[2:5], threshold=values[5:8], mass=values[8])
    springs, masses = 2.0 ** (force - length), 2.0 ** (force - length + 2 * time)
    other = Chain(
        3,
        coupling=[springs * value for value in values[:2]],
        pulling=[springs * value for value in values[2:5]],
        threshold=[2.0**force * value for value in values[5:8]],
        mass=masses * values[8],
    )
    units, scaled_units = one.own_units, other.own_units
    factors = scaled_units.time / units.time, scaled_units.length / units.length, scaled_units.force / units.force
    assert factors == (2.0**time, 2.0**length, 2.0**force)


def test_stiff_springs_between_blocks_do_not_make_the_slow_motion_fast():
    """The blocks oscillate together however stiff the springs between them; a block on soft springs remains slow."""
    assert Chain(3, coupling=1e6).own_units == PAPER
    assert Chain(3, pulling=(1.0, 1e-6, 1.0)).own_units.time <= 2.0
    assert Chain(3, pulling=(1e6, 1.0, 1e6)).own_units.time >= 0.25


def test_derived_units():
    units = OwnUnits(time=4.0, length=32.0)
    assert (units.velocity, units.acceleration, units.slope) == (8.0, 2.0, 0.125)
    assert units.state(2).tolist() == [32.0, 32.0, 8.0, 8.0]
