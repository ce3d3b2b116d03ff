"""Proof of the synchronized orbit: its existence, its events and the absence of others, and its multipliers.

The unknowns are the positions just after the first start of a period, when all blocks are at rest, and the durations of
the arcs. The equations require that each arc ends with its event, and that the positions return. Of the six
multipliers, one is that of the flow, and three are 0 since three blocks stop. The other two are the factors by which an
infinitesimal difference of blocks 1 and 3, and a relative shift of the end blocks and the center, change in a period.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property, reduce
from itertools import pairwise
from typing import Any

from flint import arb

from burridge_knopoff.periodic_orbits.flow import flow
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.proof.arcs import CENTER, LATERAL, NAMES, Arc, State
from burridge_knopoff.proof.balls import ProofError, arithmetic
from burridge_knopoff.proof.bounds import Function, bounds, check_positive
from burridge_knopoff.proof.flows import flow_of
from burridge_knopoff.proof.krawczyk import (
    Enclosure,
    Equations,
    derivatives,
    enclose_widest,
    refine_guess,
    solve_linear,
    submatrix,
)

#: Unknowns of an orbit before the durations of its arcs: the two positions.
POSITIONS = 2


def follow_arcs(arcs: Sequence[Arc], unknown: Sequence[Any]) -> tuple[list[State], list[Any]]:
    """Return the states at the beginning of each arc and at the end of the period, and the equations of the events.

    unknown : positions x and y of the blocks at rest, the duration of each arc, and a
    """
    *orbit, a = unknown
    states, margins = [State((orbit[0], orbit[1]), (-1, -1))], []
    for arc, time in zip(arcs, orbit[POSITIONS:], strict=True):
        # The condition uses the state before the event: after a stop the speed is always 0.
        before = arc.state_after(states[-1], a, time)
        margins.append(arc.margin(arc.event_block, before, a))
        states.append(arc.state_after_event(before))
    return states, margins


def equations(arcs: Sequence[Arc], critical: bool = False) -> Equations:
    """Return the equations of a periodic orbit, in the unknowns of `follow_arcs`: events and return of positions.

    critical : whether the transverse multiplier must be 1 as well
    """

    def values(unknown: Sequence[Any]) -> list[Any]:
        states, margins = follow_arcs(arcs, unknown)
        returned = [states[-1].position[k] - unknown[k] for k in range(POSITIONS)]
        return [*margins, *returned, *([states[-1].difference[0] - 1] if critical else [])]

    return values


def arcs_of(orbit: PeriodicOrbit) -> tuple[tuple[Arc, ...], list[float]]:
    """Return the arcs of a synchronized orbit and, as a guess in double precision, its unknowns.

    Raises ProofError unless all blocks stick at some time, and each starts and stops once in a period.
    """
    events = [(time, block) for time, block, _ in orbit.events if block in (LATERAL, CENTER)]
    slips = [not stuck for stuck in orbit.reference.stuck[:2]]
    before = []
    for _, block in events:
        before.append((slips[LATERAL], slips[CENTER]))
        slips[block] = not slips[block]
    if sorted(block for _, block in events) != [0, 0, 1, 1] or (False, False) not in before:
        expected = "expected all blocks to stick at once, and each to stop once in a period"
        raise ProofError(f"a = {orbit.a!r}: not covered: {expected}")
    first = before.index((False, False))
    # A period, from the first start to the next.
    cycle = events[first:] + [(time + orbit.period, block) for time, block in events[: first + 1]]
    slipping = before[first + 1 :] + before[: first + 1]
    flow_of_law = flow_of(orbit.model)
    arcs = [Arc(state, block, flow_of_law) for state, (_, block) in zip(slipping, cycle[1:], strict=True)]
    start = flow(orbit.model, orbit.reference, cycle[0][0]).state()
    position = [float(x) / orbit.model.v for x in start.position[:POSITIONS]]
    return tuple(arcs), position + [late - early for (early, _), (late, _) in pairwise(cycle)]


@dataclass(frozen=True, eq=False)
class ProvedOrbit:
    """A synchronized orbit that is proved to exist and to be unique in a box for every a in a ball.

    arcs : from the first start of a period
    a : friction parameter, a ball
    enclosure : of the unknowns; additional equations may make its inner part narrower
    """

    arcs: tuple[Arc, ...]
    a: arb
    enclosure: Enclosure

    @property
    def times(self) -> tuple[arb, ...]:
        """Durations of the arcs."""
        return self.enclosure.inner[POSITIONS:]

    @property
    def period(self) -> arb:
        """The period T."""
        with arithmetic():
            return sum(self.times, arb(0))

    @property
    def event_times(self) -> list[arb]:
        """Times of the events at the ends of the arcs, since the first start of the period; the last is the period."""
        with arithmetic():
            return [sum(self.times[: k + 1], arb(0)) for k in range(len(self.times))]

    @property
    def _unknown(self) -> list[arb]:
        return [*self.enclosure.inner, self.a]

    @cached_property
    def multiplier(self) -> arb:
        """The transverse Floquet multiplier μ: the factor by which a small difference of blocks 1 and 3 changes."""
        with arithmetic():
            return follow_arcs(self.arcs, self._unknown)[0][-1].difference[0]

    @cached_property
    def symmetric_multiplier(self) -> arb:
        """The multiplier of mirror-symmetric perturbations; their other multipliers are 0 or that of the flow.

        While all blocks stick, a common shift of all blocks is along the flow. The multiplier is the factor by which a
        perturbation of x − y changes in a period: a start leaves perturbations unchanged, and a stop removes those of
        the velocity (docs/synchronization.md).
        """

        def position_difference(unknown: Sequence[Any]) -> list[Any]:
            x, y = follow_arcs(self.arcs, unknown)[0][-1].position
            return [x - y]

        return derivatives(position_difference, self._unknown, [0])[0, 0]

    @cached_property
    def slope(self) -> arb:
        """The derivative dμ/da along the family of orbits, for all a in the ball."""
        matrix = derivatives(equations(self.arcs, critical=True), self._unknown)
        count = len(self.enclosure.inner)
        orbit, last = range(count), [count]
        with arithmetic():
            moved = solve_linear(submatrix(matrix, orbit, orbit), submatrix(matrix, orbit, last))
            change = submatrix(matrix, last, last) - submatrix(matrix, last, orbit) * moved
            return change[0, 0]

    def check_arcs(self) -> None:
        """Prove that no block stops or starts inside an arc, and that every event crosses 0 with nonzero slope.

        Raises ProofError, one line, with the block, arc and time.
        """
        for k, (arc, state, time) in enumerate(self._arcs_with_states()):
            started = self.arcs[k - 1].event_block if arc.slips[self.arcs[k - 1].event_block] else None
            for block in (LATERAL, CENTER):
                margin = self._margin(arc, state, block)
                try:
                    check_positive(margin, time, root_at_start=block == started, root_at_end=block == arc.event_block)
                except ProofError as error:
                    raise ProofError(
                        f"{NAMES[block]}, {arc.name}: not proved to keep sticking or slipping: {error}"
                    ) from None

    def speed_range(self) -> arb:
        """Return a ball that contains U'/v of all slipping blocks at all times."""
        return self._margin_range(True)

    def friction_range(self, v: float) -> arb:
        """Return a ball that contains the friction Φ on all slipping blocks at all times."""
        speed = self.speed_range()
        with arithmetic():
            return self.arcs[0].flow.friction(speed, self.a * v)

    def force_margin_range(self) -> arb:
        """Return a ball that contains (1 − s)/v of all stuck blocks at all times, with spring force s."""
        return self._margin_range(False)

    def _margin_range(self, slipping: bool) -> arb:
        ranges = [
            bounds(self._margin(arc, state, block), time)
            for arc, state, time in self._arcs_with_states()
            for block in (LATERAL, CENTER)
            if arc.slips[block] == slipping
        ]
        with arithmetic():
            return reduce(arb.union, ranges)

    def _margin(self, arc: Arc, state: State, block: int) -> Function:
        """Return the margin of a block as a function of the time since the beginning of an arc."""
        path = arc.flow.path(arc.slips, state, self.a)
        return lambda time: arc.margin(block, path(time), self.a)

    def _arcs_with_states(self) -> list[tuple[Arc, State, arb]]:
        """Return each arc with the state at its beginning and its duration."""
        with arithmetic():
            states, _ = follow_arcs(self.arcs, self._unknown)
        return list(zip(self.arcs, states, self.times, strict=False))


def prove_orbit(orbit: PeriodicOrbit, a: arb) -> ProvedOrbit:
    """Return the proof that there is a synchronized orbit near a given one in double precision.

    a : friction parameter, a narrow ball around that of the orbit
    Raises ProofError, one line, if the proof fails.
    """
    arcs, guess = arcs_of(orbit)
    middle = refine_guess(equations(arcs), guess, [a.mid()])
    proved = ProvedOrbit(arcs, a, enclose_widest(equations(arcs), middle, arcs[0].flow.box_radii, [a]))
    proved.check_arcs()
    return proved
