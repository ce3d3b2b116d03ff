"""Initial states: positions U(0) and velocities U'(0) of all blocks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.model.chain import MAXIMUM_BLOCKS
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import Number, Several, Text
from burridge_knopoff.values import shown

STATE_NAME = Text("letters, digits and _, at most 32, a letter first", "[A-Za-z][A-Za-z0-9_]{0,31}")
COORDINATE = Number(-1e6, 1e6)
_ONE_A_BLOCK = Several(COORDINATE, 1, MAXIMUM_BLOCKS)


@settings
@dataclass(frozen=True)
class InitialState:
    """A named initial state: positions U(0) and velocities U'(0), one number a block.

    `Model.begin` turns it into a `ChainState`, which knows which blocks stick and the position of uniform sliding.

    Raises ValueError, one line, for a number out of range and for different numbers of positions and velocities.

    The units are those of `Model`. The paper's two states (its Section III) have the names `minus` and `plus`.

    >>> from burridge_knopoff import InitialState
    >>> InitialState("own", position=(-0.9, -1.1), velocity=(0.1, 0.1))
    InitialState(name='own', position=(-0.9, -1.1), velocity=(0.1, 0.1))
    """

    name: str
    position: Annotated[tuple[float, ...], _ONE_A_BLOCK, "initial positions U(0)"]
    velocity: Annotated[tuple[float, ...], _ONE_A_BLOCK, "initial velocities U'(0)"]

    def __post_init__(self) -> None:
        check_fields(self)
        if len(self.velocity) != len(self.position):
            raise ValueError(
                f"velocity: got {len(self.velocity)} numbers, expected {len(self.position)} for as many positions"
            )


_PAPER_VELOCITY = (0.099, 0.1012, 0.1023)

#: The paper's two initial states (Section III), which differ only in U_1(0).
PAPER_STATES = {
    "minus": InitialState("minus", (-0.989, -0.993, -0.991), _PAPER_VELOCITY),
    "plus": InitialState("plus", (0.989, -0.993, -0.991), _PAPER_VELOCITY),
}


def initial_state(
    name: str, position: Sequence[float] | None = None, velocity: Sequence[float] | None = None
) -> InitialState:
    """Return one of the paper's states by its name, or the given numbers under this name.

    Raises ValueError for an unknown name without numbers.
    """
    known = PAPER_STATES.get(name)
    if position is None and velocity is None and known is not None:
        return known
    if position is None or velocity is None:
        if known is None:
            raise ValueError(
                f"initial: got {shown(name)}, expected {' | '.join(PAPER_STATES)}, or both position and velocity"
            )
        position = known.position if position is None else position
        velocity = known.velocity if velocity is None else velocity
    return InitialState(name, tuple(position), tuple(velocity))
