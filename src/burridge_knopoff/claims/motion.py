"""Claims on stick-slip motion: whether and how often blocks stop, and how the end blocks move together."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence, finite
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import reached_attractor
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Share,
    Verdict,
    count_share,
    describe_where,
    extremes,
    format_shares,
    format_values,
    judge_shares,
    judge_value,
    judge_worst_share,
    worst_verdict,
)
from burridge_knopoff.study.formatting import span, with_error
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray

#: The readings of a stick-slip cycle.
ONE_BLOCK, ANY_BLOCK = "between successive stops of one block", "between successive stops of any blocks"


@judge("stick_slip", "attractors")
def every_block_stops(evidence: Evidence, initial: Sequence[str], laws: Sequence[str], at: float) -> Verdict:
    """Judge whether each block stops repeatedly at one a, from each state and under some laws."""
    verdicts, measured, never = [], [], []
    for state in initial:
        runs = evidence.choose(evidence.state_summary("stick_slip", state), Range(above=0.0))
        for law in laws:
            rate = evidence.at(runs, at)["stop_rate"].sel(law=law).values
            if not np.isfinite(rate).all():
                raise NotTestableError(f"the run from {state} at a = {at:g} under the {law} law did not complete")
            verdicts.append(HOLDS if (rate > 0.0).all() else FAILS)
            measured += [
                Measured(f"stops per unit time, block {n}, {law}, {state}", value) for n, value in enumerate(rate, 1)
            ]
            everywhere = runs["stop_rate"].sel(law=law).values
            known = np.isfinite(everywhere).all(axis=-1)
            some = known & ~(everywhere > 0.0).all(axis=-1)
            never += describe_where("a block never stops", runs["a"].values, some, f"{law}, {state}")
    right = sum(verdict == HOLDS for verdict in verdicts)
    reason = f"At a = {at:g} all three blocks stop repeatedly in {right} of {len(verdicts)} runs."

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        found = {
            f"{law}, {state}": Share(int((rate[0] > 0.0).all()), 1)
            for state in initial
            for law in laws
            if (rate := reached_attractor(attractors, at, state, law, "stop_rate"))
        }
        return judge_shares(found, 1.0)

    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, never, judge_attractors)


@judge("equilibrium", "attractors")
def sticks_unavoidable(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether in every motion some block stops repeatedly.

    While all blocks slip, the energy ½|U' − v|² + ½ x·Kx of their motion about uniform sliding grows, unless they slide
    uniformly, if friction falls with velocity. Oscillations that grow without bound bring some velocity to 0
    (docs/claims.md). Uniform sliding itself is unstable if its eigenvalues have positive real parts, which are half of
    −F'(v) each; otherwise motion without sticks attracts. As a check, some block has to stop in each known attractor.

    loose_share : fraction of the values of a, and of the attractors, from which the claim holds loosely
    """
    evidence.check_blocks()
    equilibrium = evidence.choose(evidence.summary("equilibrium"), a)
    attractors = evidence.choose(evidence.summary("attractors"), a)
    shares: dict[str, Share] = {}
    every: dict[str, Share] = {}
    measured = []
    for law in PAPER_LAWS:
        real = equilibrium["eigenvalue"].sel(law=law, part="real").values
        slope = evidence.weakening(law, equilibrium["a"].values)
        shares[f"values of a, {law}"] = count_share(np.all(real > 0.0, axis=-1))
        measured += extremes("real part of an eigenvalue over −F'(v)", real / slope[:, None], law)
        found = attractors.sel(law=law)
        there = found["branch"].values >= 0
        if not there.any():
            raise NotTestableError(f"no attractor is known under the {law} law with {a}")
        stops = found["stop_rate"].values[there] > 0.0
        shares[f"attractors, {law}"], every[law] = (
            count_share(np.any(stops, axis=-1)),
            count_share(np.all(stops, axis=-1)),
        )
        measured += [
            Measured(f"share of attractors in which some block stops, {law}", shares[f"attractors, {law}"].value),
            Measured(f"share of attractors in which every block stops, {law}", every[law].value),
        ]
    modes = equilibrium.sizes["mode"]
    reason = (
        f"All {modes} eigenvalues of uniform sliding have positive real parts, and some block stops repeatedly on each "
        f"attractor: true of {format_shares(shares)} with {a}. Every block stops on {format_shares(every)} of the "
        "attractors."
    )
    changes = "not every block stops on every attractor" if any(share.value < 1.0 for share in every.values()) else ""
    return Verdict(judge_worst_share(shares, loose_share), reason, measured, changes)


