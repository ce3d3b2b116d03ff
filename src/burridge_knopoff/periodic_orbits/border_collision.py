"""Continuation of a branch of periodic orbits through a grazing, where the branch has a corner.

The return map of a grazing orbit is continuous, but its derivative jumps, since a stop removes a velocity perturbation
however short the stick is; the next terms are of order 3/2. The branch therefore has a corner, and Floquet multipliers
jump. Either the orbit continues with one stick more or less, or the orbits with and without the stick exist on the same
side of the grazing and meet there: the grazing is then a turning point of the branch (a non-smooth fold).

If friction drops at the start of a slip, the return map itself jumps, and the branch ends.

Reference: M. di Bernardo, C. J. Budd, A. R. Champneys and P. Kowalczyk, "Piecewise-smooth Dynamical Systems" (Springer
2008), Sections 3.1 (border collisions) and 8.3 (grazing-sliding).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from burridge_knopoff.model.model import ChainState
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.periodic_orbits.critical_values import critical_values
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.grazing_distances import has_friction_drop
from burridge_knopoff.periodic_orbits.minimal_orbit import reduced_orbit
from burridge_knopoff.periodic_orbits.periodic import missing_isolation_of, orbit_of
from burridge_knopoff.periodic_orbits.pseudo_arclength import BranchOrbit, step_along, tangent_of

# Distance at which a corner counts as reached, and limits on the number of steps and of failed steps.
CORNER_DISTANCE = 1e-10
STEPS = 32
FAILURES = 14

# First step towards a corner, as a fraction of the length within which it lies. Later steps are at most LARGEST_SHARE
# of the predicted length; the share grows after a successful step, and share and step shrink after a failed step.
PROBE = 1e-2
LARGEST_SHARE = 0.97
SHARE_GROWTH = 2.0
STEP_REDUCTION = 0.4

# Number of steps within which a branch may join a branch of simpler orbits.
STEPS_TO_BRANCH_POINT = 2.0

# Distances beyond a corner at which the tangent on the other side is computed, and lengths of the first steps, to be
# tried in turn.
OFFSETS_BEYOND = (1e-5, 1e-4, 1e-6)
FIRST_STEPS = (1e-5, 1e-4, 1e-6, 1e-7)


def distance_to_grazing(before: BranchOrbit, point: BranchOrbit) -> float:
    """Return the length to the next grazing, extrapolated from two neighbouring points; infinite if none is ahead.

    The grazing distance decreases in proportion to the length.
    """
    last, distances = before.grazing_distances.values(), point.grazing_distances.values()
    with np.errstate(invalid="ignore", divide="ignore"):
        ahead = distances * point.length / (last - distances)
    ahead = ahead[np.isfinite(ahead) & (ahead > 0.0)]
    return float(ahead.min()) if len(ahead) else np.inf


def smooth_step(path: Sequence[BranchOrbit], length: float) -> BranchOrbit | None:
    """Return the orbit at a length from the end of a path along a branch; None if none with the same stops is found.

    If it is a simpler orbit, traversed several times or described without its symmetry, `reduced_orbit` is that orbit;
    beyond a Hopf bifurcation it is uniform sliding.
    It is accepted only if the path approaches it, so that the multiplier that equals 1 there approaches 1. A long step
    may also jump to such an orbit that is not on the branch.
    """
    point = path[-1]
    try:
        candidate = step_along(point, length)
    except OrbitError:
        return None
    if candidate.orbit.stop_counts != point.orbit.stop_counts:
        return None
    simpler = candidate.reduced_orbit or reduced_orbit(candidate.orbit)
    if simpler is not None and not _distance_to_branch_point(path) <= STEPS_TO_BRANCH_POINT * length:
        return None
    return replace(candidate, reduced_orbit=simpler)


def _distance_to_branch_point(path: Sequence[BranchOrbit]) -> float:
    """Return the length from the end of a path to where an approaching multiplier reaches 1; otherwise infinite.

    There a branch of orbits with less symmetry, or with twice the period, joins a branch of simpler orbits.
    """
    if len(path) < 2:
        return np.inf
    before, value = (
        critical_values(point.orbit, point.multipliers)[BifurcationKind.FOLD, "symmetry_preserving"]
        for point in path[-2:]
    )
    nearer = abs(before) - abs(value)
    return abs(value) * path[-1].length / nearer if nearer > 0.0 else np.inf


def approach_grazing(before: Sequence[BranchOrbit], length: float) -> list[BranchOrbit]:
    """Return the orbits that continue a path up to the grazing that lies within about a length.

    Near a turning point a step may end on the other side, with different stops; it is repeated with a shorter length.
    """
    path: list[BranchOrbit] = []
    step, share, failures = PROBE * length, LARGEST_SHARE, 0
    for _ in range(STEPS):
        if sum(point.length for point in path) > length or failures > FAILURES:
            break
        points = [*before[-2:], *path]
        candidate = smooth_step(points, step)
        if candidate is None:
            failures += 1
            share *= STEP_REDUCTION
            step *= STEP_REDUCTION
            if step < CORNER_DISTANCE:
                break
            continue
        ahead = distance_to_grazing(points[-1], candidate)
        path.append(candidate)
        if candidate.reduced_orbit is not None:
            break
        if ahead < CORNER_DISTANCE:
            return [*path[:-1], replace(candidate, distance_to_grazing=ahead)]
        share = min(SHARE_GROWTH * share, LARGEST_SHARE)
        step = min(share * ahead, length)
    return path


def switch_branch(point: BranchOrbit) -> BranchOrbit | None:
    """Return an orbit on the other side of the grazing that a branch has reached; None if the branch ends there."""
    orbit, line = point.orbit, point.line
    if has_friction_drop(orbit.model):
        return None
    blocks = orbit.model.blocks
    scale = line.units.state(blocks)
    size = max(float(np.abs(point.tangent[:-2] / scale).max()), 1e-3)
    change = point.tangent[:-2] / size
    # The smallest speed of an orbit without stops depends on v as well: both must change as along the branch.
    ahead = float(point.tangent[-1]) / (1.0 if any(orbit.stop_counts) else size)
    for beyond in OFFSETS_BEYOND:
        vector = orbit.reference.vector() + beyond * change
        state = ChainState(vector[:blocks], vector[blocks:], orbit.reference.stuck)
        try:
            coordinate = line.coordinate(orbit.model) + beyond * ahead
            model = line.model(orbit.model, max(coordinate, line.lower_bound))
            tangent = tangent_of(orbit_of(model, state, orbit.return_time, orbit.symmetry), line)
        except OrbitError:
            continue
        for length in FIRST_STEPS:
            for side in (1.0, -1.0):
                try:
                    candidate = step_along(point, length, side * tangent)
                except OrbitError:
                    continue
                # Reject uniform sliding and neutral orbits without stops, as at a = 0. Reject multiple traversals of a
                # simpler orbit near the corner, which does not continue the branch. Reject the mirror image of the path
                # itself: its corner is then the point at which less symmetric orbits begin.
                signature = candidate.orbit.stop_counts
                if (
                    signature not in (orbit.stop_counts, orbit.stop_counts[::-1])
                    and not missing_isolation_of(candidate.orbit)
                    and reduced_orbit(candidate.orbit) is None
                ):
                    return candidate
    return None
