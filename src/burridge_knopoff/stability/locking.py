"""Whether what looks like a torus is locked: the closed orbit that it drifts to, too slowly for that to be seen.

On a locked torus a trajectory comes back to where it was more closely after a turn of the closed orbit than after other
times: it has only drifted along a little. From there Newton's method finds the orbit, however slowly it attracts. That
it attracts this trajectory its last turns show: each is nearer to the orbit than the one before.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Section 7.3 (phase locking).
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.orbits.floquet import multipliers
from burridge_knopoff.orbits.orbit import OrbitError
from burridge_knopoff.orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.stability.nearness import distance
from burridge_knopoff.stability.returns import Returns, returns_of, visit
from burridge_knopoff.stability.tuning import TUNING, Tuning

# Turns of an orbit that have to fit into the window at least, and that have to come nearer and nearer at most.
FEWEST_TURNS = 2
MOST_TURNS = 4


def locked_orbit(model: Model, start: Instant, window: float, tuning: Tuning = TUNING) -> PeriodicOrbit | None:
    """Return the stable periodic orbit that a motion approaches; None if none is found.

    start : a state that has settled on what may be a torus
    window : time for which it is followed, twice the longest period that is found
    """
    runner = Runner(model, keep_events=True)
    runner.begin(start)
    if runner.run(window) != Status.COMPLETED:
        return None
    times, values = runner.log.events.times(), runner.log.events.values()
    found = returns_of(model, values[:, 0], values[:, 1], values[:, 2:], tuning)
    if found is None:
        return None
    times = times[(values[:, 0] == found.block) & (values[:, 1] == 0)]
    passed = times[-1] - times
    apart = np.abs(found.returns - found.returns[-1]).max(axis=1)
    nearest = [k for k in np.argsort(apart) if 0.0 < passed[k] <= window / FEWEST_TURNS]
    for k in nearest[: tuning.nearest_returns]:
        try:
            orbit = find_periodic_orbit(model, found.instant(), float(passed[k]), Symmetry.ASYMMETRIC)
        except OrbitError:
            continue
        if multipliers(orbit).unstable == 0 and _approaches(found, passed, orbit, tuning):
            return orbit
    return None


def _approaches(found: Returns, passed: np.ndarray, orbit: PeriodicOrbit, tuning: Tuning) -> bool:
    """Tell whether the returns, of which so much time has passed, come nearer to a stable orbit with each turn."""
    around = visit(orbit.model, orbit.reference, 0.0, orbit.period, tuning)
    if around is None or around.block != found.block:
        return False
    turn = passed // orbit.period
    turns = range(min(int(turn[0]), MOST_TURNS))
    away = [distance(found.returns[turn == k], around.returns, tuning.near_share) for k in turns]
    return away[0] <= tuning.locked * orbit.model.scale and bool((np.diff(away) > 0.0).all())
