"""Claims on the two friction laws and the solvers: agreement and cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, ForAll, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    describe_where,
    extremes,
    format_shares,
    judge_share,
    judge_value,
)
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import SYNCHRONOUS, merge_chaos
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.judgement import excess, same_mean

if TYPE_CHECKING:
    import xarray

#: {initial state: (a, whether the laws agree there, as an Answer)}
Answers = dict[str, tuple[np.ndarray, np.ndarray]]


@judge("agreement")
def laws_agree(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to the same ⟨J⟩ at all a of a range.

    The study's relative tolerance of agreement may be applied to the largest ⟨J⟩ in the range, as curves in a figure
    correspond: those of both states have one scale. Or it may be applied to ⟨J⟩ at each a, as in agreement.nc: curves
    that coincide in a figure may then differ where ⟨J⟩ is small.
    """
    found = {state: _law_comparison(evidence, state, a) for state in initial}
    about = next(iter(found.values())).attrs
    scale = max(float(np.nanmax(one["mean_distance"].values)) for one in found.values())
    readings: dict[str, Answers] = {"of the largest value": {}, "of the value at each a": {}}
    measured = [Measured("largest ⟨J⟩", scale)]
    for state, one in found.items():
        beyond = excess(one["difference"], scale, about["synchronization_threshold"], about)
        synchronous = one["kind"].isin(SYNCHRONOUS).all("law")
        of_largest = same_mean(beyond, one["difference_error"], synchronous, about)
        for answers, same in zip(readings.values(), (of_largest, one["same_mean_distance"]), strict=True):
            answers[state] = one["a"].values, same.values
        difference = np.abs(one["difference"].values[of_largest.values == Answer.YES])
        if np.isfinite(difference).any():
            quantity = f"largest |Δ⟨J⟩| where they agree on the scale of the largest, {state}"
            measured.append(Measured(quantity, float(np.nanmax(difference))))
    tolerance = 100.0 * about["relative_tolerance"]
    words = f"The laws agree in ⟨J⟩, whose largest value is {scale:.3f}, within {tolerance:g} %"
    return _judge_agreement(words, readings, a, loose_share, measured)


