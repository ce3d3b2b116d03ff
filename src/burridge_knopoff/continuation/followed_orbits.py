"""The periodic orbits among the attractors of a law, followed in a, and the segment on which each of them lies."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
import xarray

from burridge_knopoff.continuation.branch_changes import BranchChange, is_followed
from burridge_knopoff.continuation.cached import CLASSES
from burridge_knopoff.model.model import Model, at_recorded_a
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.periodic_orbits.branch_segment import BranchSegment, HalfBranch, follow_half_branch
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import ContinuationSettings
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.processes import parallel_map

#: How periodic orbits are followed, and the number of unstable ones beyond a bifurcation, for the figure.
FOLLOWING = ContinuationSettings(first_step=1e-4, largest_step=2.5e-3, smallest_step=1e-7, max_orbits=120)
UNSTABLE_ORBITS = 4

#: Smallest a to which orbits are followed; at a = 0 no periodic orbit is isolated, and sticks vanish.
LEAST_A = 0.0

# Orbits per process in a round: enough to keep the processes busy, few enough that few of them lie on one segment.
ORBITS_PER_PROCESS = 4

# Fraction of the time that finding the orbits takes.
PERIODIC_ORBITS = 0.1

# Time after which a motion has come closer to a slowly attracting orbit than to any other nearby orbit.
LONG_SETTLING = 100_000.0

# Relative difference of the periods up to which two orbits of the same stops count as one.
SAME_PERIOD = 1e-3

#: Indices of a and slot of an attractor; and the same with its periodic orbit.
Place = tuple[int, int]
Placed = tuple[Place, PeriodicOrbit]


@dataclass(frozen=True)
class FollowedOrbits:
    """Periodic orbits that have been followed.

    segments, places : each segment, and the attractor from which it was followed
    of_place : index of the segment on which an attractor lies
    """

    segments: list[BranchSegment] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    of_place: dict[Place, int] = field(default_factory=dict)

    def assign(self, place: Place, orbit: PeriodicOrbit, since: int = 0) -> bool:
        """Assign an orbit to a segment from index `since` on, and return whether it lies on one."""
        numbers = range(since, len(self.segments))
        number = next((n for n in numbers if self.segments[n].contains(orbit, SAME_PERIOD)), None)
        if number is not None:
            self.of_place[place] = number
        return number is not None

    def add(self, place: Place, segment: BranchSegment) -> None:
        """Add the segment of an attractor."""
        self.of_place[place] = len(self.segments)
        self.segments.append(segment)
        self.places.append(place)


def follow_orbits(
    model: Model,
    table: xarray.Dataset,
    changes: Sequence[BranchChange],
    processes: int = 1,
    folder: str | Path | None = None,
) -> FollowedOrbits:
    """Follow every attractor of one law that is a periodic orbit.

    table : the attractors at all values of a; between values of the grid only changing branches are followed
    processes, folder : number of processes, and the cache of their results; see `parallel_map`. The results do not
        depend on them
    """
    if "a" not in model.law.names:
        return FollowedOrbits()
    largest = float(np.nanmax(table["a"].values))
    places = _places(table, changes)
    models = [at_recorded_a(model, float(table["a"].values[k])) for k, _ in places]
    states = ([table[name].values[place] for place in places] for name in ("position", "velocity"))
    followed = FollowedOrbits()
    with parallel_map(processes, folder, CLASSES) as pool:
        orbits = pool("periodic orbits", _periodic_orbit, models, *states, span=(0.0, PERIODIC_ORBITS))
        closed = [pair for pair in zip(places, orbits, strict=True) if not _is_lost(model, pair[1])]
        for following in _rounds(_sort(closed), followed, ORBITS_PER_PROCESS * processes):
            before = len(followed.segments)
            twice, upward = [orbit for _, orbit in following for _ in range(2)], [False, True] * len(following)
            share = PERIODIC_ORBITS + (1.0 - PERIODIC_ORBITS) * len(followed.of_place) / len(closed)
            halves = pool("followed", partial(_half, largest=largest), twice, upward, span=(share, share))
            for (place, orbit), *both in zip(following, halves[::2], halves[1::2], strict=True):
                if not followed.assign(place, orbit, before) and not any(_is_lost(model, item) for item in both):
                    followed.add(place, BranchSegment(*both))
    return followed


def _places(table: xarray.Dataset, changes: Sequence[BranchChange]) -> list[Place]:
    """Return the places of the periodic orbits that are followed: those on the grid of a, and those next to changes."""
    branch, side = (table[name].values for name in ("branch", "side"))
    closed = is_followed(table, *np.indices(branch.shape)) & (branch >= 0) & (side >= 0)
    mask = np.repeat(table["in_grid"].values[:, None] == 1, branch.shape[1], axis=1)
    for change in changes:
        for k, slot in ((change.low, change.before), (change.high, change.after)):
            mask[k, slot] |= slot >= 0
    return [(int(k), int(slot)) for k, slot in np.argwhere(closed & mask)]


def _is_lost(model: Model, outcome: PeriodicOrbit | HalfBranch | str) -> bool:
    """Return whether there is the text of an error instead of an orbit, and print it."""
    if isinstance(outcome, str):
        print(f"{model.law.name}: {outcome}")
    return isinstance(outcome, str)


def _rounds(left: Sequence[Placed], followed: FollowedOrbits, count: int) -> Iterator[list[Placed]]:
    """Yield the next orbits that lie on no known segment, `count` at a time; segments of a round are known after it."""
    following: list[Placed] = []
    for place, orbit in left:
        if not followed.assign(place, orbit):
            following.append((place, orbit))
        if len(following) == count:
            yield following
            following = []
    if following:
        yield following


def _sort(orbits: Sequence[Placed]) -> list[Placed]:
    """Return orbits, given with a ascending, in the order in which they are followed.

    The longest come first, by octaves of their period, because they take the most time and a round ends with its last
    orbit. Within an octave orbits far from each other come first, because neighbours mostly lie on one segment.
    """
    # Van der Corput's sequence: the binary digits of k, reversed behind the point.
    place = [int(f"{k:b}"[::-1], 2) / 2 ** k.bit_length() for k in range(len(orbits))]
    order = np.lexsort([place, [-math.floor(math.log2(orbit.period)) for _, orbit in orbits]])
    return [orbits[k] for k in order]


def _periodic_orbit(model: Model, position: np.ndarray, velocity: np.ndarray) -> PeriodicOrbit | str:
    """Return the periodic orbit on which a motion through a state U_i, U_i' has settled, or why there is none."""
    state = state_of(np.concatenate([position - model.sliding_offset, velocity]))
    try:
        try:
            orbit = limit_cycle(model, state)
        except OrbitError:
            # A slowly attracting orbit is distinguished from nearby ones only after a longer time.
            orbit = limit_cycle(model, state, LONG_SETTLING)
        if multipliers(orbit).unstable_count:
            raise OrbitError(f"{model.place}: the periodic orbit next to the motion is unstable")
    except OrbitError as error:
        return str(error)
    orbit.forget_events()
    return orbit


def _half(orbit: PeriodicOrbit, upward: bool, largest: float) -> HalfBranch | str:
    """Follow an orbit in one direction with its bifurcations, or return why it cannot be followed."""
    try:
        # Steps are large enough to cross a wide grid.
        step = max(FOLLOWING.largest_step, largest / orbit.model.chain.own_units.slope / FOLLOWING.max_orbits)
        branch = follow_half_branch(
            orbit, upward, (LEAST_A, largest), UNSTABLE_ORBITS, replace(FOLLOWING, largest_step=step)
        )
        # Cached properties that are computed here go with the orbits to the calling process.
        _ = (
            [(bifurcation.stick_time, bifurcation.mean_distance) for bifurcation in branch.bifurcations],
            [point.multipliers for point in branch.orbits],
        )
        _ = [point.orbit.mean_distance for point in branch.drawn_orbits]
    except OrbitError as error:
        return str(error)
    for point in branch.orbits:
        point.orbit.forget_events()
    return branch
