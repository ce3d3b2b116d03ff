"""Initial states: the paper's, by name or numbers, and refused ones."""

import pytest

from burridge_knopoff import InitialState
from burridge_knopoff.model.initial import PAPER_STATES, initial_state


def test_the_paper_states():
    minus, plus = PAPER_STATES["minus"], PAPER_STATES["plus"]
    assert minus.position[1:] == plus.position[1:] == (-0.993, -0.991)
    assert minus.position[0] == -plus.position[0] == -0.989
    assert minus.velocity == plus.velocity == (0.099, 0.1012, 0.1023)


def test_initial_state_by_name_or_numbers():
    assert initial_state("plus") is PAPER_STATES["plus"]
    assert initial_state("mine", (1.0, 2.0), (0.0, 0.1)) == InitialState("mine", (1.0, 2.0), (0.0, 0.1))
    assert initial_state("plus", (1.0, 2.0, 3.0)).velocity == PAPER_STATES["plus"].velocity
    assert initial_state("plus", velocity=(0.0, 0.1, 0.2)) == InitialState(
        "plus", PAPER_STATES["plus"].position, (0.0, 0.1, 0.2)
    )
    with pytest.raises(ValueError, match="minus"):
        initial_state("mine")


@pytest.mark.parametrize("last", [float("nan"), 1e7, 10**400, "1", None])
def test_refused(last):
    with pytest.raises(ValueError, match="position"):
        InitialState("bad", (0.0, last), (0.1, 0.1))
    for velocity in ((0.1,), (0.1, True)):
        with pytest.raises(ValueError, match="velocity"):
            InitialState("bad", (0.0, 0.0), velocity)
