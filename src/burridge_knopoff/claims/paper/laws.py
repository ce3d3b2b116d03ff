"""Claims on the two friction laws: whether they agree, and whether linearizing is justified."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseShare, LooseTolerance, RunPart, Tolerance
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence, check_covered
from burridge_knopoff.claims.outcomes import one_chaos
from burridge_knopoff.claims.range import BELOW, Range
from burridge_knopoff.claims.statement import Case, Statement, Truth, decided
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Verdict,
    count_share,
    describe_where,
    extremes,
    format_shares,
    judge_share,
    judge_value,
    worst_verdict,
)
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import SYNCHRONOUS, MotionKind, is_same_result, merge_chaos
from burridge_knopoff.study.formatting import with_error
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray

#: The two readings of a nonlinearity that is not relevant.
ON_ATTRACTORS, FROM_STATES = "on the attractors", "from the paper's states"


@claim("Introduction; Results, Fig. 3", "agreement", "agreement")
def laws_agree(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """Linearizing the friction law does not change the results, ⟨J⟩ against a, for a < 0.1.

    "A close correspondence" of two figures of ⟨J⟩. The study's relative tolerance of agreement may be applied to the
    largest ⟨J⟩ in the range, as curves in a figure correspond: those of both states have one scale. Or it may be
    applied to ⟨J⟩ at each a, as in agreement.nc: curves that coincide in a figure may then differ where ⟨J⟩ is small.
    The curve of each state is judged for itself.
    """
    from burridge_knopoff.summaries.judgement import excess, same_mean

    laws = _law_comparison(evidence, initial, a)
    scale = float(laws["mean_distance"].max())
    beyond = excess(laws["difference"], scale, laws.attrs["synchronization_threshold"], laws.attrs)
    synchronous = laws["kind"].isin(SYNCHRONOUS).all("law")
    of_largest = same_mean(beyond, laws["difference_error"], synchronous, laws.attrs)
    difference = abs(laws["difference"]).where(of_largest == Answer.YES).max("a")
    measured = [
        Measured("largest ⟨J⟩", scale),
        *(
            Measured(f"largest |Δ⟨J⟩| where they agree on the scale of the largest, {state}", value)
            for state, value in zip(initial, difference.values.tolist(), strict=True)
            if np.isfinite(value)
        ),
    ]
    tolerance = 100.0 * laws.attrs["relative_tolerance"]
    words = f"Under the two laws ⟨J⟩ (up to {scale:.3f}) agrees within {tolerance:g} %"
    readings = {"of the largest value": of_largest, "of the value at each a": laws["same_mean_distance"]}
    return _judge_agreement(evidence, words, readings, a, loose_share, measured)


@claim("Conclusions", "agreement", "agreement")
def laws_agree_in_kind(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """The nonlinearity of the friction law is not essential for the kind of motion for a < 0.1.

    The kinds may be those that the paper names: periodic, quasiperiodic and chaotic. Or they may be synchrony, other
    regular motion and chaos: a torus is locked to periodic orbits on a dense set of a, so that a single value of a may
    show either.
    """
    laws = _law_comparison(evidence, initial, a)
    same, kinds = laws["same_kind"], one_chaos(laws["kind"])
    differ = kinds.sel(law=PAPER_LAWS[0], drop=True) != kinds.sel(law=PAPER_LAWS[1], drop=True)
    readings = {
        "with periodic and quasiperiodic motion as two kinds": same.where(~((same == Answer.YES) & differ), Answer.NO),
        "with periodic and quasiperiodic motion as one kind": same,
    }
    return _judge_agreement(evidence, "The laws agree in the kind of motion", readings, a, loose_share)


def _law_comparison(evidence: Evidence, initial: Sequence[str], a: Range) -> xarray.Dataset:
    return evidence.choose(evidence.law_comparison(evidence.state_summary("agreement", initial)), a)


def _judge_agreement(
    evidence: Evidence,
    words: str,
    readings: Mapping[str, xarray.DataArray],
    a: Range,
    loose_share: float,
    measured: Sequence[Measured] = (),
) -> Verdict:
    """Judge whether the laws agree, from each state for itself.

    words : what the readings qualify
    readings : Answer at each point, over (initial, a), under each reading
    """
    verdicts, texts, numbers, exceptions = {}, [], [], []
    for reading, agrees in readings.items():
        truth = Truth(agrees == Answer.YES, agrees.isin((Answer.YES, Answer.NO)))
        cases = list(truth.cases("the laws could not be compared from {initial} {where}"))
        states = decided(Statement(evidence, cases, loose_share))
        unknown = [text for case in cases for text in describe_where("undetermined", case.a, ~case.is_known, case.name)]
        verdicts[reading] = worst_verdict(judge_share(share, loose_share) for share in states.shares.values())
        texts.append(f"{reading}, {states.at(a)} ({verdicts[reading]})")
        numbers += states.measured(f"share of a at which the laws agree, {reading}", partial(_parting, reading))
        exceptions += [f"{reading}, {text}" for text in (*states.exceptions("they differ"), *unknown)]
    return combine_readings(verdicts, f"{words}: {'; '.join(texts)}.", [*numbers, *measured], exceptions)


def _parting(reading: str, case: Case) -> Iterator[Measured]:
    """Yield the smallest a at which the laws differ."""
    if len(differ := case.a[case.is_known & ~case.is_true]):
        yield Measured(f"smallest a at which they differ, {reading}, {case.name}", float(differ[0]))


@claim(
    "Conclusions",
    "agreement",
    "agreement",
    "attractors",
    depends_on=("sticks_unavoidable", "laws_agree_in_kind"),
)
def stick_slip_alone(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """For a < 0.1 the only relevant nonlinearity is that of stick-slip.

    Holds if some block stops on every attractor and both laws give the same result, synchrony, other regular motion or
    chaos, at all values of a; and loosely at nine in ten of each. While all blocks slip, linearized motion grows
    without bound, so that sticking is relevant where some block stops.

    The results are those on the same attractors, branch by branch, or those from the paper's states, which may lie near
    a boundary of basins that the law moves.
    """
    attractors = evidence.choose(evidence.own_attractors(), a)
    stopping = {}
    for law in PAPER_LAWS:
        slots = attractors.sel(law=law)
        stops = (slots["stop_rate"] > 0.0).any("block").values[slots["branch"].values >= 0]
        if not len(stops):
            raise NotTestableError(f"no attractor is known under the {law} law with {a}")
        stopping[law] = count_share(stops)
    same = _law_comparison(evidence, initial, a)["same_kind"]
    truths = {
        ON_ATTRACTORS: _same_attractors(attractors),
        FROM_STATES: Truth(same == Answer.YES, same.isin((Answer.YES, Answer.NO))),
    }
    of_stops = worst_verdict(judge_share(share, loose_share) for share in stopping.values())
    readings, measured, texts, exceptions = {}, [], [], []
    for reading, truth in truths.items():
        cases = list(truth.cases("the results under the two laws are not known {where}"))
        statement = decided(Statement(evidence, cases, loose_share))
        of_laws = (judge_share(share, loose_share) for share in statement.shares.values())
        readings[reading] = worst_verdict([of_stops, *of_laws])
        measured += statement.measured(f"share of a at which the laws have the same result, {reading}")
        texts.append(f"{reading}, {statement.at(a)} ({readings[reading]})")
        exceptions += [f"{reading}, {text}" for text in statement.exceptions("they differ", "undetermined")]
    measured += [
        Measured(f"share of attractors on which some block stops, {law}", share.value)
        for law, share in stopping.items()
    ]
    reason = (
        f"Some block stops on {format_shares(stopping)} of the attractors. Both laws have the same result "
        f"{'; '.join(texts)}."
    )
    return combine_readings(readings, reason, measured, exceptions)


def _same_attractors(attractors: xarray.Dataset) -> Truth:
    """Return at which a the laws have the same branches of attractors, with the same result on each; over a."""
    branches, results = (
        np.stack([attractors[name].sel(law=law).transpose("a", "attractor").values for law in PAPER_LAWS], axis=1)
        for name in ("branch", "kind")
    )
    is_same, is_known = [], []
    for pair in zip(branches, merge_chaos(results), strict=True):
        left, right = (
            {int(number): int(kind[branch == number][0]) for number in branch[branch >= 0]}
            for branch, kind in zip(*pair, strict=True)
        )
        is_known.append(bool(left and right) and MotionKind.UNDETERMINED not in (*left.values(), *right.values()))
        is_same.append(
            left.keys() == right.keys()
            and bool(is_same_result(np.array([*left.values()]), np.array([right[number] for number in left])).all())
        )
    over_a = attractors["branch"].isel(law=0, attractor=0)
    return Truth(*(over_a.copy(data=np.array(values)) for values in (is_same, is_known)))


@claim("Introduction; The linearization", "friction_laws", "mean_distance")
def linearization_justified(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = BELOW,
    part: RunPart = "window",
    tolerance: Tolerance = 0.01,
    loose: LooseTolerance = 0.05,
) -> Verdict:
    """The linearization of the friction law is justified for small a.

    Holds if the laws differ by at most {tolerance:g} of the static friction at the fastest slips of the runs, and
    loosely by at most {loose:g}. They differ by (aU')²/(1 + aU').

    law : the linearized law, whose friction 1 − aU' gives the speed
    part : part of the runs: window, or run with its transient
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, part)
    product = grid * evidence.config["v"] * speed
    top = int(np.argmax(product))
    difference = float(product[top] ** 2 / (1.0 + product[top]))
    measured = [
        Measured("largest difference of the laws on a slipping block", difference),
        Measured("largest aU'", float(product[top])),
        *extremes("ratio of the fastest slip to v", speed),
    ]
    verdict = HOLDS if difference <= tolerance else LOOSELY if difference <= loose else FAILS
    reason = (
        f"For {a} the laws differ by at most {difference:.2g} of the static friction on a slipping block (at a = "
        f"{grid[top]:g}), since the fastest slips {'in the window' if part == 'window' else 'of the whole run'} are "
        f"{speed.min():.2f} to {speed.max():.2f} times as fast as the driver."
    )
    return Verdict(verdict, reason, measured)


