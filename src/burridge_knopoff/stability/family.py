"""The synchronized orbits of one model over the friction parameter a: found once, then continued.

The synchronized orbit is the mirror-symmetric one, on which blocks 1 and 3 move alike. A run from rest stays
mirror-symmetric to the bit, and ends on it at moderate a; from there it is continued, whether it is stable or not.
"""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np

from burridge_knopoff.friction import Friction
from burridge_knopoff.stability.flow import Model, instant, new_solver
from burridge_knopoff.stability.orbit import HALTED, LONGEST_PERIOD, Orbit, OrbitError, find_orbit, flow, run

# A run from rest has settled after this time at the friction parameters that orbits are continued from.
SETTLING = 4000.0
SEEDS = (0.05, 0.1, 0.02, 0.2)

# Steps in a by which an orbit is continued; the stick vanishes like the root of a as a falls to 0.
LARGEST_STEP = 0.05
LEAST_STEP = 1e-5


class Family:
    """The synchronized orbits of one model for all a, each found from a neighbour.

    Raises OrbitError if the model has another number of blocks than three, or if no orbit is found to begin with.
    """

    def __init__(self, model: Model) -> None:
        if model.chain.blocks != 3:
            raise OrbitError(f"blocks: {model.chain.blocks} is not allowed: the orbit is that of 3 blocks")
        self.model = model
        self.known: dict[float, Orbit] = {}
        for a in SEEDS:
            try:
                self.known[a] = settle(self.with_a(a))
                return
            except OrbitError:
                continue
        raise OrbitError(f"v = {model.v!r}: no synchronized periodic orbit at a = {', '.join(map(repr, SEEDS))}")

    def with_a(self, a: float) -> Model:
        """Return the model at another friction parameter."""
        return replace(self.model, friction=Friction(self.model.friction.law, a))

    def at(self, a: float) -> Orbit:
        """Return the synchronized orbit at 0 < a < 2, continued from the nearest a at which it is known.

        Raises OrbitError where it is lost on the way, and outside this range.
        """
        if a in self.known:
            return self.known[a]
        if not 0.0 < a < 2.0:
            raise OrbitError(f"a = {a!r}: no orbit is looked for: 0 < a < 2")
        here = min(self.known, key=lambda known: abs(known - a))
        step = LARGEST_STEP
        while here != a:
            reach = min(step, 0.5 * here) if a < here else step
            there = a if abs(a - here) <= reach else here + math.copysign(reach, a - here)
            near = self.known[here]
            try:
                self.known[there] = find_orbit(self.with_a(there), near.reference, near.period)
            except OrbitError:
                step = 0.5 * min(reach, abs(there - here))
                if step < LEAST_STEP * min(1.0, here / LARGEST_STEP):
                    raise
                continue
            here = there
        return self.known[a]


def settle(model: Model) -> Orbit:
    """Return the synchronized orbit that a run from rest, all springs at the tension of uniform sliding, ends on.

    Raises OrbitError if it does not end on one.
    """
    rest = np.zeros(3)
    solver = new_solver(model)
    solver.end = SETTLING
    solver.begin(rest, rest, np.ones(3, dtype=bool))
    run(solver)
    solver.end = SETTLING + LONGEST_PERIOD
    solver.halting_block = 0
    clock = []
    for _ in range(2):
        if run(solver) != HALTED:
            raise OrbitError(f"a = {model.friction.a!r}: block 1 does not stop again and again")
        clock.append(solver.clock)
    stopped = instant(solver)
    period = clock[1] - clock[0]
    starts = [time for time, block, kind in flow(model, stopped, period)[1] if (block, kind) == (0, 1)]
    if not starts:
        raise OrbitError(f"a = {model.friction.a!r}: block 1 does not start again within {period!r}")
    return find_orbit(model, instant(flow(model, stopped, 0.5 * starts[0])[0]), period)
