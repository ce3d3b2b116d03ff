"""Initial states: positions U(0) and velocities U'(0) of all blocks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated

import numpy as np

from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.random_numbers import Numbers, RandomNumbers, block_values
from burridge_knopoff.model.ranges import Either, Number, Several, Text, Whole
from burridge_knopoff.model.springs import MAXIMUM_BLOCKS
from burridge_knopoff.values import format_value, instance_of

STATE_NAME = Text("letters, digits and _, at most 32, a letter first", "[A-Za-z][A-Za-z0-9_]{0,31}")
COORDINATE = Number(-1e6, 1e6)
_BLOCK_VALUES = Either((COORDINATE, Several(COORDINATE, 1, MAXIMUM_BLOCKS), RandomNumbers(COORDINATE)))


@settings
@dataclass(frozen=True)
class InitialState:
    """A named initial state: positions U(0) and velocities U'(0), one number for all blocks, one per block, or random.

    `Model.begin` turns it into a `ChainState`, in which some blocks may stick.

    Raises ValueError, one line, for a number out of range and for different numbers of positions and velocities.

    The units are those of `Model`. The paper's two states (its Section III) have the names `minus` and `plus`.

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
                given = f"the number of {words} of the initial state {self.name!r}"
                raise ValueError(f"blocks: got {blocks}, expected {len(values)}, {given}")
        return block_values(self.position, blocks, "position"), block_values(self.velocity, blocks, "velocity")


_PAPER_VELOCITY = (0.099, 0.1012, 0.1023)

#: The paper's two initial states (Section III), which differ only in U_1(0).
PAPER_STATES = {
    "minus": InitialState("minus", (-0.989, -0.993, -0.991), _PAPER_VELOCITY),
    "plus": InitialState("plus", (0.989, -0.993, -0.991), _PAPER_VELOCITY),
}


def initial_state(name: str, position: Numbers | None = None, velocity: Numbers | None = None) -> InitialState:
    """Return one of the paper's states by its name, or a state of this name with the given numbers.

    Raises ValueError for an unknown name without numbers.
    """
    known = PAPER_STATES.get(name)
    if position is None and velocity is None and known is not None:
        return known
    if position is None or velocity is None:
        if known is None:
            raise ValueError(
                f"initial: got {format_value(name)}, expected {' | '.join(PAPER_STATES)}, or both position and velocity"
            )
        position = known.position if position is None else position
        velocity = known.velocity if velocity is None else velocity
    return InitialState(name, position, velocity)
