"""The entries of `edges.nc`, found by following closed orbits to where the branches of attractors end or change."""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from functools import partial
from pathlib import Path

import numpy as np
import scipy
import xarray

from burridge_knopoff.model.model import Model
from burridge_knopoff.orbits.edge_kind import EdgeKind
from burridge_knopoff.orbits.edges import Edge
from burridge_knopoff.orbits.floquet import multipliers
from burridge_knopoff.orbits.following import Following
from burridge_knopoff.orbits.orbit import OrbitError
from burridge_knopoff.orbits.periodic import PeriodicOrbit
from burridge_knopoff.orbits.stretch import Half, Stretch, half
from burridge_knopoff.running.processes import shared_out
from burridge_knopoff.stability.closed_motion import closed_motion
from burridge_knopoff.stability.motion import MotionKind
from burridge_knopoff.stability.returns import instant_of
from burridge_knopoff.summaries.branch_changes import BranchChange, Change, slots_of_branches

#: How closed orbits are followed, and how many unstable ones beyond an edge, for the figure.
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

# Least error that is told: how far rounding changes a root differs between linear-algebra libraries.
LEAST_ERROR = 1e-10


#: A closed orbit with its number in a and its slot there.
Placed = tuple[tuple[int, int], PeriodicOrbit]


@dataclass(frozen=True)
class Entry:
    """An edge of a branch: found on an orbit, or known only to lie within a range of a.

    low, high : nearest values of a below and above at which the branch is known; NaN where an edge that is passed lies
        beyond all of them
    """

    change: Change
    from_branch: int
    to_branch: int
    low: float
    high: float
    motion: tuple[int, int]
    lifetime: tuple[float, float]
    kind: EdgeKind
    edge: Edge | None

    @property
    def a(self) -> float:
        """Friction parameter: that of the edge, or the middle of the range."""
        return self.edge.a if self.edge else 0.5 * (self.low + self.high)


def followed(
    model: Model,
    one: xarray.Dataset,
    changes: Sequence[BranchChange],
    processes: int = 1,
    folder: str | Path | None = None,
) -> tuple[list[Stretch], dict[tuple[int, int], int]]:
    """Follow every attractor of one law that is a closed orbit; return the stretches, and the one of each (a, slot).

    one : the attractors at all values of a; those between the grid are left out where the branch does not change
    processes, folder : that work at once, and where they keep what they find; see `shared_out`. No result depends on
        them
    """
    a_values = one["a"].values
    branch, side, kind = (one[name].values for name in ("branch", "side", "kind"))
    closed = np.isin(kind, (MotionKind.SYNCHRONIZED, MotionKind.PERIODIC)) & (branch >= 0) & (side >= 0)
    wanted = np.repeat(one["in_grid"].values[:, None] == 1, branch.shape[1], axis=1)
    for change in changes:
        for k, slot in ((change.low, change.before), (change.high, change.after)):
            wanted[k, slot] |= slot >= 0
    places = [(int(k), int(slot)) for k, slot in np.argwhere(closed & wanted)]
    models = [model.at(float(a_values[k])) for k, _ in places]
    states = ([one[name].values[place] for place in places] for name in ("position", "velocity"))
    found: list[Stretch] = []
    of_slot: dict[tuple[int, int], int] = {}

    def held(place: tuple[int, int], orbit: PeriodicOrbit, since: int = 0) -> bool:
        """Tell whether an orbit has been followed, on a stretch from that number on."""
        number = next((n for n in range(since, len(found)) if found[n].holds(orbit, SAME_PERIOD)), None)
        if number is not None:
            of_slot[place] = number
        return number is not None

    with shared_out(processes, folder) as each:
        orbits = each("closed orbits", _closed, models, *states)
        for error in orbits:
            if isinstance(error, OrbitError):
                print(f"{model.law.name}: {error}")
        pairs = zip(places, orbits, strict=True)
        left = _in_turn([(place, orbit) for place, orbit in pairs if not isinstance(orbit, OrbitError)])
        while left:
            # Those next in turn that have not been followed: what one of them shows of the others is seen afterwards.
            following: list[Placed] = []
            while left and len(following) < ROUND * processes:
                place, orbit = left.pop(0)
                if not held(place, orbit):
                    following.append((place, orbit))
            before = len(found)
            twice, upward = [orbit for _, orbit in following for _ in range(2)], [False, True] * len(following)
            halves = each("followed", partial(_half, largest=float(np.nanmax(a_values))), twice, upward)
            for (place, orbit), *both in zip(following, halves[::2], halves[1::2], strict=True):
                failed = [item for item in both if isinstance(item, OrbitError)]
                if held(place, orbit, before):
                    continue
                if failed:
                    print(f"{model.law.name}: {failed[0]}")
                    continue
                of_slot[place] = len(found)
                found.append(Stretch(*both))
    return found, of_slot


def _in_turn(orbits: Sequence[Placed]) -> list[Placed]:
    """Return orbits, given with a ascending, in the order in which they are followed.

    The longest first, by octaves of their period: they take the most time, and in one round each waits for all. Then
    those far from each other: neighbours along a mostly lie on one stretch.
    """
    apart = scipy.stats.qmc.Halton(1, scramble=False).random(len(orbits))[:, 0]
    turns = np.lexsort([apart, [-math.floor(math.log2(orbit.period)) for _, orbit in orbits]])
    return [orbits[k] for k in turns]


