"""Bifurcations of the synchronized orbit: a_c, where mirror synchrony breaks, grazing of a block, and period doubling.

The bifurcations are located along the branch. The root in a of the function that vanishes at each of them, on orbits
solved to rounding accuracy, then gives a to the last digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from dataclasses import replace

import numpy as np
from scipy.optimize import brentq

from burridge_knopoff.model.model import ChainState
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation, locate_bifurcations
from burridge_knopoff.periodic_orbits.critical_values import critical_values
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError, new_runner, state_after
from burridge_knopoff.periodic_orbits.following import CONTINUATION, follow
from burridge_knopoff.periodic_orbits.grazing_distances import grazing_distances
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits, nearby_orbit
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.return_map import symmetry_breaking_directions

#: Range of a, in units of `Chain.a_unit`, in which bifurcations are searched for, and steps in a. They do not depend on
#: the grid of a study. Where a branch ends, the search resumes RESTART_GAP beyond.
RANGE = (0.0125, 0.3)
FIRST_STEP = 1e-3
LARGEST_STEP = 5e-3
RESTART_GAP = 0.0125

# Half-widths of brackets of a root, in the chain's own unit of a, to be tried in turn. The root is found to the
# rounding error of the function. In such narrow brackets brentq only bisects and may need more iterations than usual.
BRACKETS = (1e-9, 1e-8, 1e-7, 1e-6)
TOLERANCE = 1e-15
ITERATIONS = 1000

# Largest distance of the critical multiplier at a bifurcation from −1, or from the unit circle.
CRITICAL = 1e-5

# Difference d of mirror blocks for finite differences, in units of v, for times in the own unit: the rounding error of
# the quotient and the remaining error of order d⁴ are both about 1e-12.
DIFFERENCE = 1e-3

# Step in a, in units of `Chain.a_unit`, for the slope of the multiplier.
SLOPE_STEP = 1e-4


def bifurcations_of(orbits: KnownOrbits) -> list[Bifurcation]:
    """Return the bifurcations of the synchronized orbits, in ascending order of a."""
    return sorted(_each_bifurcation(orbits), key=lambda bifurcation: bifurcation.a)


def _each_bifurcation(orbits: KnownOrbits) -> Iterator[Bifurcation]:
    """Yield the bifurcations along the orbits; beyond the end of a branch, continue both ways from the next orbit."""
    if "a" not in orbits.model.law.names:
        return
    size = orbits.model.chain.a_unit
    (first, high), gap = (size * end for end in RANGE), size * RESTART_GAP
    # `follow` measures its steps in the chain's own unit.
    share = size / orbits.model.chain.own_units.slope
    settings = replace(
        CONTINUATION,
        first_step=share * FIRST_STEP,
        largest_step=share * LARGEST_STEP,
        smallest_step=share * CONTINUATION.smallest_step,
    )
    low, a = first, first
    while a < high:
        try:
            start = orbits.at(a)
            if a > low:
                yield from locate_bifurcations(follow(start, (low, high), settings, upward=False, parameter="a"))
            points = follow(start, (a, high), settings, parameter="a")
        except OrbitError:
            a += gap
            continue
        yield from locate_bifurcations(points)
        low = max(point.orbit.a for point in points)
        a = low + gap


def critical_a(bifurcations: list[Bifurcation]) -> float:
    """Return a_c, at which the leading transverse multiplier reaches the unit circle; NaN if it does not.

    Only where the orbit attracts within synchrony does its stability change there: if it does at some of these values,
    a_c is the smallest of them, otherwise the smallest of all.
    """

    def distance(orbit: PeriodicOrbit) -> float:
        return abs(multipliers(orbit).transverse) - 1.0

    kinds = BifurcationKind.PITCHFORK, BifurcationKind.PERIOD_DOUBLING, BifurcationKind.NEIMARK_SACKER
    crossings = [item for item in bifurcations if item.kind in kinds and abs(distance(item.at.orbit)) < CRITICAL]
    stable = [crossing for crossing in crossings if crossing.at.multipliers.attracts_within_synchrony]
    return _smallest_a(stable or crossings, lambda _: True, distance)


def symmetric_period_doubling_a(bifurcations: list[Bifurcation]) -> float:
    """Return the a at which a multiplier of mirror-symmetric perturbations reaches −1; NaN if none does."""

    def is_period_doubling(bifurcation: Bifurcation) -> bool:
        return (
            bifurcation.kind == BifurcationKind.PERIOD_DOUBLING
            and float(np.abs(bifurcation.at.multipliers.symmetry_preserving + 1.0).min()) < CRITICAL
        )

    return _smallest_a(
        bifurcations,
        is_period_doubling,
        lambda orbit: critical_values(orbit)[BifurcationKind.PERIOD_DOUBLING, "symmetry_preserving"],
    )


def grazing_a(bifurcations: list[Bifurcation], block: int) -> float:
    """Return the a at which a block, numbered from 0, begins to stick; NaN if it does not.

    On one side the smallest speed of the block is positive. On the other side the duration of the stick grows as the
    square root of the distance, so that minus its square continues the smallest speed through 0. If friction drops at
    the start of a slip, no stick begins this way, and the branch ends.
    """

    def is_first_stick(bifurcation: Bifurcation) -> bool:
        if bifurcation.kind != BifurcationKind.GRAZING or bifurcation.after is None:
            return False
        return (bifurcation.before.orbit.stop_counts[block] == 0) != (bifurcation.after.orbit.stop_counts[block] == 0)

    def signed_least_speed(orbit: PeriodicOrbit) -> float:
        distances = grazing_distances(orbit)
        return -float(distances.stick[block] ** 2) if orbit.stop_counts[block] else float(distances.speed[block])

    return _smallest_a(bifurcations, is_first_stick, signed_least_speed)


def _smallest_a(
    bifurcations: list[Bifurcation], is_one: Callable[[Bifurcation], bool], value: Callable[[PeriodicOrbit], float]
) -> float:
    """Return the smallest a of the bifurcations that satisfy a predicate, from the root of a function; NaN if none."""
    bifurcation = next((bifurcation for bifurcation in bifurcations if is_one(bifurcation)), None)
    return math.nan if bifurcation is None else _root(bifurcation, value)


def _root(bifurcation: Bifurcation, value: Callable[[PeriodicOrbit], float]) -> float:
    """Return the root in a of a function of the orbit near a bifurcation; the a of the bifurcation if there is none."""
    orbit = bifurcation.at.orbit
    unit = orbit.model.chain.own_units.slope
    for side in BRACKETS:
        ends = bifurcation.a - unit * side, bifurcation.a + unit * side
        try:
            if (value(nearby_orbit(orbit, ends[0])) > 0.0) != (value(nearby_orbit(orbit, ends[1])) > 0.0):
                precise = {"xtol": unit * TOLERANCE, "rtol": TOLERANCE, "maxiter": ITERATIONS}
                return float(brentq(lambda a: value(nearby_orbit(orbit, a)), *ends, **precise))
        except OrbitError:
            continue
    return bifurcation.a


def finite_difference_multiplier(orbit: PeriodicOrbit) -> complex:
    """Return the leading transverse multiplier of a synchronized orbit without the tangent map.

    Mirror blocks are displaced by d and followed for a period. By mirror symmetry their difference after the period is
    an odd function of d, so that one step of Richardson extrapolation leaves an error of order d⁴.
    """
    runner, start, blocks = new_runner(orbit.model), orbit.reference, orbit.model.blocks
    basis, units = symmetry_breaking_directions(start.stuck), orbit.model.chain.own_units
    scale = units.state(blocks)

    def difference_quotient(direction: np.ndarray, d: float) -> np.ndarray:
        state = start.vector() + d * scale * direction
        end = state_after(runner, ChainState(state[:blocks], state[blocks:], start.stuck), orbit.return_time)
        return basis.T @ (end.vector() / scale) / d

    d = DIFFERENCE * orbit.model.v / units.velocity
    columns = [
        (4.0 * difference_quotient(direction, 0.5 * d) - difference_quotient(direction, d)) / 3.0
        for direction in basis.T
    ]
    values = np.linalg.eigvals(np.stack(columns, axis=1))
    return complex(values[np.abs(values).argmax()])


def transverse_slope(orbits: KnownOrbits, a: float) -> float:
    """Return the derivative of the modulus of the transverse multiplier by a; NaN if a nearby orbit is not found."""
    step = SLOPE_STEP * orbits.model.chain.a_unit
    try:
        low, high = (abs(multipliers(orbits.at(a + side * step)).transverse) for side in (-1, 1))
    except OrbitError:
        return math.nan
    return (high - low) / (2.0 * step)


def critical_a_error(orbits: KnownOrbits, a: float) -> float:
    """Return the change of a_c if finite differences replace the tangent map; NaN if a nearby orbit is not found."""
    orbit, slope = orbits.at(a), transverse_slope(orbits, a)
    return abs((abs(finite_difference_multiplier(orbit)) - abs(multipliers(orbit).transverse)) / slope)
