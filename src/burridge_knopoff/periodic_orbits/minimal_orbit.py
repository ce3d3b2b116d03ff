"""Reduce an orbit to its minimal, most symmetric form, which may have a shorter period, gone round often."""

from __future__ import annotations

from collections.abc import Iterator
from math import gcd

import numpy as np

from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.return_map import ReturnMap
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# Distance, for v = 0.1, within which an orbit is one of more symmetry, or of a shorter period.
SAME = 1e-8

# Share of the time within which the simpler orbit has to return; else Newton's method has come to another one.
SAME_TIME = 0.05


def simplest(orbit: PeriodicOrbit, tolerance: float) -> PeriodicOrbit:
    """Return the orbit of the most symmetry and the shortest return that an orbit is; itself if there is none.

    The simpler orbit has the same stops, gone round as often as it takes.

    tolerance : how far, for v = 0.1, its state may be from where the simpler orbit would be; a branch of orbits of less
        symmetry, or of twice the period, begins at such orbits
    """
    for time, symmetry in _simpler(orbit):
        if time > 0.0:
            end = ReturnMap(orbit.model, symmetry).end(orbit.reference, time)
        else:
            end, time = orbit.reference.mirrored(), orbit.period
        if np.abs(end.vector() - orbit.reference.vector()).max() > tolerance * orbit.model.scale:
            continue
        try:
            found = find_periodic_orbit(orbit.model, orbit.reference, time, symmetry)
        except OrbitError:
            continue
        if abs(found.return_time - time) > SAME_TIME * time:
            continue
        turns = round(orbit.period / found.period)
        if tuple(turns * stops for stops in found.stop_counts) == orbit.stop_counts:
            return simplest(found, tolerance)
    return orbit


def simpler_orbit(orbit: PeriodicOrbit) -> PeriodicOrbit | None:
    """Return the orbit of more symmetry, or of a shorter period, that one is to rounding; None if it is its own."""
    mirrored = orbit.symmetry == Symmetry.ASYMMETRIC and orbit.stop_counts == orbit.stop_counts[::-1]
    if not mirrored and gcd(*orbit.stop_counts) == 1:
        return None
    found = simplest(orbit, SAME)
    return None if found is orbit else found


def _simpler(orbit: PeriodicOrbit) -> Iterator[tuple[float, Symmetry]]:
    """Yield times after which a simpler orbit would have returned, and its symmetry; 0 if it is the state itself."""
    if orbit.symmetry != Symmetry.SYNCHRONIZED and orbit.model.chain.is_mirror_symmetric:
        yield 0.0, Symmetry.SYNCHRONIZED
    for part in _prime_factors(gcd(*orbit.stop_counts)):
        if orbit.symmetry != Symmetry.SYMMETRIC or part % 2:
            yield orbit.return_time / part, orbit.symmetry
    if orbit.symmetry == Symmetry.ASYMMETRIC and orbit.model.chain.is_mirror_symmetric:
        yield orbit.period / 2, Symmetry.SYMMETRIC


def _prime_factors(number: int) -> list[int]:
    """Return the primes that divide a number of turns, each once."""
    divisors = [part for part in range(2, number + 1) if number % part == 0]
    return [part for part in divisors if all(part % other for other in divisors if other < part)]