@claim("Introduction", "friction_laws", "orbits", "mean_distance")
def springs_and_masses_help(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = BELOW,
    claimed: float = 1.0,
    tolerance: Tolerance = 0.25,
    loose: LooseTolerance = 0.5,
) -> Verdict:
    """Strong springs and large masses, which make a small, justify the linearization.

    Holds if the results of the laws become equal as a falls: the relative difference of ⟨J⟩ on the antiphase orbit,
    branch 2, falls in proportion to a or faster, as a power of a that is at least {claimed:g} within {tolerance:g}; and
    loosely within {loose:g}.

    What stronger springs do depends on what is held fixed. At a fixed v, as in the paper's study, av falls with a. At a
    fixed velocity V of the driver v grows as a falls, and av = cV stays, where F(0)/(1 + cV) is the friction. The
    paper's choice is the first reading.

    The friction forces are a remark. They differ by (aU')² on a slipping block. At one a, linearized motion is
    proportional to v, so that aU' is av times the ratio of slip speed to v, a function of a alone that is known from
    the windows of the runs.
    """
    names = "at a fixed v", "at a fixed V, which leaves av = cV unchanged"
    slips = _fastest_slips(evidence, initial, law, a, "window")
    return _judge_powers(_result_differences(evidence, a), slips, names, claimed, tolerance, loose)


