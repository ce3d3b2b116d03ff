"""Tori between two orbits: searched for where an orbit that is followed ends as an unstable focus.

A torus begins where a periodic orbit loses its stability in a Neimark-Sacker bifurcation, or in a grazing beyond which
its multipliers are a complex pair outside the unit circle. If the next orbit of the branch begins nearby, no value of a
at which attractors were searched for need lie on the torus, or the torus may be locked there. Between both ends, which
are located on the orbits, the motion is therefore followed from value to value.

Reference: Y. A. Kuznetsov, "Elements of Applied Bifurcation Theory" (Springer 2004), Sections 4.7 and 7.3.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np
import xarray

from burridge_knopoff.attractors.attractor import perturb
from burridge_knopoff.attractors.convergence import Convergence
from burridge_knopoff.attractors.search import SYMMETRY_PUSH
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.continuation.branch_changes import slots_of_branches
from burridge_knopoff.continuation.cached import CLASSES
from burridge_knopoff.continuation.followed_orbits import FollowedOrbits
from burridge_knopoff.continuation.matching import SAME_SET
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.model import at_recorded_a
from burridge_knopoff.motion.kind import REGULAR, MotionKind
from burridge_knopoff.motion.rotation import mean_rotation
from burridge_knopoff.motion.section_returns import Returns, visit
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.periodic_orbits.bifurcations import Bifurcation
from burridge_knopoff.periodic_orbits.branch_segment import BranchSegment
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit
from burridge_knopoff.running.processes import parallel_map

#: Number of values of a between both ends, evenly spaced, at which a torus is searched for.
VALUES = 16

# Number of different rotation numbers that show a torus which is locked at all values, and their least difference. Two
# may be those of two orbits that follow each other.
LOCKINGS = 3
DIFFERENT_ROTATION = 1e-5

# Largest relative difference of the mean time between every m-th return from the period of an orbit of m returns, for
# motion that still turns about this orbit.
SAME_TURN = 0.02

# Decimal places of a in which two located ends agree if they are the same.
PLACES = 8


@dataclass(frozen=True)
class TorusPoint:
    """The motion at one a between two orbits; rotation : turns about the orbit that has ended, per period of it."""

    a: float
    kind: MotionKind
    period: float
    rotation: float


@dataclass(frozen=True)
class Torus:
    """A torus between two orbits of a branch, with the orbits to which it is locked.

    end : where the one orbit ends and the torus begins
    low, high : both ends in a
    points : with a ascending, up to VALUES
    """

    branch: int
    end: Bifurcation
    low: float
    high: float
    points: Sequence[TorusPoint]


@dataclass(frozen=True)
class Gap:
    """A range of a between two orbits of a branch; end : where the first one ends; far : where the other one begins."""

    branch: int
    end: Bifurcation
    far: float


def find_tori(
    table: xarray.Dataset,
    followed: FollowedOrbits,
    settings: SearchSettings,
    motion: MotionSettings,
    processes: int = 1,
) -> list[Torus]:
    """Return the tori between orbits of one law in ranges of a in which no value of the table shows a torus.

    table, followed : the attractors at all values of a, and the orbits among them
    settings, motion : of the search for these attractors
    """
    gaps = list(_gaps(table, followed))
    orbits, ends = [gap.end.at.orbit for gap in gaps], [gap.far for gap in gaps]
    with parallel_map(processes, None, CLASSES) as pool:
        points = pool("tori", partial(_points, settings=settings, motion=motion), orbits, ends)
    return [
        Torus(gap.branch, gap.end, min(gap.end.a, gap.far), max(gap.end.a, gap.far), rows)
        for gap, rows in zip(gaps, points, strict=True)
        if _is_torus(rows)
    ]


def _is_torus(points: Sequence[TorusPoint]) -> bool:
    """Return whether one of the motions is quasiperiodic, or they turn at several rates."""
    rotation = np.sort([point.rotation for point in points if math.isfinite(point.rotation)])
    different = int(np.count_nonzero(np.diff(rotation) > DIFFERENT_ROTATION)) + 1
    return different >= LOCKINGS or any(point.kind == MotionKind.QUASIPERIODIC for point in points)


def _gaps(table: xarray.Dataset, followed: FollowedOrbits) -> Iterator[Gap]:
    """Yield the gaps that begin where an orbit ends as an unstable focus, and in which no value shows a torus."""
    slots, seen = slots_of_branches(table), set()
    for number, segment in enumerate(followed.segments):
        for upward, end in ((False, segment.downward.end), (True, segment.upward.end)):
            if end is None or not _is_focus(end):
                continue
            for branch in sorted(
                {int(table["branch"].values[at]) for at, n in followed.of_place.items() if n == number}
            ):
                far = _next_orbit(table, slots, followed, branch, end.a, upward)
                # Two segments may have one end.
                place = branch, upward, None if far is None else round(far, PLACES)
                if far is not None and place not in seen:
                    seen.add(place)
                    yield Gap(branch, end, far)


def _is_focus(end: Bifurcation) -> bool:
    """Return whether an orbit goes on beyond its end with a leading pair of complex multipliers."""
    return end.after is not None and not end.is_turning_point and bool(end.after.multipliers.whole[0].imag)


def _next_orbit(
    table: xarray.Dataset,
    slots: Sequence[dict[int, int]],
    followed: FollowedOrbits,
    branch: int,
    end: float,
    upward: bool,
) -> float | None:
    """Return where the next orbit of a branch begins beyond a value of a; None if it is not known.

    Orbits that are stable over less than the distance to which changes are located belong to the torus, which is locked
    to them.
    """
    a, kind, in_grid = (table[name].values for name in ("a", "kind", "in_grid"))
    beyond = [k for k in range(len(slots)) if (a[k] > end) == upward and a[k] != end]
    for k in beyond if upward else beyond[::-1]:
        slot = slots[k].get(branch)
        if slot is None:
            if in_grid[k] == 1:
                return None
            continue
        number = followed.of_place.get((k, slot))
        if number is not None:
            low, high = _stable_range(followed.segments[number])
            if high - low >= table.attrs["refine_resolution"]:
                near = low if upward else high
                return near if (near > end) == upward and np.isfinite(near) else None
        elif kind[k, slot] not in REGULAR or kind[k, slot] == MotionKind.QUASIPERIODIC:
            return None
    return None


def _stable_range(segment: BranchSegment) -> tuple[float, float]:
    """Return the range of a over which the orbits of a segment are stable; infinite where its end is not located."""
    low, high = segment.downward.end, segment.upward.end
    return low.a if low else -np.inf, high.a if high else np.inf


def _points(orbit: PeriodicOrbit, far: float, settings: SearchSettings, motion: MotionSettings) -> list[TorusPoint]:
    """Follow the motion from the end of an orbit to another a, and return it at each value, with a ascending.

    It ends early where the motion leaves the neighbourhood of the set at the value before.
    """
    model, near = orbit.model, recorded_a(orbit.model.law)
    before = visit(model, orbit.reference, 0.0, settings.window)
    state, generator = orbit.reference, np.random.default_rng(settings.seed)
    points: list[TorusPoint] = []
    for a in near + (far - near) * np.arange(1, VALUES + 1) / (VALUES + 1):
        search = Convergence(at_recorded_a(model, float(a)), settings, motion)
        section = search.settle(perturb(state, SYMMETRY_PUSH * search.resolution, generator))
        measured = search.measure(section) if section is not None else None
        if measured is None or before is None:
            break
        section, steady = measured
        if not _is_same_set(before, section, SAME_SET * model.scale):
            break
        points.append(TorusPoint(float(a), steady.kind, steady.period, _rotation(section, orbit)))
        before, state = section, section.state()
    return sorted(points, key=lambda point: point.a)


def _is_same_set(before: Returns, after: Returns, largest: float) -> bool:
    """Return whether a torus and a set at a neighbouring a lie near each other; one may be an orbit on the other."""
    pairs = (before.returns, after.returns), (after.returns, before.returns)
    return before.block == after.block and min(distance(*pair, bound=largest) for pair in pairs) <= largest


def _rotation(section: Returns, orbit: PeriodicOrbit) -> float:
    """Return the number of turns about an orbit per period of it; NaN if the motion does not turn about the orbit."""
    every = orbit.stop_counts[section.block - 1]
    if not every:
        return np.nan
    returns, times = section.returns[::every], section.times[::every]
    turn = (times[-1] - times[0]) / (len(times) - 1)
    return mean_rotation(returns) if abs(turn - orbit.period) <= SAME_TURN * orbit.period else np.nan
