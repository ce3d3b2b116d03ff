"""Claims on the section W = 0, crossed upward: the number, position and meaning of its points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.attractors.lookup import reached_values
from burridge_knopoff.claims.conventions import judge_conventions
from burridge_knopoff.claims.evidence import MIN_VALUES, Evidence
from burridge_knopoff.claims.for_all import Case, for_all, judge_cases
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import PERIODIC_KINDS
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Range,
    Verdict,
    describe_where,
    format_values,
)
from burridge_knopoff.motion.kind import MotionKind

if TYPE_CHECKING:
    import xarray


@judge("agreement", "lyapunov")
def one_section_point(evidence: Evidence, initial: str, law: str, a: Range, loose_share: float) -> Verdict:
    """Judge whether the section W = 0, crossed upward, shows one point at each a of a range.

    Periodic motion whose section points do not repeat yet has not settled and is left out.
    """
    kind = evidence.choose(evidence.state_summary("agreement", initial), a).sel(law=law)["kind"].values
    runs = evidence.choose(evidence.state_summary("lyapunov", initial), a).sel(law=law)
    grid, period = runs["a"].values, runs["section_period"].values
    known = (period > 0) | ~np.isin(kind, (*PERIODIC_KINDS, MotionKind.UNDETERMINED))
    unknown = f"the number of section points of the run from {initial} is not known {format_values(grid, ~known)}"
    case = Case(law, grid, period == 1, known, unknown)
    found = for_all(loose_share, [case])
    share = found.share
    reason = (
        f"The section of runs from {initial} ({law}) is one point at {share} of the {share.count} values of a with {a} "
        "at which the motion has settled."
    )
    measured = [Measured("share of a with one section point", share.value)]
    return Verdict(found.verdict, reason, measured, "; ".join(case.exceptions("more than one point", "not settled")))


@judge("lyapunov", "bifurcation_diagram", "attractors")
def cloud_at_lower_velocities(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range, points: int, loose_share: float
) -> Verdict:
    """Judge whether one state has a cloud of section points, at lower velocities W' than the other state's one point.

    initial : the state with one point, the state with the cloud
    points : a section with more points than this is a cloud; an empty section is not
    A cloud is lower if its mean W' is below that of the other state.
    """
    grid, line, cloud = _sections(evidence, initial, law, a)
    known = _has_crossings(line, initial[0], a)
    many, empty = _are_clouds(cloud, points), np.array([len(other) == 0 for other in cloud])
    pairs = [known[k] and not empty[k] for k in range(len(grid))]
    lower = np.array([both and other.mean() < one.mean() for both, one, other in zip(pairs, line, cloud, strict=True)])
    entirely = np.array([both and other.max() < one.min() for both, one, other in zip(pairs, line, cloud, strict=True)])
    case = Case(law, grid, many & lower, known, applies=known)
    found = for_all(loose_share, [case])
    measured = [
        Measured(f"share of a with more than {points} section points from {initial[1]}", float(many[known].mean())),
        Measured("share of a with their mean W' below that of " + initial[0], float(lower[known].mean())),
        Measured("share of a with all of them below it", float(entirely[known].mean())),
    ]
    reason = (
        f"From {initial[1]} ({law}) the section is a cloud at lower velocities than from {initial[0]} at {found.share} "
        f"of the values of a with {a}."
    )

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        inside = evidence.choose(attractors, a)
        (first_known, first), (second_known, second) = (
            reached_values(inside, name, law, "section_count") for name in initial
        )
        (_, above), (_, below) = (reached_values(inside, name, law, "section_velocity_mean") for name in initial)
        seen = first_known & second_known & (first > 0) & (second >= 0)
        case = Case(law, inside["a"].values, (second > points) & (below < above), seen)
        verdict, text = judge_cases(loose_share, [case])
        return verdict, text + "".join(describe_where(", no point at all", case.a, seen & (second == 0)))

    exceptions = case.exceptions("no lower cloud") + describe_where("no point at all", grid, known & empty)
    return judge_conventions(evidence, found.verdict, reason, measured, exceptions, judge_attractors)


@judge("lyapunov", "bifurcation_diagram", "agreement", "attractors")
def cloud_not_periodic(
    evidence: Evidence, initial: str, law: str, a: Range, points: int, loose_share: float
) -> Verdict:
    """Judge whether motion with a cloud as its section is quasiperiodic or chaotic, at all a of a range with a cloud.

    points : a section with more points than this is a cloud

    Motion that repeats within `motion.longest_period` is periodic.
    """
    grid, _, cloud = _sections(evidence, (initial, initial), law, a)
    many = _are_clouds(cloud, points)
    if not many.any():
        raise NotTestableError(f"no section of a run from {initial} is a cloud with {a}")
    kind = evidence.state_summary("agreement", initial).sel(law=law, a=grid[many])["kind"].values
    known = kind != MotionKind.UNDETERMINED
    unknown = (
        f"the kind of motion from {initial} under the {law} law is undetermined {format_values(grid[many], ~known)}"
    )
    case = Case(law, grid[many], ~np.isin(kind, PERIODIC_KINDS), known, unknown)
    found = for_all(loose_share, [case])
    measured = [
        Measured("values of a with a cloud", float(many.sum())),
        Measured("share of them with quasiperiodic or chaotic motion", found.share.value),
    ]
    longest = evidence.config["motion"]["longest_period"]
    reason = (
        f"From {initial} ({law}) the section is a cloud at {many.sum()} of the {len(grid)} values of a with {a}; at "
        f"{found.share} of them the motion does not repeat within {longest:g} time units, or is chaotic."
    )

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        inside = evidence.choose(attractors, a)
        (is_known, count), (_, kind) = (
            reached_values(inside, initial, law, name) for name in ("section_count", "kind")
        )
        seen = is_known & (count > points)
        known = kind != MotionKind.UNDETERMINED
        case = Case(law, inside["a"].values, ~np.isin(kind, PERIODIC_KINDS), known, applies=seen)
        verdict, text = judge_cases(loose_share, [case])
        return verdict, text and f"{text} of {seen.sum()} values of a with a cloud"

    exceptions = case.exceptions("periodic", "undetermined motion")
    return judge_conventions(evidence, found.verdict, reason, measured, exceptions, judge_attractors)


@judge("lyapunov", "bifurcation_diagram", "attractors")
def line_disappears(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range, near: float, loose_share: float
) -> Verdict:
    """Judge whether the section of one state, crossed upward, has no point on the line of another state.

    initial : the state with the line, the state that is to lack it
    near : a point is on the line if its W' differs from that of the other state at this a by at most this fraction
    """
    grid, line, other = _sections(evidence, initial, law, a)
    known = _has_crossings(line, initial[0], a)
    on_line = np.array(
        [
            k and (np.abs(found - one.mean()) <= near * one.mean()).any()
            for k, one, found in zip(known, line, other, strict=True)
        ]
    )
    case = Case(law, grid, ~on_line, known, applies=known)
    found = for_all(loose_share, [case])
    reason = (
        f"From {initial[1]} ({law}) no section point lies within {100.0 * near:g} % of the line from {initial[0]} at "
        f"{found.share} of the values of a with {a}."
    )

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        inside = evidence.choose(attractors, a)
        (first_known, first), (second_known, second) = (reached_values(inside, name, law, "branch") for name in initial)
        case = Case(law, inside["a"].values, first != second, first_known & second_known)
        verdict, text = judge_cases(loose_share, [case])
        return verdict, text and f"another attractor than from {initial[0]} at {case.share}"

    measured = [Measured("share of a without a point on the line", found.share.value)]
    return judge_conventions(
        evidence, found.verdict, reason, measured, case.exceptions("on the line"), judge_attractors
    )


def _sections(
    evidence: Evidence, initial: tuple[str, str], law: str, a: Range
) -> tuple[np.ndarray, list[np.ndarray], list[np.ndarray]]:
    """Return the values of a in a range at which the runs from two states completed, and the section points of both."""
    from burridge_knopoff.summaries.bifurcation_diagram import section_points

    completed = [evidence.state_summary("lyapunov", name).sel(law=law)["status"].notnull() for name in initial]
    grid = completed[0]["a"].values
    grid = grid[a.choose(grid) & completed[0].values & completed[1].values]
    if not len(grid):
        raise NotTestableError(f"no run completed with {a}")
    points = [section_points(evidence.summary("bifurcation_diagram"), law, name, 1) for name in initial]
    first, second = ([velocity[at == value] for value in grid] for at, velocity in points)
    return grid, first, second


def _has_crossings(sections: list[np.ndarray], initial: str, a: Range) -> np.ndarray:
    """Return at which values of a runs from a state cross the section; raises NotTestableError if these are too few."""
    known = np.array([len(one) > 0 for one in sections], dtype=bool)
    if known.sum() < MIN_VALUES:
        raise NotTestableError(
            f"a statement on all {a} needs {MIN_VALUES} values of a at which the run from {initial} crosses the "
            f"section; there are {known.sum()}"
        )
    return known


def _are_clouds(sections: list[np.ndarray], points: int) -> np.ndarray:
    """Return which sections have more than `points` points in the second half of the run."""
    from burridge_knopoff.summaries.attractor_observables import count_distinct

    return np.array([count_distinct(velocity[len(velocity) // 2 :]) > points for velocity in sections], dtype=bool)
