"""Initial states: positions U(0) and velocities U'(0) of all blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from burridge_knopoff.messages import format_value, suggestion
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.random_numbers import Numbers, RandomNumbers, block_values
from burridge_knopoff.model.ranges import Either, Number, Several, Text, Whole
from burridge_knopoff.model.springs import MAXIMUM_BLOCKS
from burridge_knopoff.values import instance_of

#: Names of a state that is given without one: numbers alone, and a state of another run.
OWN, CONTINUED = "own", "continued"
STATE_NAME = Text("letters, digits and _, at most 32, a letter first", "[A-Za-z][A-Za-z0-9_]{0,31}")
COORDINATE = Number(-1e6, 1e6)
_BLOCK_VALUES = Either((COORDINATE, Several(COORDINATE, 1, MAXIMUM_BLOCKS), RandomNumbers(COORDINATE)))


@settings
@dataclass(frozen=True)
class InitialState:
    """A named initial state: positions U(0) and velocities U'(0), one number for all blocks, one per block, or random.

    `Model.begin` turns it into a `ChainState`, in which some blocks may stick. The numbers are the same in every model;
    only the paper's two states, `minus` and `plus` (its Section III), follow the velocity of the driver: `PaperState`.

    Raises ValueError, one line, for a number out of range and for different numbers of positions and velocities.

    The units are those of `Model`.

    >>> from burridge_knopoff import InitialState
    >>> InitialState("own", position=(-0.9, -1.1), velocity=(0.1, 0.1))
    InitialState(name='own', position=(-0.9, -1.1), velocity=(0.1, 0.1))
    >>> rough = InitialState("rough", {"random": "uniform", "low": -1.5, "high": -0.5, "seed": 1}, 0.0)
    >>> rough.coordinates(4)[0].round(2).tolist()
    [-1.45, -1.15, -0.55, -0.68]
    """

    name: str
    position: Annotated[
        Numbers, _BLOCK_VALUES, "initial positions U(0): one number for all blocks, one per block, or random"
    ]
    velocity: Annotated[
        Numbers, _BLOCK_VALUES, "initial velocities U'(0): one number for all blocks, one per block, or random"
    ]

    def __post_init__(self) -> None:
        instance_of(self.name, str, "name")
        check_fields(self)
        lengths = [len(values) for values in (self.position, self.velocity) if isinstance(values, tuple)]
        if len({*lengths}) > 1:
            got = f"{lengths[1]} number{'s' * (lengths[1] != 1)}"
            raise ValueError(f"velocity: got {got}, expected {lengths[0]} for as many positions")

    @property
    def blocks(self) -> int | None:
        """Number of blocks: the length of the lists, 1 for single numbers, None for random numbers."""
        lists = [len(values) for values in (self.position, self.velocity) if isinstance(values, tuple)]
        drawn = isinstance(self.position, str) or isinstance(self.velocity, str)
        return lists[0] if lists else None if drawn else 1

    def coordinates(self, blocks: int) -> tuple[np.ndarray, np.ndarray]:
        """Return U(0) and U'(0) for this number of blocks, each of shape (blocks,).

        Raises ValueError, one line, if the state has lists of another length.
        """
        blocks = Whole(1, MAXIMUM_BLOCKS).form(blocks, "blocks")
        for values, words in ((self.position, "positions"), (self.velocity, "velocities")):
            if isinstance(values, tuple) and len(values) != blocks:
                reason = f"the number of {words} of the initial state {self.name!r}"
                raise ValueError(f"blocks: got {blocks}, expected {len(values)}, {reason}")
        return block_values(self.position, blocks, "position"), block_values(self.velocity, blocks, "velocity")


#: The velocity v of the driver in the paper.
PAPER_V = 0.1


class PaperState(InitialState):
    """One of the paper's initial states, with the numbers of the paper, which are for v = PAPER_V.

    At another v its velocities and its distances from uniform sliding are in proportion to v, with uniform sliding of
    the model at either v (`Model.initial_coordinates`). Under the linearized law and one-sided contact the whole motion
    is then in proportion to v.
    """


class StartedState(InitialState):
    """The state from which a run started: any numbers, since only a state of a user has a range."""

    def __post_init__(self) -> None:
        pass


_PAPER_VELOCITY = (0.099, 0.1012, 0.1023)

#: The paper's two initial states (Section III), which differ only in U_1(0).
PAPER_STATES = {
    "minus": PaperState("minus", (-0.989, -0.993, -0.991), _PAPER_VELOCITY),
    "plus": PaperState("plus", (0.989, -0.993, -0.991), _PAPER_VELOCITY),
}


def has_paper_numbers(state: InitialState) -> bool:
    """Return whether a state has the name and the numbers of one of the paper's states."""
    paper = PAPER_STATES.get(state.name)
    return paper is not None and (state.position, state.velocity) == (paper.position, paper.velocity)


def initial_state(
    name: str, position: Numbers | None = None, velocity: Numbers | None = None, key: str = "initial"
) -> InitialState:
    """Return a state with these numbers, or without numbers the state of the paper that has this name.

    key : name of the state in messages

    Raises ValueError, one line, for any other name without numbers, and for positions or velocities alone.
    """
    if position is not None and velocity is not None:
        return InitialState(name, position, velocity)
    if name not in PAPER_STATES or position is not None or velocity is not None:
        names = f"{' | '.join(PAPER_STATES)}{suggestion(name, PAPER_STATES)}"
        raise ValueError(f"{key}: got {format_value(name)}, expected {names}, or both position and velocity")
    return PAPER_STATES[name]
