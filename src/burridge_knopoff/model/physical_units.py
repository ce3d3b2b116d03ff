"""Conversion between a physical system and the dimensionless model."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Annotated

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import check_fields, settings
from burridge_knopoff.model.ranges import HUGE, Number
from burridge_knopoff.values import real_number

_POSITIVE = Number(0.0, HUGE, above=True)


@settings
@dataclass(frozen=True)
class PhysicalUnits:
    """The units of a system of blocks of mass m on springs of stiffness k with the static friction F(0).

    Times are in units of 1/ω with ω = sqrt(k/m), lengths in units of F(0)/k and forces in units of F(0), as in the
    paper (Section II, Eq. 2). `v` and `a` return the parameters of the model, `speed` and `friction_slope` go back.
    Numbers of a law that are speeds are multiples of `velocity`; other springs, masses and thresholds of a chain are
    multiples of `stiffness`, `mass` and `friction`, and dashpots of `damping`. SI units, or any that fit together.

    Raises ValueError, one line, for a number that is not above 0.

    >>> from burridge_knopoff import Model, PhysicalUnits, simulate
    >>> units = PhysicalUnits(mass=0.5, stiffness=200.0, friction=2.0)
    >>> units.time, units.length, units.velocity, units.damping
    (0.05, 0.01, 0.2, 10.0)
    >>> v, a = units.v(0.02), units.a(-0.8)
    >>> round(v, 12), round(a, 12)
    (0.1, 0.08)
    >>> run = simulate(Model("linearized", a=a, v=v), "plus")
    >>> round(run.period * units.time, 3)
    7.862
    """

    mass: Annotated[float, _POSITIVE, "mass m of a block, kg"]
    stiffness: Annotated[float, _POSITIVE, "stiffness k of a spring, N/m"]
    friction: Annotated[float, _POSITIVE, "static friction F(0) of a block, N"]

    def __post_init__(self) -> None:
        check_fields(self)

    @property
    def time(self) -> float:
        """The unit of time 1/ω = sqrt(m/k), s."""
        return math.sqrt(self.mass / self.stiffness)

    @property
    def length(self) -> float:
        """The unit of length F(0)/k, m."""
        return self.friction / self.stiffness

    @property
    def velocity(self) -> float:
        """The unit of velocity ωF(0)/k, m/s."""
        return self.friction / self.damping

    @property
    def damping(self) -> float:
        """The unit of dashpots and of the slope of the friction force over the speed, sqrt(km), kg/s."""
        return math.sqrt(self.stiffness * self.mass)

    def v(self, speed: float) -> float:
        """Return the velocity v of the driver in the model for its speed V, m/s."""
        return _number(speed, "speed") / self.velocity

    def speed(self, v: float) -> float:
        """Return the speed V of the driver, m/s, for its velocity v in the model."""
        return _number(v, "v") * self.velocity

    def a(self, friction_slope: float) -> float:
        """Return a for the slope dF/dV of the friction force at zero speed, kg/s: 0 or less, a = −F'(0)/sqrt(km).

        This is the a of a law with Φ'(0) = −a, such as both laws of the paper. Raises ValueError for a slope above 0.
        """
        slope = _number(friction_slope, "friction_slope")
        if slope > 0.0:
            raise refusal("friction_slope", friction_slope, "0 or less: friction falls as the speed grows")
        return -slope / self.damping + 0.0

    def friction_slope(self, a: float) -> float:
        """Return the slope dF/dV of the friction force at zero speed, kg/s, for a law with Φ'(0) = −a."""
        return -_number(a, "a") * self.damping + 0.0


def _number(value: float, key: str) -> float:
    number = real_number(value)
    if not math.isfinite(number):
        raise refusal(key, value, "a finite number")
    return number
