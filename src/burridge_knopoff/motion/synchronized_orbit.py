"""The synchronized orbit of a chain that is its own mirror image: mirror blocks move identically on it.

It is the orbit on which the end blocks stop once in a period, if there is one. Other synchronized motion may coexist.

A run from rest stays mirror-symmetric to the bit and settles on this orbit at moderate a, or on an orbit without stops
at the a of the model. From there the orbit is continued, whether it is stable or not.
"""

from __future__ import annotations

from itertools import pairwise

import numpy as np

from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.limit_cycle import orbit_of_motion
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import instance_of

# At the friction parameters SEEDS, a run from rest has settled after SETTLING and repeats within LONGEST_PERIOD, both
# in the chain's own unit of time.
SETTLING = 4000.0
LONGEST_PERIOD = 500.0
SEEDS = (0.05, 0.1, 0.02, 0.2)

# Number of cycles of the run in which an orbit of one cycle is sought.
CYCLES = 8


def synchronized_orbit(model: Model) -> PeriodicOrbit:
    """Return the synchronized orbit of a model on which the end blocks stop once in a period, stable or not.

    model : with any number of blocks; the chain must be its own mirror image

    Raises OrbitError, a ValueError, if it is not, or if no orbit is found.

    Without such an orbit, the orbit is that on which a run from rest settles. If not `attracts_within_synchrony` of its
    `multipliers`, synchronized motion of another period may attract: `transverse_exponent` says whether that from a
    state does. docs/synchronization.md derives where the orbit of three blocks is stable.

    >>> from burridge_knopoff import Model, multipliers, synchronized_orbit
    >>> model = Model("linearized", a=0.08)
    >>> orbit = synchronized_orbit(model)
    >>> round(orbit.period, 6), orbit.stop_counts
    (5.672418, (1, 1, 1))
    >>> round(multipliers(orbit).transverse.real, 4)
    0.9589
    """
    return synchronized_orbits(instance_of(model, Model, "model")).at(recorded_a(model.law))


def synchronized_orbits(model: Model) -> KnownOrbits:
    """Return the synchronized orbits of a model over a.

    model : at any a

    Raises OrbitError if its chain is not its own mirror image, or if no orbit is found at any of the SEEDS or at the
    a of the model.
    """
    if not model.chain.is_mirror_symmetric:
        raise OrbitError("chain: got a chain that is not its own mirror image, expected one that is")
    seeds = [model.chain.a_unit * a for a in SEEDS] if "a" in model.law.names else []
    for find, values in (
        (_single_cycle_orbit, seeds or [recorded_a(model.law)]),
        (_settled_orbit, [*seeds, recorded_a(model.law)]),
    ):
        for a in values:
            try:
                return KnownOrbits(find(model_at(model, a)))
            except OrbitError:
                continue
    at = f", nor at a = {', '.join(map(repr, seeds))}" if seeds else ""
    raise OrbitError(f"{model.place}: no synchronized periodic orbit{at}")


def _state_at_rest(model: Model) -> ChainState:
    return ChainState(np.zeros(model.blocks), np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))


def _single_cycle_orbit(model: Model) -> PeriodicOrbit:
    """Return the orbit on which the end blocks stop once per period, from the last cycles of a run from rest.

    The run itself may settle on another synchronized motion, with several stops per period.
    """
    unit_of_time = model.chain.own_units.time
    runner = Runner(model, keep_events=True, events_from=SETTLING * unit_of_time, stops_only=True)
    runner.begin(_state_at_rest(model))
    if runner.run((SETTLING + LONGEST_PERIOD) * unit_of_time) != Status.COMPLETED:
        raise OrbitError(f"{model.place}: the run from rest ends at τ = {runner.clock!r}")
    times, values = runner.log.events.times(), runner.log.events.values()
    stops = np.flatnonzero(values[:, 0] == 1)[-CYCLES - 1 :]
    for first, second in pairwise(stops.tolist()):
        try:
            orbit = find_periodic_orbit(
                model, state_of(values[first, 2:]), float(times[second] - times[first]), Symmetry.SYNCHRONIZED
            )
        except OrbitError:
            continue
        if orbit.stop_counts[0] == 1:
            return orbit
    raise OrbitError(f"{model.place}: no synchronized orbit with one stop per period")


def _settled_orbit(model: Model) -> PeriodicOrbit:
    """Return the orbit on which a run from rest settles."""
    unit_of_time = model.chain.own_units.time
    return orbit_of_motion(model, _state_at_rest(model), SETTLING * unit_of_time, LONGEST_PERIOD * unit_of_time)
