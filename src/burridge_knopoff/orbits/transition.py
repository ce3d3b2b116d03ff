"""Where the synchronized orbit changes: at a_c it is lost, and at grazing_a block 2 begins to stick.

Both are the least a at which a continuous function of the orbit changes its sign.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from contextlib import suppress
from itertools import pairwise

import numpy as np
from scipy.optimize import brentq, minimize_scalar

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Instant
from burridge_knopoff.orbits.family import Family
from burridge_knopoff.orbits.orbit import Orbit, OrbitError, after, multipliers, transverse_multiplier
from burridge_knopoff.running.runner import Runner

#: Friction parameters, in those of `unit`, between which a change of the orbit is looked for; they do not depend on the
#: grid of a study.
SCAN = tuple(round(0.0125 * k, 4) for k in range(1, 25))

# A change of the orbit is found to the rounding of the function that changes its sign there. With steps that small
# brentq only bisects, and its usual hundred iterations may not be enough.
TOLERANCE = 1e-15
ITERATIONS = 1000

# How near to where the orbit is lost a change of it is looked for, in units of `unit`.
CLOSEST = 1e-5

# Asymmetry d for finite differences, in units of v: rounding of the quotient and the d⁴ that extrapolation leaves are
# about 1e-12 both.
DIFFERENCE = 1e-3

# Step in a, in units of `unit`, for the slope of the multiplier.
SLOPE_STEP = 1e-4

# Instants of a period between which the least speed is looked for.
SAMPLES = 96


def unit(chain: Chain) -> float:
    """Return the a by which friction changes a slip in a chain as much as a = 1 does in the paper's; 1 in that.

    Springs that are stronger by a factor make all motion faster by its root; a mode grows with a times the threshold.
    """
    return math.sqrt(float(chain.driving[chain.driving > 0.0].min())) / float(chain.thresholds.max())


def critical_a(family: Family) -> float:
    """Return a_c, where the modulus of the transverse multiplier reaches 1; NaN if it does not."""
    return change_point(family, lambda orbit: abs(transverse_multiplier(orbit)) - 1.0)


def symmetric_flip_a(family: Family) -> float:
    """Return the a at which a multiplier of mirror-symmetric perturbations reaches −1; NaN if none does."""
    return change_point(family, lambda orbit: float(np.prod(multipliers(orbit)[2:4] + 1.0).real))


def grazing_a(family: Family) -> float:
    """Return the a at which block 2 begins to stick; NaN if it does not.

    Below it the least speed of block 2 is positive. Above it the stick lasts about the square root of the distance from
    it, so that minus the square of its length continues the least speed through 0.
    """
    return change_point(family, lambda orbit: least_center_speed(orbit) or -(orbit.center_stick_time**2))


def change_point(family: Family, value: Callable[[Orbit], float]) -> float:
    """Return the least a in the scanned range at which a function of the orbit changes its sign; NaN if it does not.

    A change at which the orbit itself is lost does not count: where friction drops at the start of a slip, a stick of
    block 2 does not begin at length 0, and the orbit jumps.
    """
    scanned = (_at(family, value, a) for a in (unit(family.model.chain) * np.array(SCAN)).tolist())
    found = (_change(family, value, low, high) for low, high in pairwise(scanned))
    return next((a for a in found if not math.isnan(a)), math.nan)


def _at(family: Family, value: Callable[[Orbit], float], a: float) -> tuple[float, float]:
    """Return a and what a function of the orbit is there; NaN where the orbit is lost."""
    try:
        return a, value(family.at(a))
    except OrbitError:
        return a, math.nan


def _change(
    family: Family, value: Callable[[Orbit], float], low: tuple[float, float], high: tuple[float, float]
) -> float:
    """Return the least a between two that `_at` tells of at which the function changes its sign; NaN if there is none.

    Where the orbit is lost in between, or at one of them, it is looked for on both sides of that.
    """
    lost = math.isnan(low[1]) + math.isnan(high[1])
    if lost == 2 or (lost == 0 and (low[1] > 0.0) == (high[1] > 0.0)):
        return math.nan
    if lost == 0:
        with suppress(OrbitError):
            precise = {"xtol": TOLERANCE, "rtol": TOLERANCE, "maxiter": ITERATIONS}
            return float(brentq(lambda a: value(family.at(a)), low[0], high[0], **precise))
    if high[0] - low[0] < CLOSEST * unit(family.model.chain):
        return math.nan
    middle = _at(family, value, 0.5 * (low[0] + high[0]))
    below = _change(family, value, low, middle)
    return _change(family, value, middle, high) if math.isnan(below) else below


def least_center_speed(orbit: Orbit) -> float:
    """Return the least speed of block 2 in a period, 0 if it sticks."""
    if orbit.center_stick_time > 0.0:
        return 0.0
    time = np.linspace(0.0, orbit.period, SAMPLES + 1)
    runner = Runner(orbit.model)

    def speed(t: float) -> float:
        return float(after(runner, orbit.reference, t).velocity[1])

    slowest = min(range(1, SAMPLES), key=lambda k: speed(float(time[k])))
    bounds = (time[slowest - 1], time[slowest + 1])
    return float(minimize_scalar(speed, bounds=bounds, method="bounded", options={"xatol": 1e-10}).fun)


def apart(state: Instant, asymmetry: float) -> Instant:
    """Return a state with block 1 moved forward and block 3 back, by half the asymmetry each."""
    shift = np.array([0.5 * asymmetry, 0.0, -0.5 * asymmetry])
    return Instant(state.position + shift, state.velocity, state.stuck)


def finite_difference_multiplier(orbit: Orbit) -> float:
    """Return the transverse multiplier of a synchronized orbit without the tangent map.

    Blocks 1 and 3 are moved apart by d and followed for a period. By mirror symmetry what is left of d is an odd
    function of d, so that one step of Richardson's extrapolation leaves an error of order d⁴.
    """
    runner = Runner(orbit.model)

    def ratio(d: float) -> float:
        end = after(runner, apart(orbit.reference, d), orbit.period)
        return float(end.position[0] - end.position[2]) / d

    d = DIFFERENCE * orbit.model.v
    return (4.0 * ratio(0.5 * d) - ratio(d)) / 3.0


def critical_a_error(family: Family, a: float) -> float:
    """Return by how much a_c changes if finite differences replace the tangent map; NaN if the orbit is lost nearby."""
    orbit, step = family.at(a), SLOPE_STEP * unit(family.model.chain)
    try:
        low, high = (transverse_multiplier(family.at(a + side * step)) for side in (-1, 1))
    except OrbitError:
        return math.nan
    slope = (high - low) / (2.0 * step)
    return abs((finite_difference_multiplier(orbit) - transverse_multiplier(orbit)) / slope)