@claim("Introduction", "friction_laws", "orbits", "mean_distance", depends_on=("springs_and_masses_help",))
def low_friction_helps(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    law: str = "linearized",
    a: Range = BELOW,
    claimed: float = 1.0,
    tolerance: Tolerance = 0.25,
    loose: LooseTolerance = 0.5,
) -> Verdict:
    """A low friction force that depends weakly on the velocity, which makes a small, justifies the linearization.

    Holds, like `springs_and_masses_help`, if the relative difference of ⟨J⟩ on the antiphase orbit falls as a power of
    a that is at least {claimed:g} within {tolerance:g}; and loosely within {loose:g}.

    Here a = cF(0)/√(km) and v = V√(km)/F(0). A weak dependence is a small c, which leaves v as it is. A low friction is
    a small F(0): at a fixed velocity V of the driver v grows, and av = cV stays. The difference of the forces is a
    fraction of F(0).
    """
    names = "through c", "through F(0) at a fixed V, which leaves av = cV unchanged"
    slips = _fastest_slips(evidence, initial, law, a, "window")
    return _judge_powers(_result_differences(evidence, a), slips, names, claimed, tolerance, loose)


def _result_differences(evidence: Evidence, a: Range) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the values of a, and the relative differences of ⟨J⟩ on the antiphase orbit at a fixed v and fixed av."""
    names = "antiphase_difference", "antiphase_difference_fixed_av"
    orbits = evidence.choose(evidence.summary("orbits"), a)
    differences = np.abs([orbits[name].values for name in names])
    is_known = (differences > 0.0).all(axis=0)
    check_covered(orbits["a"].values[is_known], a, "the antiphase orbit")
    return orbits["a"].values[is_known], [*differences[:, is_known]]


def _judge_powers(
    results: tuple[np.ndarray, list[np.ndarray]],
    slips: tuple[np.ndarray, np.ndarray],
    names: tuple[str, str],
    claimed: float,
    tolerance: float,
    loose: float,
) -> Verdict:
    """Judge the power of a with which the difference of the results of the laws falls; say that of the forces.

    results : see `_result_differences`; slips : a and speed, see `_fastest_slips`
    names : of the readings in which v is fixed, and in which av is
    """
    (grid, differences), (slip_a, speed) = results, slips
    least, largest = int(np.argmin(grid)), int(np.argmax(grid))
    readings, measured, texts, forces = {}, [], [], []
    for name, difference, product in zip(names, differences, (slip_a * speed, speed), strict=True):
        power, error = _power(grid, difference)
        readings[name] = judge_value(min(power, claimed), claimed, tolerance, loose)
        measured.append(Measured(f"power of a with which the difference of ⟨J⟩ falls {name}", power, error))
        texts.append(
            f"from {100 * difference[largest]:.2g} to {100 * difference[least]:.2g} %, as a to the power "
            f"{with_error(power, error)}, {name} ({readings[name]})"
        )
        power, error = _power(slip_a, product**2)
        measured.append(Measured(f"power of a with which the difference of the forces falls {name}", power, error))
        forces.append(f"the friction forces differ as a to the power {with_error(power, error)} {name}")
    reason = (
        f"From a = {grid[largest]:g} down to {grid[least]:g} the difference of ⟨J⟩ between the laws, on the antiphase "
        f"orbit, falls {'; '.join(texts)}."
    )
    return combine_readings(readings, reason, measured, forces)


def _power(grid: np.ndarray, values: np.ndarray) -> tuple[float, float | None]:
    """Return the power of a in some values by least squares of logarithms, and its error.

    The error is the change of the power if the next order is fitted as well, a factor exp(ka); None for fewer than four
    values of a.
    """
    columns = np.stack([np.ones(len(grid)), np.log(grid), grid], axis=1)
    power, limit = (float(np.linalg.lstsq(columns[:, :count], np.log(values))[0][1]) for count in (2, 3))
    return power, abs(limit - power) if len(np.unique(grid)) > 3 else None


def _fastest_slips(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, fastest slip divided by v) of all completed runs, from their least friction 1 − aU'."""
    slips = []
    for state in initial:
        runs = evidence.choose(evidence.state_summary("mean_distance", state), a).sel(law=law)
        friction = runs["window_least_friction" if part == "window" else "least_friction"].values
        completed = np.isfinite(friction)
        if not completed.any():
            raise NotTestableError(f"no run from {state} completed with {a}")
        slips.append((runs["a"].values[completed], 1.0 - friction[completed]))
    grid, product = (np.concatenate(part) for part in zip(*slips, strict=True))
    return grid, product / (grid * evidence.config["v"])
