"""Claims on stick-slip motion: whether and how often blocks stop, and how the end blocks move together."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import (
    ANTIPHASE,
    LOOSE_ANTIPHASE,
    Correlation,
    LooseCorrelation,
    LooseShare,
    LooseTolerance,
    Tolerance,
)
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence, finite
from burridge_knopoff.claims.outcomes import Runs, reached_attractor
from burridge_knopoff.claims.range import BELOW, POSITIVE, Range
from burridge_knopoff.claims.statement import Truth, for_all
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Share,
    Verdict,
    count_share,
    describe_where,
    extremes,
    format_shares,
    judge_value,
    judge_worst_share,
    worst_verdict,
)
from burridge_knopoff.model.initial import PAPER_STATES
from burridge_knopoff.study.formatting import format_values, span, with_error
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray

# A jump of this size or less may be rounding.
ROUNDING = 1e-9

#: The readings of a stick-slip cycle.
ONE_BLOCK, ANY_BLOCK = "between successive stops of one block", "between successive stops of any blocks"


@claim("Results, Figs. 6a and 7a", "motion_plus", "stick_slip", "attractors")
def velocities_touch_zero(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    laws: tuple[str, ...] = ("linearized",),
    at: float = 0.08,
) -> Verdict:
    """At a = 0.08 the velocity of each of the three blocks touches zero, from minus and from plus.

    Holds if each block stops repeatedly in each of these runs.
    """
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
            completed = np.isfinite(everywhere).all(axis=-1)
            sliding = completed & ~(everywhere > 0.0).all(axis=-1)
            never += describe_where("a block never stops", runs["a"].values, sliding, f"{law}, {state}")
    right = sum(verdict == HOLDS for verdict in verdicts)
    reason = f"At a = {at:g} all three blocks stop repeatedly in {right} of {len(verdicts)} runs."

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        stopping = [
            bool((rate[0] > 0.0).all())
            for state in initial
            for law in laws
            if (rate := reached_attractor(attractors, at, state, law, "stop_rate"))
        ]
        verdict = HOLDS if all(stopping) else FAILS
        return verdict if stopping else "", f"all three blocks stop on {sum(stopping)} of {len(stopping)} attractors"

    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, never, judge_attractors)


@claim("Introduction; Conclusions", "stick_slip", "stick_slip")
def not_differentiable_at_events(evidence: Evidence, *, a: Range = POSITIVE, loose_share: LooseShare = 0.9) -> Verdict:
    """The equations of motion are not differentiable at the times when a block starts to move or stops.

    Holds if U'' jumps at every stop, and its derivative at every start, in the runs at all values of a; and loosely at
    nine in ten of them. U'' is continuous at a start.
    """

    def truth(runs: Runs) -> Truth:
        stop, start = (runs.of("stick_slip", name) for name in ("stop_jump", "start_jump"))
        return Truth((stop > ROUNDING) & (start > ROUNDING), stop.notnull() & start.notnull())

    states = list(PAPER_STATES)
    share = for_all(evidence, states, a, loose_share, truth, "too few runs under the {law} law have events {where}")
    runs = Runs(evidence, states, a)
    smallest = {name: float(runs.of("stick_slip", name).min()) for name in ("stop_jump", "start_jump")}
    measured = share.measured("share of a at which all events have a jump")
    measured += [
        Measured("smallest jump of U'' where a block stops", smallest["stop_jump"]),
        Measured("smallest jump of U''' where a block starts", smallest["start_jump"]),
    ]
    reason = (
        f"Among the events that are stored with states, U'' jumps at every stop, by at least "
        f"{smallest['stop_jump']:.2g}, and U''' at every start, by at least {smallest['start_jump']:.2g}, "
        f"{share.at(a)}. U'' is continuous at a start."
    )
    return share.conclude(reason, measured, "no jump at some event")


@claim("Results", "stick_slip", "equilibrium", "attractors", depends_on=("equilibrium_unstable",))
def sticks_unavoidable(evidence: Evidence, *, a: Range = POSITIVE, loose_share: LooseShare = 0.9) -> Verdict:
    """Some sticks are unavoidable, whatever the motion.

    Holds if all eigenvalues of uniform sliding have positive real parts at every value of a, and some block stops on
    every known attractor, under both laws; and loosely at nine in ten of each.

    While all blocks slip, the energy ½|U' − v|² + ½ x·Kx of their motion about uniform sliding grows, unless they
    slide uniformly, if friction falls with velocity. Oscillations that grow without bound bring some velocity to 0
    (docs/claims.md). Uniform sliding itself is unstable if its eigenvalues have positive real parts, which are half
    of −F'(v) each; otherwise motion without sticks attracts.
    """
    evidence.check_blocks()
    equilibrium = evidence.choose(evidence.summary("equilibrium"), a)
    attractors = evidence.choose(evidence.summary("attractors"), a)
    shares: dict[str, Share] = {}
    every: dict[str, Share] = {}
    measured = []
    for law in PAPER_LAWS:
        real = equilibrium["eigenvalue"].sel(law=law, part="real").values
        slope = evidence.negative_damping(law, equilibrium["a"].values)
        shares[f"values of a, {law}"] = count_share(np.all(real > 0.0, axis=-1))
        measured += extremes("real part of an eigenvalue over −F'(v)", real / slope[:, None], law)
        slots = attractors.sel(law=law)
        present = slots["branch"].values >= 0
        if not present.any():
            raise NotTestableError(f"no attractor is known under the {law} law with {a}")
        stops = slots["stop_rate"].values[present] > 0.0
        shares[f"attractors, {law}"], every[law] = (
            count_share(np.any(stops, axis=-1)),
            count_share(np.all(stops, axis=-1)),
        )
        measured += [
            Measured(f"share of attractors in which some block stops, {law}", shares[f"attractors, {law}"].value),
            Measured(f"share of attractors in which every block stops, {law}", every[law].value),
        ]
    modes = equilibrium.sizes["mode"]
    everywhere = all(share.hits == share.count for share in shares.values())
    claimed = (
        f"All {modes} eigenvalues of uniform sliding have positive real parts at every value of a, and some block "
        f"stops repeatedly on every attractor, with {a} and under both laws"
        if everywhere
        else f"All {modes} eigenvalues of uniform sliding have positive real parts, and some block stops repeatedly on "
        f"each attractor: true of {format_shares(shares)} with {a}"
    )
    reason = f"{claimed}. Every block stops on {format_shares(every)} of the attractors."
    changes = "not every block stops on every attractor" if any(share.value < 1.0 for share in every.values()) else ""
    return Verdict(judge_worst_share(shares, loose_share), reason, measured, changes)


@claim("Results, Fig. 7", "motion_plus", "stick_slip", "attractors")
def antiphase(
    evidence: Evidence,
    *,
    initial: str = "plus",
    law: str = "linearized",
    at: float = 0.08,
    correlation: Correlation = ANTIPHASE,
    loose: LooseCorrelation = LOOSE_ANTIPHASE,
) -> Verdict:
    """From plus the velocities of the end blocks are in antiphase at a = 0.08.

    Holds if the correlation of the two velocities is at most {correlation:g}, and loosely («some kind of antiphase») if
    it is at most {loose:g}, which is that of two sines 60° away from antiphase. It is 0 for uncorrelated velocities
    and −1 for sines in antiphase.
    """
    runs = evidence.state_summary("stick_slip", initial).sel(law=law)
    value = evidence.at(runs, at)["velocity_correlation"].item()
    if not np.isfinite(value):
        raise NotTestableError(f"the correlation of the end blocks from {initial} at a = {at:g} is not known")
    verdict = _judge_antiphase(value, correlation, loose)
    everywhere = runs["velocity_correlation"].values
    negative = np.isfinite(everywhere) & (everywhere < 0.0)
    reason = f"The correlation of U₁' and U₃' from {initial} at a = {at:g} ({law}) is {with_error(round(value, 2))}."
    exceptions = [f"negative only {format_values(runs['a'].values, negative)}"] if negative.any() else []

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        reached = reached_attractor(attractors, at, initial, law, "velocity_correlation")
        if not reached or not np.isfinite(reached[0]):
            return "", ""
        value = float(reached[0])
        return _judge_antiphase(value, correlation, loose), f"correlation {with_error(round(value, 2))}"

    measured = [Measured("correlation of U₁' and U₃'", value)]
    return judge_conventions(evidence, verdict, reason, measured, exceptions, judge_attractors)


def _judge_antiphase(value: float, correlation: float, loose: float) -> str:
    return HOLDS if value <= correlation else LOOSELY if value <= loose else FAILS


@claim("Conclusions", "stick_slip", "stick_slip", "agreement")
def antiphase_persists(
    evidence: Evidence,
    *,
    initial: str = "plus",
    a: Range = BELOW,
    correlation: LooseCorrelation = LOOSE_ANTIPHASE,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """If the end blocks are in antiphase, from plus, this persists in time for a < 0.1.

    Holds if the run is on its attractor, by `settled` of agreement.nc, at every value of a at which the correlation of
    the velocities in the window is at most {correlation:g}, and loosely at nine in ten of them. A transient would be
    followed by another motion.
    """

    def truth(runs: Runs) -> Truth:
        of_run, settled = (
            runs.of(*variable).sel(initial=initial)
            for variable in (("stick_slip", "velocity_correlation"), ("agreement", "settled"))
        )
        opposed = of_run <= correlation
        for law in opposed["law"][~opposed.any("a")].values:
            raise NotTestableError(f"no run from {initial} under the {law} law is in antiphase with {a}")
        return Truth(settled == 1, settled >= 0, opposed)

    unknown = f"it is undetermined whether the run from {initial} under the {{law}} law is on its attractor {{where}}"
    share = for_all(evidence, [initial], a, loose_share, truth, unknown)
    measured = share.measured(
        "share of the runs in antiphase that are on their attractor",
        lambda case: [Measured(f"values of a with a run in antiphase, {case.name}", float(case.share.count))],
    )
    all_stay = all(case.share.hits == case.share.count for case in share.cases)
    staying = "all" if all_stay else str(share)
    reason = f"Of the runs from {initial} with {a} whose end blocks move in antiphase, {staying} stay in antiphase."
    return share.conclude(reason, measured, "transient", "undetermined")


@claim("Results, Fig. 7", "stick_slip", "stick_slip", "attractors")
def half_frequency(
    evidence: Evidence,
    *,
    initial: str = "plus",
    law: str = "linearized",
    at: float = 0.08,
    claimed: float = 0.5,
    tolerance: Tolerance = 0.05,
    loose: LooseTolerance = 0.1,
) -> Verdict:
    """From plus the end blocks oscillate at about half the frequency of the middle block, at a = 0.08.

    Holds if the ratio is within {tolerance:g} of {claimed:g}, a tenth of it, and loosely within {loose:g}, for both end
    blocks, by the peaks of the velocity spectra and by the numbers of stops. Beyond, it is nearer to 2/3 or 1/3.
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
        reached = reached_attractor(attractors, at, initial, law, "velocity_frequency", "stop_rate")
        if not reached or not np.isfinite(reached[0]).all():
            return "", ""
        if not reached[1][1] > 0.0:
            return FAILS, "the middle block never stops"
        ratios = [item[end] / item[1] for item in reached for end in (0, -1)]
        verdict = worst_verdict(judge_value(ratio, claimed, tolerance, loose) for ratio in ratios)
        return verdict, f"{ratios[0]:.3f} by the peaks, {ratios[2]:.3f} by stops"

    return judge_conventions(evidence, worst_verdict(verdicts), reason, ratios, [], judge_attractors)


