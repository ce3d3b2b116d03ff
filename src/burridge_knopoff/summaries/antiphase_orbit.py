"""⟨J⟩ of the antiphase orbit of three blocks, branch 2, under both of the paper's laws, as a falls in two ways.

At a fixed driver velocity v a falls alone. At a fixed product av, as at a fixed velocity of the driver with its units,
v grows as a falls, so that the friction forces of the two laws differ as much as before.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

#: Up to this a the laws are compared; here the fixed product is that of the study's driver velocity.
LARGEST_A = 0.1

# Amplitude of the end blocks at the start, in units of v, and time for which the motion settles, in units of 1/a.
AMPLITUDE, SETTLING = 0.45, 16.0

# Decimals of a relative difference: further ones differ between machines.
DIGITS = 10

_WORDS = "relative difference of <J> on the antiphase orbit: that of the nonlinear law minus that of the linearized law"
_NONE = {"comment": f"NaN above a = {LARGEST_A:g}, and where one of the orbits is not found"}
VARIABLES = {
    "antiphase_difference": Variable(("a",), "f8", f"{_WORDS}, at the study's driver velocity", _NONE),
    "antiphase_difference_fixed_av": Variable(
        ("a",), "f8", f"{_WORDS}, at a driver velocity in proportion to 1/a, {LARGEST_A:g}/a times the study's", _NONE
    ),
}


def antiphase_orbit(model: Model) -> PeriodicOrbit:
    """Return the orbit that attracts an oscillation of the end blocks in antiphase; raises OrbitError if none does."""
    state = ChainState(model.v * AMPLITUDE * np.array([1.0, 0.0, -1.0]), np.full(3, model.v), np.zeros(3, bool))
    orbit = limit_cycle(model, state, settling=SETTLING / recorded_a(model.law))
    if orbit.symmetry is not Symmetry.SYMMETRIC:
        raise OrbitError(f"{model.place}: no antiphase orbit found: the motion is not its own mirror image")
    return orbit


def antiphase_differences(linearized: Model, nonlinear: Model, a: float) -> tuple[float, float]:
    """Return the relative differences of ⟨J⟩ at an a, at a fixed v and at a fixed av; NaN as in VARIABLES.

    linearized, nonlinear : models of three blocks under these laws, at any a
    """
    if not 0.0 < a <= LARGEST_A:
        return np.nan, np.nan
    try:
        # The motion under the linearized law is proportional to v.
        orbits = [
            antiphase_orbit(model)
            for model in (linearized.at(a=a), nonlinear.at(a=a), nonlinear.at(a=a, v=nonlinear.v * LARGEST_A / a))
        ]
    except (OrbitError, ValueError) as error:
        print(f"antiphase orbit: {error}")
        return np.nan, np.nan
    if len({orbit.stop_counts for orbit in orbits}) > 1:
        return np.nan, np.nan
    first, at_v, at_av = (orbit.mean_distance / orbit.model.v for orbit in orbits)
    return round(at_v / first - 1.0, DIGITS), round(at_av / first - 1.0, DIGITS)
