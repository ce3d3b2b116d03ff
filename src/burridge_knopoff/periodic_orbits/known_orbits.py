"""Orbits of one branch at requested values of a, each continued from the nearest known orbit.

Steps in a cannot pass folds, unlike those of `following`, but they can pass a grazing that is no turning point.
"""

from __future__ import annotations

import math

from burridge_knopoff.model.model import Model
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit, refine_orbit

# Largest and smallest steps in a, in the chain's own unit of a. As a → 0 sticks vanish as the square root of a.
LARGEST_STEP = 0.02
SMALLEST_STEP = 1e-5

# Largest relative change of the period in a step: a larger change indicates another orbit.
LARGEST_PERIOD_CHANGE = 0.1


class KnownOrbits:
    """Orbits of a branch by their a, solved to rounding accuracy.

    first : an orbit of the branch, stable or unstable, of any chain
    """

    def __init__(self, first: PeriodicOrbit) -> None:
        self.orbits: dict[float, PeriodicOrbit] = {first.a: refine_orbit(first)}

    @property
    def model(self) -> Model:
        """The model of the orbits, at the a of the first one."""
        return next(iter(self.orbits.values())).model

    def at(self, a: float) -> PeriodicOrbit:
        """Return the orbit at a > 0; raises OrbitError if the continuation fails on the way, and for other a."""
        if a in self.orbits:
            return self.orbits[a]
        if not a > 0.0:
            raise OrbitError(f"a = {a!r}: no orbits are searched for; expected 0 < a")
        current = min(self.orbits, key=lambda value: abs(value - a))
        unit = self.model.chain.own_units.slope
        step = largest = unit * LARGEST_STEP
        while current != a:
            reach = min(step, 0.5 * current) if a < current else step
            target = a if abs(a - current) <= reach else current + math.copysign(reach, a - current)
            try:
                self.orbits[target] = nearby_orbit(self.orbits[current], target)
            except OrbitError as error:
                step = 0.5 * abs(target - current)
                if step < unit * SMALLEST_STEP * min(1.0, current / largest):
                    raise OrbitError(f"{error}, on the way to a = {a!r}") from None
                continue
            current = target
        return self.orbits[a]


def nearby_orbit(orbit: PeriodicOrbit, a: float) -> PeriodicOrbit:
    """Return the continuation of an orbit to a nearby a, solved to rounding accuracy.

    Raises OrbitError if it is not found.
    """
    model = model_at(orbit.model, a)
    neighbour = refine_orbit(find_periodic_orbit(model, orbit.reference, orbit.return_time, orbit.symmetry))
    if abs(neighbour.period - orbit.period) > LARGEST_PERIOD_CHANGE * orbit.period:
        raise OrbitError(f"a = {a!r}: no periodic orbit found near the guess")
    return neighbour
