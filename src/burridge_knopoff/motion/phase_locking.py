"""Locking of motion that looks like a torus: the periodic orbit to which it drifts, too slowly for a repetition.

On a locked torus a trajectory returns much more closely after one period of the periodic orbit than after any shorter
time, because it drifts only a little in one period. From such a return Newton's method finds the orbit, however weakly
it attracts. The orbit attracts this trajectory if each of the last cycles is closer to the orbit than the one before.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 7.3 (phase locking).
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.section_returns import state_of, visit
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.periodic_orbits.floquet import unstable_count
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# Smallest number of cycles of an orbit in a window, and largest number of cycles that are tested for their approach.
MIN_CYCLES = 2
MAX_CYCLES = 4

# A torus may be locked if one earlier return was closer to the last return, by this factor, than all returns in
# between.
RECURRENCE_RATIO = 0.1

# Largest distance of the last cycle from the stable orbit to which the motion is locked, for v = 0.1.
MAX_LOCKED_DISTANCE = 0.03


def recurrence(times: np.ndarray, returns: np.ndarray) -> float:
    """Return the time from the closest earlier return to the last return, or 0 if it does not suggest locking.

    times, returns : of the motion, shapes (n,) and (n, 2 blocks)

    The motion may be locked if no return in between was nearly as close to the last return.
    """
    away = times[-1] - times[:-1]
    apart = np.abs(returns[:-1] - returns[-1]).max(axis=1)
    often = away <= (times[-1] - times[0]) / MIN_CYCLES
    away, apart = away[often], apart[often]
    if not len(away):
        return 0.0
    nearest = int(apart.argmin())
    shorter = apart[away < away[nearest]].min(initial=np.inf)
    return float(away[nearest]) if apart[nearest] <= RECURRENCE_RATIO * shorter else 0.0


def locked_orbit(model: Model, returns: np.ndarray, time: float) -> PeriodicOrbit | None:
    """Return the stable periodic orbit that a motion approaches; None if none is found.

    returns : of the motion in a window, shape (n, 2 blocks); time : their `recurrence`
    """
    if time == 0.0:
        return None
    try:
        orbit = find_periodic_orbit(model, state_of(returns[-1]), time, Symmetry.ASYMMETRIC)
    except OrbitError:
        return None
    return orbit if unstable_count(orbit) == 0 and _is_approaching(returns, orbit) else None


def _is_approaching(returns: np.ndarray, orbit: PeriodicOrbit) -> bool:
    """Return whether returns approach a stable orbit with each cycle."""
    around = visit(orbit.model, orbit.reference, 0.0, orbit.period)
    if around is None:
        return False
    count = len(around.returns)
    last = [returns[-count * (k + 1) : len(returns) - count * k] for k in range(min(len(returns) // count, MAX_CYCLES))]
    away = [distance(cycle, around.returns) for cycle in last]
    near = len(away) >= MIN_CYCLES and away[0] <= MAX_LOCKED_DISTANCE * orbit.model.scale
    return near and bool((np.diff(away) > 0.0).all())
