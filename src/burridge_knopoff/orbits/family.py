"""The synchronized orbits of one model over the friction parameter a: found once, then continued.

The synchronized orbit is the mirror-symmetric one, on which blocks 1 and 3 move alike. A run from rest stays
mirror-symmetric to the bit, and ends on it at moderate a; from there it is continued, whether it is stable or not.
"""

from __future__ import annotations

import math

import numpy as np

from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.orbits.loss import has_orbit
from burridge_knopoff.orbits.orbit import LONGEST_PERIOD, Orbit, OrbitError, after, find_orbit, flow, model_at
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import instance_of

# A run from rest has settled after this time at the friction parameters that orbits are continued from.
SETTLING = 4000.0
SEEDS = (0.05, 0.1, 0.02, 0.2)

# Steps in a by which an orbit is continued; the stick vanishes like the root of a as a falls to 0.
LARGEST_STEP = 0.05
LEAST_STEP = 1e-5


def synchronized_orbit(model: Model) -> Orbit:
    """Return the synchronized orbit of a model, whether it is stable or not.

    Raises OrbitError, a ValueError, if its chain is not one of three blocks that is its own mirror image, or if no
    orbit is found.

    docs/synchronization.md derives where it is stable.

    >>> from burridge_knopoff import Chain, Model, law_of, synchronized_orbit, transverse_multiplier
    >>> model = Model(Chain(3), law_of("linearized", 0.08))
    >>> orbit = synchronized_orbit(model)
    >>> round(orbit.period, 6), round(transverse_multiplier(orbit), 4)
    (5.672418, 0.9589)
    """
    return Family(instance_of(model, Model, "model")).at(model.a)


class Family:
    """The synchronized orbits of one model for all a, each found from a neighbour.

    model : at any a

    Raises OrbitError if its chain is not one of three blocks that is its own mirror image, or if no orbit is found to
    begin with.
    """

    def __init__(self, model: Model) -> None:
        if not has_orbit(model.chain):
            found = f"{model.blocks} blocks" + ", not symmetric in a mirror" * (model.blocks == 3)
            raise OrbitError(f"chain: got {found}, expected 3 blocks, symmetric in a mirror")
        self.model = model
        self.known: dict[float, Orbit] = {}
        for a in SEEDS:
            try:
                self.known[a] = settle(self.model_at(a))
                return
            except OrbitError:
                continue
        raise OrbitError(f"v = {model.v!r}: no synchronized periodic orbit at a = {', '.join(map(repr, SEEDS))}")

    def model_at(self, a: float) -> Model:
        """Return the model at another friction parameter; raises OrbitError where its law does not allow that."""
        return model_at(self.model, a)

    def at(self, a: float) -> Orbit:
        """Return the synchronized orbit at a > 0, continued from the nearest a at which it is known.

        Raises OrbitError where it is lost on the way, and elsewhere.
        """
        if a in self.known:
            return self.known[a]
        if not a > 0.0:
            raise OrbitError(f"a = {a!r}: no orbit is looked for: 0 < a")
        here = min(self.known, key=lambda known: abs(known - a))
        step = LARGEST_STEP
        while here != a:
            reach = min(step, 0.5 * here) if a < here else step
            there = a if abs(a - here) <= reach else here + math.copysign(reach, a - here)
            near = self.known[here]
            try:
                self.known[there] = find_orbit(self.model_at(there), near.reference, near.period)
            except OrbitError as error:
                step = 0.5 * abs(there - here)
                if step < LEAST_STEP * min(1.0, here / LARGEST_STEP):
                    raise OrbitError(f"{error}, on the way to a = {a!r}") from None
                continue
            here = there
        return self.known[a]


def settle(model: Model) -> Orbit:
    """Return the synchronized orbit that a run from rest, all springs at the tension of uniform sliding, ends on.

    Raises OrbitError if it does not end on one.
    """
    rest = np.zeros(3)
    runner = Runner(model)
    after(runner, Instant(rest, rest, np.ones(3, dtype=bool)), SETTLING)
    clock = []
    for _ in range(2):
        if runner.run(SETTLING + LONGEST_PERIOD, halting_block=0) != Status.HALTED:
            raise OrbitError(f"a = {model.a!r}: block 1 does not stop again and again")
        clock.append(runner.clock)
    stopped = runner.instant()
    period = clock[1] - clock[0]
    starts = [time for time, block, kind in flow(model, stopped, period)[1] if (block, kind) == (0, 1)]
    if not starts:
        raise OrbitError(f"a = {model.a!r}: block 1 does not start again within {period!r}")
    return find_orbit(model, flow(model, stopped, 0.5 * starts[0])[0].instant(), period)
