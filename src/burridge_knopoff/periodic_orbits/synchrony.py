"""Where the synchronized orbit changes: at a_c it is lost, at a grazing a block begins to stick, at a flip it doubles.

The edges along the followed branch tell which changes there are. A root in a of what is 0 there, on orbits solved down
to rounding, then gives their a to the last digits.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator

import numpy as np
from scipy.optimize import brentq

from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import Instant
from burridge_knopoff.periodic_orbits.contacts import contacts
from burridge_knopoff.periodic_orbits.edge_kind import EdgeKind
from burridge_knopoff.periodic_orbits.edges import Edge, locate_edges
from burridge_knopoff.periodic_orbits.floquet import critical_values, multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError, after
from burridge_knopoff.periodic_orbits.following import Following, follow
from burridge_knopoff.periodic_orbits.known import KnownOrbits, beside
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.periodic_orbits.return_map import parting
from burridge_knopoff.running.runner import Runner

#: Friction parameters, in those of `unit`, between which changes are looked for, and steps in a: the grid of a study
#: has no part in them. Where a branch ends it is looked for again this far on.
RANGE = (0.0125, 0.3)
FIRST_STEP = 1e-3
LARGEST_STEP = 5e-3
AGAIN = 0.0125

# A root is held from both sides at these distances, in turn, and found to the rounding of the function. With steps that
# small brentq only bisects, and its usual hundred iterations may not be enough.
SIDES = (1e-9, 1e-8, 1e-7, 1e-6)
TOLERANCE = 1e-15
ITERATIONS = 1000

# How near to −1, or to the unit circle, the multiplier is that an edge is about.
CRITICAL = 1e-5

# Difference d of mirror blocks for finite differences, in units of v: rounding of the quotient and the d⁴ that
# extrapolation leaves are about 1e-12 both.
DIFFERENCE = 1e-3

# Step in a, in units of `unit`, for the slope of the multiplier.
SLOPE_STEP = 1e-4


def unit(chain: Chain) -> float:
    """Return the a by which friction changes a slip in a chain as much as a = 1 does in the paper's; 1 in that.

    Springs that are stronger by a factor make all motion faster by its root; a mode grows with a times the threshold.
    """
    return math.sqrt(float(chain.driving[chain.driving > 0.0].min())) / float(chain.thresholds.max())


def edges_of(orbits: KnownOrbits) -> list[Edge]:
    """Return the edges of the synchronized orbits, a ascending."""
    return sorted(_each_edge(orbits), key=lambda edge: edge.a)


def _each_edge(orbits: KnownOrbits) -> Iterator[Edge]:
    """Follow the orbits upward, and where a branch ends go on with what there is beyond, both ways."""
    size = unit(orbits.model.chain)
    (first, high), gap = (size * end for end in RANGE), size * AGAIN
    settings = Following(first_step=size * FIRST_STEP, largest_step=size * LARGEST_STEP)
    low, a = first, first
    while a < high:
        try:
            start = orbits.at(a)
            if a > low:
                yield from locate_edges(follow(start, (low, high), settings, upward=False))
            points = follow(start, (a, high), settings)
        except OrbitError:
            a += gap
            continue
        yield from locate_edges(points)
        low = max(point.orbit.a for point in points)
        a = low + gap


def critical_a(edges: list[Edge]) -> float:
    """Return a_c, where the leading transverse multiplier reaches the unit circle; NaN if it does not."""

    def distance(orbit: PeriodicOrbit) -> float:
        return abs(multipliers(orbit).transverse) - 1.0

    kinds = EdgeKind.PITCHFORK, EdgeKind.FLIP, EdgeKind.NEIMARK_SACKER
    return _least(edges, lambda edge: edge.kind in kinds and abs(distance(edge.at.orbit)) < CRITICAL, distance)


def symmetric_flip_a(edges: list[Edge]) -> float:
    """Return the a at which a multiplier of mirror-symmetric perturbations reaches −1; NaN if none does."""

    def is_flip(edge: Edge) -> bool:
        return edge.kind == EdgeKind.FLIP and float(np.abs(edge.at.multipliers.keeping + 1.0).min()) < CRITICAL

    return _least(edges, is_flip, lambda orbit: critical_values(orbit)[EdgeKind.FLIP, "keeping"])


def grazing_a(edges: list[Edge], block: int) -> float:
    """Return the a at which a block, from 0, begins to stick; NaN if it does not.

    On one side of it the least speed of the block is positive. On the other one the stick lasts about the square root
    of the distance from it, so that minus the square of its length continues the least speed through 0. Where friction
    drops at the start of a slip no stick begins so: the branch ends.
    """

    def begins(edge: Edge) -> bool:
        if edge.kind != EdgeKind.GRAZING or edge.after is None:
            return False
        return (edge.before.orbit.signature[block] == 0) != (edge.after.orbit.signature[block] == 0)

    def least(orbit: PeriodicOrbit) -> float:
        found = contacts(orbit)
        return -float(found.stick[block] ** 2) if orbit.signature[block] else float(found.speed[block])

    return _least(edges, begins, least)


def _least(edges: list[Edge], is_one: Callable[[Edge], bool], value: Callable[[PeriodicOrbit], float]) -> float:
    """Return the least a of the edges of a kind, as a root of what is 0 there; NaN if there is none."""
    edge = next((edge for edge in edges if is_one(edge)), None)
    return math.nan if edge is None else _root(edge, value)


def _root(edge: Edge, value: Callable[[PeriodicOrbit], float]) -> float:
    """Return the root in a of a function of the orbit next to an edge; its own a if the function has none there."""
    orbit = edge.at.orbit
    for side in SIDES:
        ends = edge.a - side, edge.a + side
        try:
            if (value(beside(orbit, ends[0])) > 0.0) != (value(beside(orbit, ends[1])) > 0.0):
                precise = {"xtol": TOLERANCE, "rtol": TOLERANCE, "maxiter": ITERATIONS}
                return float(brentq(lambda a: value(beside(orbit, a)), *ends, **precise))
        except OrbitError:
            continue
    return edge.a


def differenced_multiplier(orbit: PeriodicOrbit) -> complex:
    """Return the leading transverse multiplier of a synchronized orbit without the tangent map.

    Mirror blocks are moved apart by d and followed for a period. By mirror symmetry what is left of d is an odd
    function of d, so that one step of Richardson's extrapolation leaves an error of order d⁴.
    """
    runner, start, blocks = Runner(orbit.model), orbit.reference, orbit.model.blocks
    basis = parting(start.stuck)

    def returned(direction: np.ndarray, d: float) -> np.ndarray:
        state = start.vector() + d * direction
        end = after(runner, Instant(state[:blocks], state[blocks:], start.stuck), orbit.return_time)
        return basis.T @ end.vector() / d

    d = DIFFERENCE * orbit.model.v
    columns = [(4.0 * returned(direction, 0.5 * d) - returned(direction, d)) / 3.0 for direction in basis.T]
    values = np.linalg.eigvals(np.stack(columns, axis=1))
    return complex(values[np.abs(values).argmax()])


def critical_a_error(orbits: KnownOrbits, a: float) -> float:
    """Return by how much a_c changes if finite differences replace the tangent map; NaN if the orbit is lost nearby."""
    orbit, step = orbits.at(a), SLOPE_STEP * unit(orbits.model.chain)
    try:
        low, high = (abs(multipliers(orbits.at(a + side * step)).transverse) for side in (-1, 1))
    except OrbitError:
        return math.nan
    slope = (high - low) / (2.0 * step)
    return abs((abs(differenced_multiplier(orbit)) - abs(multipliers(orbit).transverse)) / slope)
