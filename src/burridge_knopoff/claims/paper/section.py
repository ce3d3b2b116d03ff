"""Claims on the section W = 0, crossed upward: the number, position and meaning of its points."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseShare, Near, Points
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.evidence import MIN_VALUES, Evidence
from burridge_knopoff.claims.outcomes import PERIODIC_KINDS, Reached, Runs
from burridge_knopoff.claims.range import BELOW, Range
from burridge_knopoff.claims.statement import Truth, for_all
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Verdict,
    at_values,
    describe_where,
)
from burridge_knopoff.motion.kind import MotionKind

if TYPE_CHECKING:
    import xarray

#: The reason not to judge if runs are missing.
NOT_COMPLETED = "too few runs under the {law} law completed {where}"


@claim("Results, Fig. 4a", "bifurcation_diagram", "agreement", "lyapunov")
def minus_one_section_point(
    evidence: Evidence,
    *,
    initial: str = "minus",
    law: str = "linearized",
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From minus the section W = 0 is one point for a < 0.1, a continuous line in the bifurcation diagram.

    Holds if it is one point at all values of a, and loosely at nine in ten of them. Periodic motion whose section
    points do not repeat yet has not settled and is left out.
    """

    def truth(runs: Runs) -> Truth:
        kind, period = (
            part.sel(law=[law], initial=initial) for part in (runs.kind, runs.of("lyapunov", "section_period"))
        )
        return Truth(period == 1, (period > 0) | ~kind.isin((*PERIODIC_KINDS, MotionKind.UNDETERMINED)))

    unknown = f"the number of section points of the run from {initial} is not known {{where}}"
    share = for_all(evidence, [initial], a, loose_share, truth, unknown)
    return share.conclude(
        f"The section of runs from {initial} ({law}) is one point "
        f"{at_values(share.share, a)} at which the motion has settled.",
        [Measured("share of a with one section point", share.share.value)],
        "more than one point",
        "not settled",
    )


