"""Claims on the section W = 0, crossed upward: the number, position and meaning of its points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.attractors.lookup import reached
from burridge_knopoff.claims.conventions import judge_shares, under_conventions
from burridge_knopoff.claims.evidence import LEAST_VALUES, Evidence
from burridge_knopoff.claims.kinds import CLOSED
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Range,
    Verdict,
    at_values,
    is_decided,
    known_share,
    share_of,
    verdict_of,
)
from burridge_knopoff.motion.kind import MotionKind

if TYPE_CHECKING:
    import xarray


def one_section_point(evidence: Evidence, initial: str, law: str, a: Range, loose_share: float) -> Verdict:
    """Judge whether the section W = 0, crossed upward, shows one point at each a of a range.

    Closed motion whose section points do not repeat yet has not settled and is left out.
    """
    kind = evidence.choose(evidence.of_state("agreement", initial), a).sel(law=law)["kind"].values
    runs = evidence.choose(evidence.of_state("lyapunov", initial), a).sel(law=law)
    grid, period = runs["a"].values, runs["section_period"].values
    known = (period > 0) | ~np.isin(kind, (*CLOSED, MotionKind.UNDETERMINED))
    one = period == 1
    unknown = f"the section of the run from {initial} is unknown {at_values(grid, ~known)}"
    share = known_share(one, known, loose_share, unknown)
    measured = [Measured("share of a with one section point", share.value)]
    reason = (
        f"The section of runs from {initial} ({law}) is one point at {share} of the {share.count} values of a with {a} "
        "at which it is known."
    )
    changes = [f"more than one {at_values(grid, known & ~one)}"] if share.value < 1.0 else []
    if not known.all():
        changes.append(f"unknown {at_values(grid, ~known)}")
    return Verdict(verdict_of({law: share}, loose_share), reason, measured, "; ".join(changes))


def cloud_at_lower_velocities(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range, points: int, loose_share: float
) -> Verdict:
    """Judge whether one state has a cloud of section points, at lower velocities W' than the other state's one point.

    initial : the state with one point, the state with the cloud
    points : a section with more points than this is a cloud; an empty section is not
    A cloud is lower if its mean W' is below that of the other state.
    """
    grid, line, cloud = _sections(evidence, initial, law, a)
    known = _crossed(line, initial[0], a)
    many, empty = _many(cloud, points), np.array([len(other) == 0 for other in cloud])
    pairs = [known[k] and not empty[k] for k in range(len(grid))]
    lower = np.array([both and other.mean() < one.mean() for both, one, other in zip(pairs, line, cloud, strict=True)])
    entirely = np.array([both and other.max() < one.min() for both, one, other in zip(pairs, line, cloud, strict=True)])
    share = share_of((many & lower)[known])
    own = verdict_of({law: share}, loose_share)
    measured = [
        Measured(f"share of a with more than {points} section points from {initial[1]}", float(many[known].mean())),
        Measured("share of a with their mean W' below that of " + initial[0], float(lower[known].mean())),
        Measured("share of a with all of them below it", float(entirely[known].mean())),
    ]
    reason = (
        f"From {initial[1]} ({law}) the section is a cloud at lower velocities than from {initial[0]} at {share} of "
        f"the values of a with {a}."
    )
    exceptions = [f"no lower cloud {at_values(grid, known & ~(many & lower))}"] if share.value < 1.0 else []
    if (known & empty).any():
        exceptions.append(f"no point at all {at_values(grid, known & empty)}")

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        found = evidence.choose(attractors, a)
        (there, first), (also, second) = (reached(found, name, law, "section_count") for name in initial)
        (_, above), (_, below) = (reached(found, name, law, "section_velocity_mean") for name in initial)
        seen = there & also & (first > 0) & (second >= 0)
        right = (second > points) & (below < above)
        if not is_decided(right, seen, loose_share):
            return "", ""
        verdict, text = judge_shares({law: share_of(right[seen])}, loose_share)
        none = seen & (second == 0)
        return verdict, text + (f", no point at all {at_values(found['a'].values, none)}" if none.any() else "")

    return under_conventions(evidence, own, reason, measured, exceptions, labels)


def cloud_not_periodic(
    evidence: Evidence, initial: str, law: str, a: Range, points: int, loose_share: float
) -> Verdict:
    """Judge whether motion with a cloud as its section is quasiperiodic or chaotic, at all a of a range with a cloud.

    points : a section with more points than this is a cloud

    Motion that repeats within `motion.longest_period` is periodic.
    """
    grid, _, cloud = _sections(evidence, (initial, initial), law, a)
    many = _many(cloud, points)
    if not many.any():
        raise NotTestableError(f"no section of a run from {initial} is a cloud with {a}")
    kind = evidence.of_state("agreement", initial).sel(law=law, a=grid[many])["kind"].values
    known, right = kind != MotionKind.UNDETERMINED, ~np.isin(kind, CLOSED)
    unknown = f"the kind of motion from {initial} under the {law} law is unknown {at_values(grid[many], ~known)}"
    share = known_share(right, known, loose_share, unknown)
    own = verdict_of({law: share}, loose_share)
    measured = [
        Measured("values of a with a cloud", float(many.sum())),
        Measured("share of them with quasiperiodic or chaotic motion", share.value),
    ]
    longest = evidence.config["motion"]["longest_period"]
    reason = (
        f"From {initial} ({law}) the section is a cloud at {many.sum()} of the {len(grid)} values of a with {a}; at "
        f"{share} of them the motion does not repeat within {longest:g} time units, or is chaotic."
    )
    exceptions = [f"periodic {at_values(grid[many], known & ~right)}"] if share.value < 1.0 else []
    if not known.all():
        exceptions.append(f"unknown {at_values(grid[many], ~known)}")

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        found = evidence.choose(attractors, a)
        (there, count), (_, kind) = (reached(found, initial, law, name) for name in ("section_count", "kind"))
        seen = (there & (count > points))[there]
        known, right = kind[there][seen] != MotionKind.UNDETERMINED, ~np.isin(kind[there][seen], CLOSED)
        if not is_decided(right, known, loose_share):
            return "", ""
        verdict, text = judge_shares({law: share_of(right[known])}, loose_share)
        return verdict, f"{text} of {seen.sum()} values with a cloud"

    return under_conventions(evidence, own, reason, measured, exceptions, labels)


def line_disappears(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range, near: float, loose_share: float
) -> Verdict:
    """Judge whether the section of one state, crossed upward, has no point on the line of another state.

    initial : the state with the line, the state that is to lack it
    near : a point is on the line if its W' differs from that of the other state at this a by at most this fraction
    """
    grid, line, other = _sections(evidence, initial, law, a)
    known = _crossed(line, initial[0], a)
    there = np.array(
        [
            k and (np.abs(found - one.mean()) <= near * one.mean()).any()
            for k, one, found in zip(known, line, other, strict=True)
        ]
    )
    share = share_of(~there[known])
    own = verdict_of({law: share}, loose_share)
    reason = (
        f"From {initial[1]} ({law}) no section point lies within {100.0 * near:g} % of the line from {initial[0]} at "
        f"{share} of the values of a with {a}."
    )
    exceptions = [f"on the line {at_values(grid, known & there)}"] if share.value < 1.0 else []

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        found = evidence.choose(attractors, a)
        (also, first), (there, second) = (reached(found, name, law, "branch") for name in initial)
        if not is_decided(first != second, also & there, loose_share):
            return "", ""
        share = share_of((first != second)[also & there])
        return judge_shares({law: share}, loose_share)[0], f"another attractor than from {initial[0]} at {share}"

    measured = [Measured("share of a without a point on the line", share.value)]
    return under_conventions(evidence, own, reason, measured, exceptions, labels)


def _sections(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range
) -> tuple[np.ndarray, list[np.ndarray], list[np.ndarray]]:
    """Return the values of a in a range at which the runs from two states completed, and the section points of both."""
    from burridge_knopoff.summaries.bifurcation_diagram import section_points

    completed = [evidence.of_state("lyapunov", name).sel(law=law)["status"].notnull() for name in initial]
    grid = completed[0]["a"].values
    grid = grid[a.choose(grid) & completed[0].values & completed[1].values]
    if not len(grid):
        raise NotTestableError(f"no run completed with {a}")
    points = [section_points(evidence.summary("bifurcation_diagram"), law, name, 1) for name in initial]
    first, second = ([velocity[at == value] for value in grid] for at, velocity in points)
    return grid, first, second


def _crossed(sections: list[np.ndarray], initial: str, a: Range) -> np.ndarray:
    """Return at which values of a runs from a state cross the section; raises NotTestableError if these are too few."""
    known = np.array([len(one) > 0 for one in sections], dtype=bool)
    if known.sum() < LEAST_VALUES:
        raise NotTestableError(
            f"a statement on all {a} needs {LEAST_VALUES} values of a at which the run from {initial} crosses the "
            f"section; there are {known.sum()}"
        )
    return known


def _many(sections: list[np.ndarray], points: int) -> np.ndarray:
    """Tell which sections have more than `points` points in the second half of the run."""
    from burridge_knopoff.summaries.along_attractor import distinct

    return np.array([distinct(velocity[len(velocity) // 2 :]) > points for velocity in sections], dtype=bool)
