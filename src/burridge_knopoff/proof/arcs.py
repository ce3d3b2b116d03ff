"""Arcs: the mirror-symmetric motion of three blocks from one event to the next, in closed form.

Blocks 1 and 3, the lateral ones, move as one; block 2 is the center. Positions are co-moving and, like velocities,
divided by v: under the linearized law v is only a scale, and the equations do not contain it. With x, y the positions
of a lateral block and of the center, slipping blocks obey

    x'' = −2x + y + a x',       y'' = −4y + 2x + a y',

and a stuck block has the velocity −1, that of the ground. Its right-hand side is then (s − 1)/v, so that it starts
when that rises to 0. Everything here takes balls and power series alike.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Any

from flint import arb, fmpq

LATERAL, CENTER = 0, 1
NAMES = ("blocks 1 and 3", "block 2")

#: Strengths of all springs at each of the two, and of the springs from the one to the other.
STIFFNESS, COUPLING = (2, 4), (1, 2)


@dataclass(frozen=True)
class State:
    """A mirror-symmetric state: positions x, y and velocities x', y' relative to the driver, in units of v.

    ground : velocity of a block that sticks: −1, or 0 for a small change of a state, which obeys the same equations
    """

    position: tuple[Any, Any]
    velocity: tuple[Any, Any]
    ground: int = -1

    def stopped(self, block: int) -> State:
        """Return the state with a block at rest on the ground."""
        rates = self.velocity
        return replace(self, velocity=(self.ground, rates[1]) if block == LATERAL else (rates[0], self.ground))

    def acceleration(self, block: int, a: Any) -> Any:
        """Return the acceleration of a block if it slips."""
        x, other = self.position[block], self.position[1 - block]
        return COUPLING[block] * other - STIFFNESS[block] * x + a * self.velocity[block]


@dataclass(frozen=True)
class Arc:
    """The motion up to an event.

    slips : whether the lateral blocks, and the center, slip
    ends : LATERAL or CENTER: which of them starts, if it sticks, or stops, if it slips, at the end of the arc
    """

    slips: tuple[bool, bool]
    ends: int

    @property
    def name(self) -> str:
        """The arc in words: what ends it."""
        return f"the arc until {NAMES[self.ends]} {'stop' if self.slips[self.ends] else 'start'}"

    def after(self, state: State, a: Any, time: Any) -> State:
        """Return the state a time later, if no event comes before; a : friction parameter."""
        if all(self.slips):
            return _sliding(state, a, time)
        if any(self.slips):
            return _pulled(state, a, time, self.slips.index(True))
        x, y = state.position
        return replace(state, position=(x + state.ground * time, y + state.ground * time))

    def margin(self, block: int, state: State, a: Any) -> Any:
        """Return what is positive while a block goes on as it does, in units of v.

        The speed U' of a block that slips; 1 − s, static friction less spring force, of a block that sticks.
        """
        return state.velocity[block] + 1 if self.slips[block] else -state.acceleration(block, a)

    def last(self, state: State) -> State:
        """Return the state just after the event, given the one just before: a stop takes the velocity away."""
        return state.stopped(self.ends) if self.slips[self.ends] else state


def oscillation(stiffness: Any, a: Any, time: Any, position: Any, velocity: Any) -> tuple[Any, Any]:
    """Return position and velocity after a time, z'' = −stiffness z + a z', for a < 2 √stiffness."""
    growth = a / 2
    frequency = (stiffness - growth * growth).sqrt()
    factor, angle = (growth * time).exp(), frequency * time
    cosine, sine = angle.cos(), angle.sin() / frequency
    return (
        factor * (position * (cosine - growth * sine) + velocity * sine),
        factor * (velocity * (cosine + growth * sine) - stiffness * position * sine),
    )


def _sliding(state: State, a: Any, time: Any) -> State:
    """Return the state after all blocks have slipped: two normal modes x + w y, of stiffness 3 ∓ √3."""
    root = arb(3).sqrt()
    x, y = state.position
    p, q = state.velocity
    weights = (root - 1) / 2, -(root + 1) / 2
    modes = [
        oscillation(stiffness, a, time, x + weight * y, p + weight * q)
        for stiffness, weight in zip((3 - root, 3 + root), weights, strict=True)
    ]
    center = tuple((one - other) / root for one, other in zip(*modes, strict=True))
    lateral = tuple(one - weights[0] * value for one, value in zip(modes[0], center, strict=True))
    return replace(state, position=(lateral[0], center[0]), velocity=(lateral[1], center[1]))


def _pulled(state: State, a: Any, time: Any, slipping: int) -> State:
    """Return the state after one has slipped and the other has stuck.

    The one that sticks moves at the constant rate of the ground; the other oscillates about a point that follows it
    half as fast, since COUPLING is half of STIFFNESS.
    """
    stiffness, pull = STIFFNESS[slipping], fmpq(state.ground, 2)
    x, other = state.position[slipping], state.position[1 - slipping]
    center = other / 2 + pull * a / stiffness
    moved, rate = oscillation(stiffness, a, time, x - center, state.velocity[slipping] - pull)
    here, there = (moved + center + pull * time, rate + pull), (other + state.ground * time, state.ground)
    (x, p), (y, q) = (here, there) if slipping == LATERAL else (there, here)
    return replace(state, position=(x, y), velocity=(p, q))
