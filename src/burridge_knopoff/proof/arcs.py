"""Arcs: mirror-symmetric motion of three blocks between events, with an infinitesimal difference of the end blocks.

The end blocks 1 and 3 (LATERAL) move synchronously; block 2 is the CENTER. Positions are co-moving, and positions and
velocities are divided by v. If x and y are the positions of an end block and of the center, slipping blocks obey

    x'' = −2x + y + w(x'),       y'' = −4y + 2x + w(y'),

where w(p) = (Φ(v) − Φ(v + vp))/v is the weakening of friction. A stuck block has the velocity −1 of the ground. The
right-hand side of its equation is then (s − 1)/v, and the block starts when this rises to 0. All functions accept both
balls and power series.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar, Protocol

LATERAL, CENTER = 0, 1
NAMES = ("blocks 1 and 3", "block 2")

#: Total stiffness of the springs at an end block and at the center, and stiffness of the springs that couple them.
STIFFNESS, COUPLING = (2, 4), (1, 2)


@dataclass(frozen=True)
class State:
    """A mirror-symmetric state: positions x, y and velocities x', y' relative to the driver, in units of v.

    difference : first-order differences d and d' of blocks 1 and 3, starting from d = 1, d' = 0
    """

    position: tuple[Any, Any]
    velocity: tuple[Any, Any]
    difference: tuple[Any, Any] = (1, 0)

    def stop(self, block: int) -> State:
        """Return the state with a block at rest on the ground."""
        if block == LATERAL:
            return replace(self, velocity=(-1, self.velocity[1]), difference=(self.difference[0], 0))
        return replace(self, velocity=(self.velocity[0], -1))


class Flow(Protocol):
    """A friction law in the form used by arcs.

    box_radii : half-widths of the boxes in which an orbit is searched for, widest first
    """

    box_radii: ClassVar[tuple[float, ...]]

    def friction(self, speed: Any, a: Any) -> Any:
        """Return Φ at a speed in units of v; a : in units of 1/v."""

    def weakening(self, rate: Any, a: Any) -> Any:
        """Return w, the decrease of friction below its value at the driver velocity, in units of v."""

    def path(self, slips: tuple[bool, bool], state: State, a: Any) -> Callable[[Any], State]:
        """Return the motion from a state as a function of time, up to the next event."""


@dataclass(frozen=True)
class Arc:
    """The motion up to an event.

    slips : whether the end blocks, and the center, slip
    event_block : LATERAL or CENTER, whichever starts (if it sticks) or stops (if it slips) at the end of the arc
    flow : the friction law
    """

    slips: tuple[bool, bool]
    event_block: int
    flow: Flow

    @property
    def name(self) -> str:
        """Name of the arc, after the event at its end."""
        return f"the arc until {NAMES[self.event_block]} {'stop' if self.slips[self.event_block] else 'start'}"

    def state_after(self, state: State, a: Any, time: Any) -> State:
        """Return the state a time later, if no event occurs before; a : friction parameter."""
        return self.flow.path(self.slips, state, a)(time)

    def margin(self, block: int, state: State, a: Any) -> Any:
        """Return a margin, in units of v, that is positive while a block stays stuck or keeps slipping.

        It is the speed U' of a slipping block, and 1 − s, static friction minus spring force, of a stuck block.
        """
        if self.slips[block]:
            return state.velocity[block] + 1
        x, other = state.position[block], state.position[1 - block]
        return STIFFNESS[block] * x - COUPLING[block] * other - self.flow.weakening(-1, a)

    def state_after_event(self, state: State) -> State:
        """Return the state just after the event, given the state just before it: a stop removes the velocity."""
        return state.stop(self.event_block) if self.slips[self.event_block] else state
