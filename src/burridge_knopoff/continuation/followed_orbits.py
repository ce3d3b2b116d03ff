"""The closed orbits among the attractors of a law, followed in a: which segment of orbits each of them lies on."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import partial
from pathlib import Path

import numpy as np
import scipy
import xarray

from burridge_knopoff.continuation.branch_changes import BranchChange, is_followed
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.periodic_orbits.branch_segment import BranchSegment, Half, half
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.following import Following
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.processes import parallel_map

#: How closed orbits are followed, and how many unstable ones beyond a bifurcation, for the figure.
FOLLOWING = Following(first_step=1e-4, largest_step=2.5e-3, least_step=1e-7, most_orbits=120)
BEYOND = 4

#: Smallest a down to which orbits are followed; at a = 0 no periodic orbit is isolated, and sticks vanish.
LEAST_A = 0.0

# Orbits in a round, for each process: enough that none waits long for the others, and few that turn out to be followed.
ROUND = 4

# Time after which a motion has come nearer to an orbit that attracts slowly than to any other beside it.
LATER = 100_000.0

# Share of its period within which a closed orbit is the one that has been followed.
SAME_PERIOD = 1e-3

#: Number of the value of a and slot of an attractor; and the closed orbit that it is.
Place = tuple[int, int]
Placed = tuple[Place, PeriodicOrbit]


@dataclass(frozen=True)
class FollowedOrbits:
    """Closed orbits that have been followed.

    segments, places : each segment, and the attractor from which it was followed
    of_place : number of the segment on which an attractor lies
    """

    segments: list[BranchSegment] = field(default_factory=list)
    places: list[Place] = field(default_factory=list)
    of_place: dict[Place, int] = field(default_factory=dict)

    def hold(self, place: Place, orbit: PeriodicOrbit, since: int = 0) -> bool:
        """Tell whether an orbit has been followed, on a segment from that number on, and remember on which."""
        numbers = range(since, len(self.segments))
        number = next((n for n in numbers if self.segments[n].holds(orbit, SAME_PERIOD)), None)
        if number is not None:
            self.of_place[place] = number
        return number is not None

    def add(self, place: Place, segment: BranchSegment) -> None:
        """Add the segment of an attractor."""
        self.of_place[place] = len(self.segments)
        self.segments.append(segment)
        self.places.append(place)


def followed(
    model: Model,
    one: xarray.Dataset,
    changes: Sequence[BranchChange],
    processes: int = 1,
    folder: str | Path | None = None,
) -> FollowedOrbits:
    """Follow every attractor of one law that is a closed orbit.

    one : the attractors at all values of a; those between the grid are left out where the branch does not change
    processes, folder : that work at once, and where they keep what they find; see `parallel_map`. No result depends on
        them
    """
    largest = float(np.nanmax(one["a"].values))
    places = _places(one, changes)
    models = [model.at(float(one["a"].values[k])) for k, _ in places]
    states = ([one[name].values[place] for place in places] for name in ("position", "velocity"))
    found = FollowedOrbits()
    with parallel_map(processes, folder) as each:
        orbits = each("closed orbits", _closed, models, *states)
        closed = [pair for pair in zip(places, orbits, strict=True) if not _is_lost(model, pair[1])]
        for following in _rounds(_in_turn(closed), found, ROUND * processes):
            before = len(found.segments)
            twice, upward = [orbit for _, orbit in following for _ in range(2)], [False, True] * len(following)
            halves = each("followed", partial(_half, largest=largest), twice, upward)
            for (place, orbit), *both in zip(following, halves[::2], halves[1::2], strict=True):
                if not found.hold(place, orbit, before) and not any(_is_lost(model, item) for item in both):
                    found.add(place, BranchSegment(*both))
    return found


def _places(one: xarray.Dataset, changes: Sequence[BranchChange]) -> list[Place]:
    """Return where the attractors of one law are closed orbits to be followed: on the grid of a, and beside changes."""
    branch, side = (one[name].values for name in ("branch", "side"))
    closed = np.array([[is_followed(one, *at) for at in np.ndindex(branch.shape)]]).reshape(branch.shape)
    closed &= (branch >= 0) & (side >= 0)
    wanted = np.repeat(one["in_grid"].values[:, None] == 1, branch.shape[1], axis=1)
    for change in changes:
        for k, slot in ((change.low, change.before), (change.high, change.after)):
            wanted[k, slot] |= slot >= 0
    return [(int(k), int(slot)) for k, slot in np.argwhere(closed & wanted)]


def _is_lost(model: Model, found: PeriodicOrbit | Half | OrbitError) -> bool:
    """Tell whether there is no orbit but an error in its place, which is printed."""
    if isinstance(found, OrbitError):
        print(f"{model.law.name}: {found}")
    return isinstance(found, OrbitError)


def _rounds(left: Sequence[Placed], found: FollowedOrbits, count: int) -> Iterator[list[Placed]]:
    """Yield those next in turn that have not been followed: what one shows of the others is seen after its round."""
    following: list[Placed] = []
    for place, orbit in left:
        if not found.hold(place, orbit):
            following.append((place, orbit))
        if len(following) == count:
            yield following
            following = []
    if following:
        yield following


def _in_turn(orbits: Sequence[Placed]) -> list[Placed]:
    """Return orbits, given with a ascending, in the order in which they are followed.

    The longest first, by octaves of their period: they take the most time, and in one round each waits for all. Then
    those far from each other: neighbours along a mostly lie on one segment.
    """
    apart = scipy.stats.qmc.Halton(1, scramble=False).random(len(orbits))[:, 0]
    turns = np.lexsort([apart, [-math.floor(math.log2(orbit.period)) for _, orbit in orbits]])
    return [orbits[k] for k in turns]


def _closed(model: Model, position: np.ndarray, velocity: np.ndarray) -> PeriodicOrbit | OrbitError:
    """Return the closed orbit on which a motion through a state U_i, U_i' has settled, or why there is none."""
    state = state_of(np.concatenate([position - model.sliding_offset, velocity]))
    try:
        try:
            found = limit_cycle(model, state)
        except OrbitError:
            # One that attracts slowly is told later from others beside it.
            found = limit_cycle(model, state, LATER)
        if multipliers(found).unstable:
            raise OrbitError(f"a = {model.a:.12g}: the closed orbit beside the motion is unstable")
    except OrbitError as error:
        return error
    found.forget_events()
    return found


def _half(orbit: PeriodicOrbit, upward: bool, largest: float) -> Half | OrbitError:
    """Follow an orbit one way, and find the bifurcations that it meets, or return why it cannot be followed."""
    try:
        # From one end of a wide grid to the other as well.
        step = max(FOLLOWING.largest_step, largest / orbit.model.chain.own_units.slope / FOLLOWING.most_orbits)
        found = half(orbit, upward, (LEAST_A, largest), BEYOND, replace(FOLLOWING, largest_step=step))
        # Found here, these go with the orbits to the process that asks for them.
        _ = (
            [(bifurcation.stick_time, bifurcation.mean_distance) for bifurcation in found.bifurcations],
            [point.multipliers for point in found.orbits],
        )
        _ = [point.orbit.mean_distance for point in found.shown]
    except OrbitError as error:
        return error
    for point in found.orbits:
        point.orbit.forget_events()
    return found