@claim("Results", "stick_slip", "stick_slip")
def cycle_time(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = POSITIVE,
    shown: float = 0.08,
    low: float = 2.0,
    high: float = 3.0,
    tolerance: Tolerance = 0.5,
    loose: LooseTolerance = 1.0,
) -> Verdict:
    """One stick-slip cycle takes about two or three units of time, under both laws.

    Holds if the median over a lies between {low:g} and {high:g} or at most {tolerance:g} outside, for each block, law
    and state, and loosely if it is at most {loose:g} outside.

    A cycle may be read as the time between two stops of one block; as the time between a stop of any block and the
    next stop of any block, which is the inverse of the total rate of stops; or as the time between two stops of the
    middle block in the figure of the last state, where it is the shortest cycle to be seen. Medians over a are
    judged.

    shown : the a of the paper's figures of single runs
    """
    middle = f"between successive stops of the middle block, from {initial[-1]} at a = {shown:g}"
    readings: dict[str, dict[str, np.ndarray]] = {ONE_BLOCK: {}, ANY_BLOCK: {}, middle: {}}
    for state in initial:
        runs = evidence.choose(evidence.state_summary("stick_slip", state), a)
        for law in PAPER_LAWS:
            cycles = runs.sel(law=law)
            for block in runs["block"].values:
                readings[ONE_BLOCK][f"block {block}, {law}, {state}"] = finite(cycles["cycle_time"].sel(block=block))
            stops = finite(cycles["stop_rate"].sum(dim="block", skipna=False))
            readings[ANY_BLOCK][f"{law}, {state}"] = 1.0 / stops[stops > 0.0]
            if state == initial[-1] and shown in cycles["a"].values:
                readings[middle][law] = finite(cycles["cycle_time"].sel(a=shown)[cycles.sizes["block"] // 2])
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
