"""Chain, friction laws and initial states: the model's own identities."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from burridge_knopoff.laws import law_of
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_STATES, InitialState, initial_state


def test_the_paper_chain():
    chain = Chain(3)
    assert chain.stiffness.tolist() == [[2, -1, 0], [-1, 4, -1], [0, -1, 2]]
    assert chain.driving.tolist() == [1, 2, 1]
    friction = float(law_of("linearized", 0.08)(0.1))
    assert np.allclose(chain.sliding_offset(friction), np.array([-5 / 6, -2 / 3, -5 / 6]) * (1 - 0.008), atol=1e-15)


@given(st.integers(2, 40))
def test_every_chain_is_driven_as_it_is_stiff(blocks):
    """K·1 = D, on which co-moving coordinates rest; K is positive definite with eigenvalues of at least 1."""
    chain = Chain(blocks)
    assert (chain.stiffness @ np.ones(blocks) == chain.driving).all()
    assert np.linalg.eigvalsh(chain.stiffness).min() >= 1.0 - 1e-12
    assert np.allclose(chain.stiffness @ chain.sliding_offset(0.7), -0.7)


@given(st.floats(0.0, 1.99), st.floats(0.0, 5.0))
def test_friction_laws_touch_at_rest(a, speed):
    linearized, nonlinear = law_of("linearized", a), law_of("nonlinear", a)
    assert linearized(0.0) == nonlinear(0.0) == 1.0
    assert nonlinear(speed) >= linearized(speed) - 1e-15
    assert linearized.slope(0.0) == nonlinear.slope(0.0) == -a


def test_the_paper_states():
    minus, plus = PAPER_STATES["minus"], PAPER_STATES["plus"]
    assert minus.position[1:] == plus.position[1:] == (-0.993, -0.991)
    assert minus.position[0] == -plus.position[0] == -0.989
    assert minus.velocity == plus.velocity == (0.099, 0.1012, 0.1023)


def test_initial_state_by_name_or_numbers():
    assert initial_state("plus") is PAPER_STATES["plus"]
    assert initial_state("mine", (1.0, 2.0), (0.0, 0.1)) == InitialState("mine", (1.0, 2.0), (0.0, 0.1))
    assert initial_state("plus", (1.0, 2.0, 3.0)).velocity == PAPER_STATES["plus"].velocity
    with pytest.raises(ValueError, match="minus"):
        initial_state("mine")


@pytest.mark.parametrize("blocks", [1, 0, -3, 2.0, True, 5000])
def test_bad_chains(blocks):
    with pytest.raises(ValueError, match="blocks"):
        Chain(blocks)


@pytest.mark.parametrize("a", [-0.1, float("nan"), float("inf"), "x", True, None])
def test_bad_friction(a):
    with pytest.raises(ValueError, match="a: "):
        law_of("linearized", a)


@pytest.mark.parametrize(
    ("position", "velocity"),
    [
        ((0.0, float("nan")), (0.1, 0.1)),
        ((0.0, 1e7), (0.1, 0.1)),
        ((0.0, 0.0), (0.1,)),
        ((0.0, 10**400), (0.1, 0.1)),
        ((0.0, "1"), (0.1, 0.1)),
        ((0.0, 0.0), (0.1, True)),
        ((0.0, None), (0.1, 0.1)),
    ],
)
def test_bad_states(position, velocity):
    with pytest.raises(ValueError, match=r"position|velocity"):
        InitialState("bad", position, velocity)
