"""Whether what looks like a torus is locked: the closed orbit that it drifts to, too slowly for that to be seen.

On a locked torus a trajectory comes back to where it was far more closely after a turn of the closed orbit than after
any shorter time: it has only drifted along a little. From there Newton's method finds the orbit, however slowly it
attracts. That it attracts this trajectory its last turns show: each is nearer to the orbit than the one before.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 7.3 (phase locking).
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.section_returns import state_of, visit
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry

# Turns of an orbit that have to fit into a window at least, and that have to come nearer and nearer at most.
MIN_CYCLES = 2
MAX_CYCLES = 4

# A torus may be locked if its motion was nearer to its last return, by this factor, than at any later time.
NEARER = 0.1

# It is locked to a stable orbit that it approaches, and lies no farther from, for v = 0.1.
MAX_LOCKED_DISTANCE = 0.03


def recurrence(times: np.ndarray, returns: np.ndarray) -> float:
    """Return how long before its last return a motion was nearest to it; 0 if that tells nothing.

    times, returns : of the motion, shapes (n,) and (n, 2 blocks)

    It tells that the motion may be locked if it was not nearly as near at any later time.
    """
    away = times[-1] - times[:-1]
    apart = np.abs(returns[:-1] - returns[-1]).max(axis=1)
    often = away <= (times[-1] - times[0]) / MIN_CYCLES
    away, apart = away[often], apart[often]
    if not len(away):
        return 0.0
    nearest = int(apart.argmin())
    shorter = apart[away < away[nearest]].min(initial=np.inf)
    return float(away[nearest]) if apart[nearest] <= NEARER * shorter else 0.0


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
    return orbit if multipliers(orbit).unstable == 0 and _is_approaching(returns, orbit) else None


def _is_approaching(returns: np.ndarray, orbit: PeriodicOrbit) -> bool:
    """Tell whether returns come nearer to a stable orbit with each turn."""
    around = visit(orbit.model, orbit.reference, 0.0, orbit.period)
    if around is None:
        return False
    count = len(around.returns)
    last = [returns[-count * (k + 1) : len(returns) - count * k] for k in range(min(len(returns) // count, MAX_CYCLES))]
    away = [distance(turn, around.returns) for turn in last]
    near = len(away) >= MIN_CYCLES and away[0] <= MAX_LOCKED_DISTANCE * orbit.model.scale
    return near and bool((np.diff(away) > 0.0).all())