@claim("Results, Fig. 4b", "bifurcation_diagram", "runs", "attractors")
def plus_cloud(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = BELOW,
    points: Points = 8,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From plus the section is a cloud of points at lower velocities for a < 0.1.

    Holds if the section has more than {points} points, and their mean W' is below that of minus, at all values of a;
    and loosely at nine in ten of them.

    initial : the state with one point, the state with the cloud
    """
    first, second = initial

    def truth(motion: Runs | Reached) -> Truth:
        line, cloud = (motion.section.sel(law=[law], initial=state) for state in initial)
        lower = (cloud["count"] > points) & (cloud["mean"] < line["mean"])
        return Truth(lower, line["count"].notnull() & cloud["count"].notnull(), line["count"] != 0)

    share = for_all(evidence, initial, a, loose_share, truth, NOT_COMPLETED, truth)
    line, cloud = _both_sections(evidence, initial, law, a)
    measured = [
        Measured(
            f"share of a with more than {points} section points from {second}", _fraction(cloud["count"] > points)
        ),
        Measured(f"share of a with their mean W' below that of {first}", _fraction(cloud["mean"] < line["mean"])),
        Measured("share of a with all of them below it", _fraction(cloud["max"] < line["min"])),
    ]
    return share.conclude(
        f"From {second} ({law}) the section is a cloud at lower velocities than from {first} "
        f"{at_values(share.share, a)}.",
        measured,
        "no lower cloud",
        further=describe_where("no point at all", cloud["a"].values, cloud["count"].values == 0),
    )


@claim("Results, Fig. 4b", "bifurcation_diagram", "runs", "agreement", "attractors")
def plus_not_periodic(
    evidence: Evidence,
    *,
    initial: str = "plus",
    law: str = "linearized",
    a: Range = BELOW,
    points: Points = 8,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From plus the cloud of section points indicates quasiperiodic or chaotic motion for a < 0.1.

    Holds if the motion is not periodic at all values of a at which the section has more than {points} points, and
    loosely at nine in ten of them. Motion that repeats within `motion.longest_period` is periodic.
    """

    def truth(motion: Runs | Reached) -> Truth:
        count, kind = (part.sel(law=[law], initial=initial) for part in (motion.section["count"], motion.kind))
        known = (kind != MotionKind.UNDETERMINED) & count.notnull()
        # An unknown section may be a cloud.
        return Truth(~kind.isin(PERIODIC_KINDS), known, ~(count <= points))

    unknown = f"the kind of motion from {initial} under the {law} law is undetermined {{where}}"
    count = Runs(evidence, [initial], a).section["count"].sel(law=law, initial=initial)
    clouds, completed = int((count > points).sum()), int(count.notnull().sum())
    if not clouds:
        raise NotTestableError(f"no section of a run from {initial} is a cloud with {a}")
    share = for_all(evidence, [initial], a, loose_share, truth, unknown, truth)
    longest = evidence.config["motion"]["longest_period"]
    return share.conclude(
        f"From {initial} ({law}) the section is a cloud at {clouds} of the {completed} values of a with {a}; at "
        f"{share.share} of them the motion does not repeat within {longest:g} time units, or is chaotic.",
        [
            Measured("values of a with a cloud", float(clouds)),
            Measured("share of them with quasiperiodic or chaotic motion", share.share.value),
        ],
        "periodic",
        "undetermined motion",
    )


@claim("Results, Fig. 4b", "bifurcation_diagram", "runs", "bifurcation_diagram", "attractors")
def plus_line_disappears(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = BELOW,
    near: Near = 0.01,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From plus the line of section points that minus has disappears for a < 0.1.

    Holds if no W' of a section point from plus is within a fraction of {near:g} of that of minus at all values of a,
    and loosely at nine in ten of them.

    initial : the state with the line, the state that is to lack it
    """
    first, second = initial
    _both_sections(evidence, initial, law, a)
    points = dict(zip(*_upward_points(evidence, law, second), strict=True))

    def truth(runs: Runs) -> Truth:
        mean = runs.section["mean"].sel(law=[law], initial=first)
        on_line = [
            bool((np.abs(points.get(value, np.zeros(0)) - at) <= near * at).any())
            for value, at in zip(mean["a"].values.tolist(), mean.values[0], strict=True)
        ]
        count = runs.section["count"].sel(law=[law])
        return Truth(
            ~mean.copy(data=[on_line]).astype(bool), count.notnull().all("initial"), count.sel(initial=first) != 0
        )

    def reached(motion: Reached) -> Truth:
        branch = motion.branch.sel(law=[law])
        line, cloud = (branch.sel(initial=state) for state in initial)
        return Truth(line != cloud, (branch >= 0).all("initial"))

    share = for_all(evidence, initial, a, loose_share, truth, NOT_COMPLETED, reached)
    return share.conclude(
        f"From {second} ({law}) no section point lies within {100.0 * near:g} % of the line from {first} "
        f"{at_values(share.share, a)}.",
        [Measured("share of a without a point on the line", share.share.value)],
        "on the line",
    )


def _both_sections(
    evidence: Evidence, initial: tuple[str, ...], law: str, a: Range
) -> tuple[xarray.Dataset, xarray.Dataset]:
    """Return the sections of completed runs from two states, over those a at which the first has section points.

    Raises NotTestableError if these are too few.
    """
    sections = Runs(evidence, initial, a).section.sel(law=law)
    line, cloud = (sections.sel(initial=state) for state in initial)
    known = (line["count"] > 0) & cloud["count"].notnull()
    if known.sum() < MIN_VALUES:
        raise NotTestableError(
            f"a statement on all {a} needs {MIN_VALUES} values of a at which the run from {initial[0]} crosses the "
            f"section; there are {int(known.sum())}"
        )
    return line.isel(a=known.values), cloud.isel(a=known.values)


def _upward_points(evidence: Evidence, law: str, initial: str) -> tuple[list[float], list[np.ndarray]]:
    """Return the values of a, and W' of all upward crossings of the runs from a state at each of them."""
    from burridge_knopoff.summaries.bifurcation_diagram import section_points

    a, velocity = section_points(evidence.summary("bifurcation_diagram"), law, initial, 1)
    values, starts = np.unique(a, return_index=True)
    return values.tolist(), np.split(velocity, starts[1:])


def _fraction(chosen: xarray.DataArray) -> float:
    return float(chosen.mean())