@judge("stick_slip", "attractors")
def antiphase(evidence: Evidence, initial: str, law: str, at: float, correlation: float) -> Verdict:
    """Judge whether the end blocks are in antiphase: the correlation of their velocities is at most `correlation`.

    The claim holds loosely if the correlation is negative.
    """
    runs = evidence.state_summary("stick_slip", initial).sel(law=law)
    value = evidence.at(runs, at)["velocity_correlation"].item()
    if not np.isfinite(value):
        raise NotTestableError(f"the correlation of the end blocks from {initial} at a = {at:g} is not known")
    verdict = _judge_antiphase(value, correlation)
    everywhere = runs["velocity_correlation"].values
    negative = np.isfinite(everywhere) & (everywhere < 0.0)
    reason = f"The correlation of U₁' and U₃' from {initial} at a = {at:g} ({law}) is {with_error(round(value, 2))}."
    exceptions = [f"negative only {format_values(runs['a'].values, negative)}"] if negative.any() else []

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        found = reached_attractor(attractors, at, initial, law, "velocity_correlation")
        if not found or not np.isfinite(found[0]):
            return "", ""
        return _judge_antiphase(found[0], correlation), f"correlation {with_error(round(float(found[0]), 2))}"

    measured = [Measured("correlation of U₁' and U₃'", value)]
    return judge_conventions(evidence, verdict, reason, measured, exceptions, judge_attractors)


def _judge_antiphase(value: float, correlation: float) -> str:
    return HOLDS if value <= correlation else LOOSELY if value < 0.0 else FAILS


@judge("stick_slip", "agreement")
def antiphase_persists(evidence: Evidence, initial: str, a: Range, loose_share: float) -> Verdict:
    """Judge whether end blocks in antiphase in a run stay so: the run is on its attractor.

    Antiphase means a negative correlation of their velocities in the window. `settled` of agreement.nc states whether
    the run is on its attractor: a transient would be followed by another motion.
    """
    runs = evidence.choose(evidence.state_summary("stick_slip", initial), a)
    ends = evidence.choose(evidence.state_summary("agreement", initial), a)

    def cases() -> Iterator[Case]:
        for law in PAPER_LAWS:
            grid, opposed = runs["a"].values, runs["velocity_correlation"].sel(law=law).values < 0.0
            settled = ends["settled"].sel(law=law).values
            if not opposed.any():
                raise NotTestableError(f"no run from {initial} under the {law} law is in antiphase with {a}")
            where = format_values(grid, opposed & ~(settled >= 0))
            unknown = (
                f"it is undetermined whether the run from {initial} under the {law} law is on its attractor {where}"
            )
            yield Case(law, grid, settled == 1, settled >= 0, unknown, applies=opposed)

    found = for_all(loose_share, cases())
    measured = found.measured(
        "share of the runs in antiphase that are on their attractor",
        lambda case: [Measured(f"values of a with a run in antiphase, {case.name}", float(case.share.count))],
    )
    reason = f"Of the runs from {initial} with {a} whose end blocks move in antiphase, {found} stay in antiphase."
    return Verdict(found.verdict, reason, measured, "; ".join(found.exceptions("transient", "undetermined")))