@judge("agreement")
def laws_agree_in_kind(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to the same kind of motion at all a of a range.

    The kinds may be those that the paper names: periodic, quasiperiodic and chaotic. Or they may be synchrony, other
    regular motion and chaos: a torus is locked to periodic orbits on a dense set of a, so that a single value of a may
    show either.
    """
    readings: dict[str, Answers] = {
        f"with periodic and quasiperiodic motion as {number}": {} for number in ("two kinds", "one kind")
    }
    for state in initial:
        one = _law_comparison(evidence, state, a)
        same, (kind, other) = one["same_kind"].values, merge_chaos(one["kind"].sel(law=list(PAPER_LAWS)).values)
        strictly = np.where((same == Answer.YES) & (kind != other), Answer.NO, same)
        for answers, of_kinds in zip(readings.values(), (strictly, same), strict=True):
            answers[state] = one["a"].values, of_kinds
    return _judge_agreement("The laws agree in the kind of motion", readings, a, loose_share)


def _law_comparison(evidence: Evidence, state: str, a: Range) -> xarray.Dataset:
    return evidence.choose(evidence.law_comparison(evidence.state_summary("agreement", state)), a)


def _judge_agreement(
    words: str, readings: Mapping[str, Answers], a: Range, loose_share: float, measured: Sequence[Measured] = ()
) -> Verdict:
    """Judge whether the laws agree, under each reading; words : what the readings qualify."""
    verdicts, texts, numbers, differences = {}, [], [], []
    for reading, answers in readings.items():
        text, points, of_reading, where = _judge_answers(answers, a, loose_share)
        verdicts[reading] = judge_share(points.share, loose_share)
        texts.append(f"{reading}, at {text} ({verdicts[reading]})")
        numbers += [replace(item, quantity=f"{item.quantity}, {reading}") for item in of_reading]
        differences += [f"{reading}, {text}" for text in where]
    return combine_readings(verdicts, f"{words}: {'; '.join(texts)}.", [*numbers, *measured], differences)


def _judge_answers(answers: Answers, a: Range, loose_share: float) -> tuple[str, ForAll, list[Measured], list[str]]:
    """Judge where the laws agree, by the points of all states together, as a figure shows them.

    Returned are the share as text, the statement on all points, the shares of the states, and where the laws differ or
    could not be compared.
    """
    cases = [
        Case(state, grid, same == Answer.YES, same != Answer.UNDETERMINED) for state, (grid, same) in answers.items()
    ]
    shares, numbers = {}, []
    for case in cases:
        if case.known.any():
            shares[case.name] = case.share
            numbers.append(Measured(f"share of a at which the laws agree, {case.name}", case.share.value))
        if len(differ := case.a[case.known & ~case.right]):
            numbers.append(Measured(f"smallest a at which they differ, {case.name}", float(differ[0])))
    differences = [f"{text} ({case.name})" for case in cases for text in case.exceptions("they differ")]
    unknown = [text for case in cases for text in describe_where("undetermined", case.a, ~case.known, case.name)]
    grid, same = (np.concatenate(part) for part in zip(*answers.values(), strict=True))
    reason = f"the laws could not be compared: {'; '.join(unknown)}"
    points = for_all(loose_share, [Case("points", grid, same == Answer.YES, same != Answer.UNDETERMINED, reason)])
    text = f"{points.share} of the points (initial state, a) with {a}, {format_shares(shares)}"
    return text, points, numbers, [*differences, *unknown]


@judge("mean_distance")
def linearization_justified(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str, tolerance: float, loose: float
) -> Verdict:
    """Judge the difference of the friction laws at the fastest slips of the runs, as a fraction of the static friction.

    law : the linearized law, whose friction 1 − aU' gives the speed; tolerance, loose : allowed fractions
    part : part of the runs: window, or run with its transient
    The laws differ by (aU')²/(1 + aU').
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


@judge("mean_distance")
def springs_help(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge whether stronger springs or larger masses, which decrease a, bring the laws closer together.

    claimed : power of a with which the difference falls, or falls faster: that of (aU')² if U' did not change

    At one a, linearized motion is proportional to v. Hence aU' is av times the ratio of slip speed to v, a function of
    a alone that is known from the windows of the runs. What stronger springs do depends on what is held fixed. At a
    fixed v, as in the paper's study, av falls with a. At a fixed velocity V of the driver v grows as a falls, and av =
    cV stays, where F(0)/(1 + cV) is the friction. The paper's choice is the first reading.
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, "window")
    least, largest = int(np.argmin(grid)), int(np.argmax(grid))
    readings, measured, texts = {}, [], []
    for fixed, product in (("v", grid * speed), ("V, which leaves av = cV unchanged", speed)):
        power = float(np.polyfit(np.log(grid), 2.0 * np.log(product), 1)[0])
        ratio = float((product[least] / product[largest]) ** 2)
        name = f"at a fixed {fixed}"
        readings[name] = judge_value(min(power, claimed), claimed, tolerance, loose)
        measured.append(Measured(f"power of a with which the difference of the laws falls {name}", power))
        measured.append(Measured(f"remaining fraction of it {name}", ratio))
        texts.append(f"to {100 * ratio:.2g} %, as a^{power:.2f}, {name} ({readings[name]})")
    reason = (
        f"From a = {grid[largest]:g} down to {grid[least]:g} the difference of the laws on a slipping block falls "
        f"{'; '.join(texts)}. With the same slip speed it would fall as a^{claimed:g}."
    )
    return combine_readings(readings, reason, measured)


def _fastest_slips(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, fastest slip divided by v) of all completed runs, from their least friction 1 − aU'."""
    found = []
    for state in initial:
        runs = evidence.choose(evidence.state_summary("mean_distance", state), a).sel(law=law)
        friction = runs["window_least_friction" if part == "window" else "least_friction"].values
        known = np.isfinite(friction)
        if not known.any():
            raise NotTestableError(f"no run from {state} completed with {a}")
        found.append((runs["a"].values[known], 1.0 - friction[known]))
    grid, product = (np.concatenate(part) for part in zip(*found, strict=True))
    return grid, product / (grid * evidence.config["v"])
