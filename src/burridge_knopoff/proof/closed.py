"""The linearized law: w(p) = a p, so that v only sets the scale and every arc has a closed form."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Any, ClassVar

from flint import arb, fmpq

from burridge_knopoff.proof.arcs import LATERAL, STIFFNESS, State


@dataclass(frozen=True)
class Linearized:
    """Arcs under the linearized law, for any v."""

    box_radii: ClassVar[tuple[float, ...]] = tuple(2.0**-k for k in range(8, 30))

    def friction(self, speed: Any, a: Any) -> Any:
        """Return Φ at a speed in units of v; a : in units of 1/v."""
        return 1 - a * speed

    def weakening(self, rate: Any, a: Any) -> Any:
        """Return w, the decrease of friction below its value at the driver velocity, in units of v."""
        return a * rate

    def path(self, slips: tuple[bool, bool], state: State, a: Any) -> Callable[[Any], State]:
        """Return the motion from a state as a function of time, up to the next event."""
        return lambda time: _state_after(slips, state, a, time)


def _state_after(slips: tuple[bool, bool], state: State, a: Any, time: Any) -> State:
    if slips[LATERAL]:
        state = replace(state, difference=oscillation(STIFFNESS[LATERAL], a, time, *state.difference))
    if all(slips):
        return _state_all_slipping(state, a, time)
    if any(slips):
        return _state_one_slipping(state, a, time, slips.index(True))
    x, y = state.position
    return replace(state, position=(x - time, y - time))


def oscillation(stiffness: Any, a: Any, time: Any, position: Any, velocity: Any) -> tuple[Any, Any]:
    """Return position and velocity after a time for z'' = −stiffness z + a z', with a < 2 √stiffness."""
    growth = a / 2
    frequency = (stiffness - growth * growth).sqrt()
    factor, angle = (growth * time).exp(), frequency * time
    cosine, sine = angle.cos(), angle.sin() / frequency
    return (
        factor * (position * (cosine - growth * sine) + velocity * sine),
        factor * (velocity * (cosine + growth * sine) - stiffness * position * sine),
    )


def _state_all_slipping(state: State, a: Any, time: Any) -> State:
    """Return the state a time later while all blocks slip: two normal modes x + w y with stiffness 3 ∓ √3."""
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


def _state_one_slipping(state: State, a: Any, time: Any, slipping: int) -> State:
    """Return the state a time later while either the end blocks or the center slip and the others stick.

    Stuck blocks move at the constant velocity of the ground. Slipping blocks oscillate about a point that moves at half
    this velocity, since COUPLING is half of STIFFNESS.
    """
    half = fmpq(1, 2)
    x, other = state.position[slipping], state.position[1 - slipping]
    center = other / 2 - a / (2 * STIFFNESS[slipping])
    moved, rate = oscillation(STIFFNESS[slipping], a, time, x - center, state.velocity[slipping] + half)
    slip, stick = (moved + center - half * time, rate - half), (other - time, -1)
    (x, p), (y, q) = (slip, stick) if slipping == LATERAL else (stick, slip)
    return replace(state, position=(x, y), velocity=(p, q))