@judge("stick_slip", "attractors")
def half_frequency(
    evidence: Evidence, initial: str, law: str, at: float, claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge the frequency of the end blocks relative to that of the middle block, from velocity spectra and from stops.

    Both ratios have to agree with the claim.
    """
    run = evidence.at(evidence.state_summary("stick_slip", initial).sel(law=law), at)
    frequency, error, stops = (
        run[name].values for name in ("velocity_frequency", "velocity_frequency_error", "stop_rate")
    )
    if not np.isfinite(frequency).all() or not frequency[1] or not stops[1]:
        raise NotTestableError(
            f"the frequencies from {initial} at a = {at:g} are not known, or the middle block never stops"
        )
    ratios, verdicts = [], []
    for end, name in ((0, "block 1"), (-1, "block 3")):
        ratio = frequency[end] / frequency[1]
        spread = ratio * np.hypot(error[end] / frequency[end], error[1] / frequency[1])
        ratios.append(
            Measured(f"frequency of the velocity of {name} over that of block 2", float(ratio), float(spread))
        )
        ratios.append(Measured(f"stops of {name} over stops of block 2", float(stops[end] / stops[1])))
    verdicts = [judge_value(item.value, claimed, tolerance, loose) for item in ratios]
    reason = (
        f"From {initial} at a = {at:g} ({law}) the end blocks have "
        f"{with_error(ratios[0].value, ratios[0].error)} times the frequency of the middle block by the peaks of their "
        f"spectra, and {ratios[1].value:.3f} times by the number of stops; the paper says {claimed:g}."
    )

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        found = reached_attractor(attractors, at, initial, law, "velocity_frequency", "stop_rate")
        if not found or not np.isfinite(found[0]).all():
            return "", ""
        if not found[1][1] > 0.0:
            return FAILS, "the middle block never stops"
        ratios = [item[end] / item[1] for item in found for end in (0, -1)]
        verdict = worst_verdict(judge_value(ratio, claimed, tolerance, loose) for ratio in ratios)
        return verdict, f"{ratios[0]:.3f} by the peaks, {ratios[2]:.3f} by stops"

    return judge_conventions(evidence, worst_verdict(verdicts), reason, ratios, [], judge_attractors)


@judge("stick_slip")
def cycle_time(
    evidence: Evidence,
    initial: Sequence[str],
    a: Range,
    shown: float,
    low: float,
    high: float,
    tolerance: float,
    loose: float,
) -> Verdict:
    """Judge whether the time of a stick-slip cycle lies between two values, in runs of both laws, by medians over a.

    shown : the a of the paper's figures of single runs
    tolerance, loose : how far outside it may lie for the claim to hold, and to hold loosely

    A cycle may be read as the time between two stops of one block; as the time between a stop of any block and the next
    stop of any block, which is the inverse of the total rate of stops; or as the time between two stops of the middle
    block in the figure of the last state, where it is the shortest cycle to be seen.
    """
    middle = f"between successive stops of the middle block, from {initial[-1]} at a = {shown:g}"
    readings: dict[str, dict[str, np.ndarray]] = {ONE_BLOCK: {}, ANY_BLOCK: {}, middle: {}}
    for state in initial:
        runs = evidence.choose(evidence.state_summary("stick_slip", state), a)
        for law in PAPER_LAWS:
            one = runs.sel(law=law)
            for block in runs["block"].values:
                readings[ONE_BLOCK][f"block {block}, {law}, {state}"] = finite(one["cycle_time"].sel(block=block))
            stops = finite(one["stop_rate"].sum(dim="block", skipna=False))
            readings[ANY_BLOCK][f"{law}, {state}"] = 1.0 / stops[stops > 0.0]
            if state == initial[-1] and shown in one["a"].values:
                readings[middle][law] = finite(one["cycle_time"].sel(a=shown)[one.sizes["block"] // 2])
    verdicts, measured, texts = {}, [], []
    for reading, times in readings.items():
        medians = {name: float(np.median(part)) for name, part in times.items() if len(part)}
        if not medians:
            continue
        verdicts[reading] = worst_verdict(
            judge_value(max(low - median, median - high, 0.0), 0.0, tolerance, loose) for median in medians.values()
        )
        measured += [Measured(f"median time {reading}, {name}", median) for name, median in medians.items()]
        least, most = (f"{f(medians.values()):.2f}" for f in (min, max))
        texts.append(f"{span(least, most)} {reading} ({verdicts[reading]})")
    if ONE_BLOCK not in verdicts:
        raise NotTestableError(f"no block stops twice in a run with {a}")
    reason = f"The median time for {a} is {'; '.join(texts)}. The paper says {low:g} to {high:g}."
    return combine_readings(verdicts, reason, measured)