def _closed(model: Model, position: np.ndarray, velocity: np.ndarray) -> PeriodicOrbit | OrbitError:
    """Return the closed orbit on which a motion through a state U_i, U_i' has settled, or why there is none."""
    state = instant_of(np.concatenate([position - model.sliding_offset, velocity]))
    try:
        found = closed_motion(model, state)
        # Newton's method may come to another orbit beside one that attracts slowly.
        found = closed_motion(model, state, LATER) if multipliers(found).unstable else found
        if multipliers(found).unstable:
            raise OrbitError(f"a = {model.a:.12g}: the closed orbit beside the motion is unstable")
    except OrbitError as error:
        return error
    found.forget_events()
    return found


def _half(orbit: PeriodicOrbit, upward: bool, largest: float) -> Half | OrbitError:
    """Follow an orbit one way, and find the edges that it meets, or return why it cannot be followed."""
    try:
        # From one end of a wide grid to the other as well.
        step = max(FOLLOWING.largest_step, largest / FOLLOWING.most_orbits)
        found = half(orbit, upward, (LEAST_A, largest), BEYOND, replace(FOLLOWING, largest_step=step))
        # Found here, these go with the orbits to the process that asks for them.
        _ = (
            [(edge.stick_time, edge.mean_distance) for edge in found.edges],
            [point.multipliers for point in found.orbits],
        )
        _ = [point.orbit.mean_distance for point in found.shown]
    except OrbitError as error:
        return error
    for point in found.orbits:
        point.orbit.forget_events()
    return found


def entries(
    one: xarray.Dataset,
    changes: Sequence[BranchChange],
    stretches: Sequence[Stretch],
    of_slot: Mapping[tuple[int, int], int],
) -> list[Entry]:
    """Return an entry, or two, for each beginning, end and change, and one for each edge that stable orbits pass.

    A change from one orbit to another has one for the end of the first and one for the beginning of the second, unless
    they are the same edge.
    """
    a, branch, kind = (one[name].values for name in ("a", "branch", "kind"))
    slots = slots_of_branches(one)
    grid = np.flatnonzero(one["in_grid"].values[: len(slots)] == 1)
    found = []
    for change in changes:
        ends: list[Edge] = []
        low, high = change.low, change.high
        below, above = int(grid[grid <= low][-1]), int(grid[grid >= high][0])
        reach = a[above] - a[below]
        numbers = of_slot.get((change.low, change.before)), of_slot.get((change.high, change.after))
        if numbers[0] is not None and numbers[0] == numbers[1]:
            # One orbit on both sides; only its section points were counted differently.
            continue
        for number, name in zip(numbers, ("upward", "downward"), strict=True):
            edge = getattr(stretches[number], name).end if number is not None else None
            if edge is None or any(abs(edge.a - other.a) <= LEAST_ERROR for other in ends):
                continue
            # An orbit that goes on for more than a step of the grid beyond a change did not bring it about: another one
            # beside it has taken the number of its branch.
            if a[low] - reach <= edge.a <= a[high] + reach:
                ends.append(edge)
        motion = (
            _motion(kind, slots, range(low, below - 1, -1), change.from_branch),
            _motion(kind, slots, range(high, above + 1), change.to_branch),
        )
        lifetime = _lifetime(one, change)
        own = change.change, change.from_branch, change.to_branch, float(a[low]), float(a[high]), motion, lifetime
        found += [Entry(*own, edge.kind, edge) for edge in ends] or [Entry(*own, _unlocated(change, kind), None)]
    for number, one_stretch in enumerate(stretches):
        slot = next(slot for slot, index in of_slot.items() if index == number)
        n, own_kind = int(branch[slot]), int(kind[slot])
        values = np.array([a[k] for k, row in enumerate(slots) if n in row])
        for edge in one_stretch.downward.edges + one_stretch.upward.edges:
            if edge.keeps_stability and not edge.turns:
                beside = max(values[values <= edge.a], default=np.nan), min(values[values >= edge.a], default=np.nan)
                own = Change.PASSED, n, n, *beside, (own_kind, own_kind), (np.nan, np.nan)
                found.append(Entry(*own, edge.kind, edge))
    return found


def _motion(kind: np.ndarray, slots: Sequence[Mapping[int, int]], places: Iterable[int], branch: int) -> int:
    """Return the kind of motion on a branch at the first of some values of a at which it is known."""
    return next((int(kind[k, slots[k][branch]]) for k in places if branch in slots[k]), int(MotionKind.UNDETERMINED))


def _lifetime(one: xarray.Dataset, change: BranchChange) -> tuple[float, float]:
    """Return the interval of the lifetime of chaos next to an edge, the shorter where there is chaos on both sides."""
    sides = [(change.low, change.before), (change.high, change.after)]
    known = [(one["lifetime_low"].values[side], one["lifetime_high"].values[side]) for side in sides if side[1] >= 0]
    return min((interval for interval in known if np.isfinite(interval[0])), default=(np.nan, np.nan))


def _unlocated(change: BranchChange, kind: np.ndarray) -> EdgeKind:
    """Return the kind of an edge next to which there is no closed orbit: a crisis if chaos ends, begins or dies out."""
    sides = (change.low, change.before), (change.high, change.after)
    ends = [kind[k, slot] for k, slot in sides if slot >= 0]
    chaotic = np.isin(ends, (MotionKind.CHAOTIC, MotionKind.TRANSIENT_CHAOS))
    return EdgeKind.CRISIS if chaotic.all() else EdgeKind.UNDETERMINED
