"""The synchronized orbit of a chain that is its own mirror image: the one on which mirror blocks move as one.

A run from rest stays mirror-symmetric to the bit, and ends on it at moderate a; from there it is continued, whether it
is stable or not.
"""

from __future__ import annotations

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.periodic_orbits.flow import OrbitError, model_at
from burridge_knopoff.periodic_orbits.known_orbits import KnownOrbits
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.values import instance_of

# A run from rest has settled after this time at the friction parameters that orbits are continued from, and returns
# within the other one.
SETTLING = 4000.0
LONGEST_PERIOD = 500.0
SEEDS = (0.05, 0.1, 0.02, 0.2)


def synchronized_orbit(model: Model) -> PeriodicOrbit:
    """Return the synchronized orbit of a model, whether it is stable or not.

    model : of any number of blocks; the chain has to be its own mirror image

    Raises OrbitError, a ValueError, if it is not, or if no orbit is found.

    docs/synchronization.md derives where that of three blocks is stable.

    >>> from burridge_knopoff import Chain, Model, law_of, multipliers, synchronized_orbit
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> orbit = synchronized_orbit(model)
    >>> round(orbit.period, 6), orbit.stop_counts
    (5.672418, (1, 1, 1))
    >>> round(multipliers(orbit).transverse.real, 4)
    0.9589
    """
    return synchronized_orbits(instance_of(model, Model, "model")).at(model.a)


def synchronized_orbits(model: Model) -> KnownOrbits:
    """Return the synchronized orbits of a model over a.

    model : at any a

    Raises OrbitError if its chain is not its own mirror image, or if no orbit is found to begin with.
    """
    if not model.chain.is_mirror_symmetric:
        raise OrbitError("chain: got one that is not its own mirror image, expected one in which blocks move as one")
    rest = ChainState(np.zeros(model.blocks), np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))
    for a in SEEDS:
        try:
            return KnownOrbits(limit_cycle(model_at(model, a), rest, SETTLING, LONGEST_PERIOD))
        except OrbitError:
            continue
    raise OrbitError(f"v = {model.v!r}: no synchronized periodic orbit at a = {', '.join(map(repr, SEEDS))}")
