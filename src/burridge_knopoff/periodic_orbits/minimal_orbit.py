"""Reduction of an orbit to its minimal form: the most symmetric orbit, with the shortest period, that it traverses."""

from __future__ import annotations

from collections.abc import Iterator
from math import gcd

import numpy as np

from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.return_map import ReturnMap
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import velocity_maxima

# Distance, for v = 0.1 in the chain's own units, within which an orbit counts as more symmetric or of a shorter period.
SAME_STATE = 1e-8

# Largest relative change of the return time; beyond it Newton's method has converged to another orbit.
SAME_TIME = 0.05


def minimal_form(orbit: PeriodicOrbit, tolerance: float) -> PeriodicOrbit:
    """Return the most symmetric form of an orbit with the shortest return; the orbit itself if there is no simpler one.

    The simpler orbit, traversed as often as necessary, has the same stops.

    tolerance : largest distance, for v = 0.1 in the chain's own units, between the states of both orbits; above
        rounding errors to detect orbits at which a branch of less symmetric orbits, or of twice the period, begins
    """
    for time, symmetry in _reduced_forms(orbit):
        if time > 0.0:
            end = ReturnMap(orbit.model, symmetry).end(orbit.reference, time)
        else:
            end, time = orbit.reference.mirrored(), orbit.period
        if np.abs((end.vector() - orbit.reference.vector()) / orbit.model.state_scale).max() > tolerance:
            continue
        try:
            simpler = find_periodic_orbit(orbit.model, orbit.reference, time, symmetry)
        except OrbitError:
            continue
        if abs(simpler.return_time - time) > SAME_TIME * time:
            continue
        repeats = round(orbit.period / simpler.period)
        if tuple(repeats * stops for stops in simpler.stop_counts) == orbit.stop_counts:
            return minimal_form(simpler, tolerance)
    return orbit


def reduced_orbit(orbit: PeriodicOrbit) -> PeriodicOrbit | None:
    """Return the more symmetric or shorter form that an orbit has up to rounding errors; None if there is none."""
    mirrored = orbit.symmetry == Symmetry.ASYMMETRIC and orbit.stop_counts == orbit.stop_counts[::-1]
    if not mirrored and gcd(*orbit.stop_counts) == 1:
        return None
    simpler = minimal_form(orbit, SAME_STATE)
    return None if simpler is orbit else simpler


def _reduced_forms(orbit: PeriodicOrbit) -> Iterator[tuple[float, Symmetry]]:
    """Yield the return times and symmetries that simpler forms may have; a time of 0 means the state itself."""
    if orbit.symmetry != Symmetry.SYNCHRONIZED and orbit.model.chain.is_mirror_symmetric:
        yield 0.0, Symmetry.SYNCHRONIZED
    for part in _possible_repeats(orbit):
        if orbit.symmetry != Symmetry.SYMMETRIC or part % 2:
            yield orbit.return_time / part, orbit.symmetry
    if orbit.symmetry == Symmetry.ASYMMETRIC and orbit.model.chain.is_mirror_symmetric:
        yield orbit.period / 2, Symmetry.SYMMETRIC


def _possible_repeats(orbit: PeriodicOrbit) -> list[int]:
    """Return the prime numbers of times that an orbit may traverse a shorter one, by its stops or velocity maxima."""
    if any(orbit.stop_counts):
        return _prime_factors(gcd(*orbit.stop_counts))
    maxima = velocity_maxima(orbit.model, orbit.reference, 0.0, orbit.period)[1]
    # A maximum at the reference is counted at neither or both ends of the period.
    most = int(np.bincount(maxima[:, 0].astype(int)).max(initial=0)) + 1
    return [part for part in range(2, most + 1) if _prime_factors(part) == [part]]


def _prime_factors(number: int) -> list[int]:
    """Return the distinct prime factors of a number."""
    divisors = [part for part in range(2, number + 1) if number % part == 0]
    return [part for part in divisors if all(part % other for other in divisors if other < part)]
