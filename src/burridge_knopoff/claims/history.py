"""Claims on what decides between coexisting attractors: initial state, first block, phases of the end blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import synchrony
from burridge_knopoff.claims.phase_outcomes import Criteria, PhaseOutcomes, percent
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    count_share,
    describe_where,
    extremes,
    format_shares,
    join_words,
    judge_worst_share,
    worst_verdict,
)
from burridge_knopoff.motion.kind import MotionKind, merge_chaos
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray


@judge("attractors")
def coexistence(evidence: Evidence, a: Range, samples: int, loose_share: float) -> Verdict:
    """Judge whether attractors of different kinds coexist at each a of a range, under both laws: history then decides.

    An attractor counts if sampled states or the study's initial states reach it; mirror images count once. Kinds are
    synchronized, periodic, quasiperiodic and chaotic motion.
    samples : number of sampled states required to say that there is only one attractor
    """
    attractors = evidence.choose(evidence.own_attractors(), a)
    shares, measured, single = {}, [], []
    for law in PAPER_LAWS:
        found = attractors.sel(law=law)
        count, kinds = _coexisting(found, samples)
        shares[law] = count_share(kinds > 1)
        measured.append(Measured(f"share of a with attractors of more than one kind, {law}", shares[law].value))
        measured.append(Measured(f"most attractors that coexist, {law}", float(count.max())))
        fraction = found["basin_fraction"].values[(found["branch"].values == 0) & (found["basin_count"].values > 0)]
        if len(fraction):
            measured += extremes("basin fraction of synchrony", fraction, law)
        single += describe_where("at most one kind of motion", found["a"].values, kinds <= 1, law)
    reason = f"Attractors of more than one kind are reached at {format_shares(shares)} of the values of a with {a}."
    return Verdict(judge_worst_share(shares, loose_share), reason, measured, "; ".join(single))


def _coexisting(found: xarray.Dataset, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of attractors reached, and of their kinds of motion, at each a under one law."""
    reached = np.where(found["basin_count"].values > 0, found["branch"].values, -1)
    started = found["initial_branch"].transpose("a", "initial").values
    seen = [set(row[row >= 0].tolist()) for row in np.concatenate([reached, started], axis=1)]
    count = np.array([len(branches) for branches in seen])
    kinds = []
    for branches, branch, kind in zip(seen, found["branch"].values, merge_chaos(found["kind"].values), strict=True):
        of_branch = dict(zip(branch.tolist(), kind.tolist(), strict=True))
        kinds.append(len({of_branch.get(one, MotionKind.UNDETERMINED) for one in branches} - {MotionKind.UNDETERMINED}))
    if ((count < 2) & (found["basin_count"].values.sum(axis=1) < samples)).any():
        raise NotTestableError(f"fewer than {samples} sampled states reach an attractor where one alone is seen")
    return count, np.array(kinds)


@judge("mean_distance", "attractors")
def first_block_decides(evidence: Evidence, initial: tuple[str, str], a: Range, loose_share: float) -> Verdict:
    """Judge whether one of two initial states synchronizes and the other does not, for all a and both laws."""

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        both = [synchrony(evidence, state, a, inside) for state in initial]
        for law in PAPER_LAWS:
            one, other = (found.sel(law=law).values for found in both)
            few = f"too few runs under the {law} law completed at {a}"
            yield Case(law, both[0]["a"].values, one != other, np.isfinite(one + other), few)

    found = for_all(loose_share, cases())
    first, second = initial
    reason = f"One of {first} and {second} synchronizes and the other does not at {found} of the values of a with {a}."
    measured, same = (
        found.measured("share of a at which the outcome differs"),
        found.exceptions("the outcome is the same"),
    )
    return judge_conventions(
        evidence, found.verdict, reason, measured, same, found.convention_judge(evidence, a, cases)
    )


@judge("mean_distance", "attractors")
def same_for_both_laws(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead from each initial state to the same outcome, synchronized or not, for all a."""

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        for state in initial:
            found = synchrony(evidence, state, a, inside)
            one, other = (found.sel(law=law).values for law in PAPER_LAWS)
            few = f"too few runs from {state} completed at {a}"
            yield Case(state, found["a"].values, one == other, np.isfinite(one + other), few)

    found = for_all(loose_share, cases())
    reason = f"Both laws have the same outcome, synchrony or no synchrony, at {found} of the values of a with {a}."
    measured = found.measured("share of a with the same outcome")
    differ = [text for case in found.cases for text in case.exceptions(f"the outcomes from {case.name} differ")]
    return judge_conventions(
        evidence, found.verdict, reason, measured, differ, found.convention_judge(evidence, a, cases)
    )


@judge()
def one_convention(evidence: Evidence, claims: Sequence[str]) -> Verdict:
    """Judge whether some claims hold together under one convention of contact and start.

    claims : by name; each has to be judged before this one. This claim holds loosely if some of them hold loosely. A
        convention under which one of them is not judged does not count.
    """
    known = {name: evidence.verdicts[name] for name in claims}
    for verdict in known.values():
        if verdict.verdict == NOT_TESTABLE:
            raise NotTestableError(verdict.reason.removeprefix("Not testable here: ").removesuffix("."))
    conventions = sorted({convention for verdict in known.values() for convention in verdict.conventions})
    if not conventions:
        raise NotTestableError("the claims are judged under one convention only")
    together, measured, texts = {}, [], []
    for convention in conventions:
        found = {name: verdict.conventions.get(convention) for name, verdict in known.items()}
        judged = {name: verdict for name, verdict in found.items() if verdict}
        measured.append(
            Measured(
                f"claims that hold, of {len(judged)} judged: {convention}", sum(v != FAILS for v in judged.values())
            )
        )
        together[convention] = worst_verdict(judged.values()) if len(judged) == len(claims) else FAILS
        against = [name for name, verdict in judged.items() if verdict == FAILS]
        open_ones = [name for name in claims if name not in judged]
        parts = [f"{join_words(against)} {'fail' if len(against) > 1 else 'fails'}"] if against else []
        parts += [f"{join_words(open_ones)} cannot be judged"] if open_ones else []
        texts.append(f"under ({convention}) {', and '.join(parts) or 'all hold'}")
    best = min(together.values(), key=(HOLDS, LOOSELY, FAILS).index)
    under = [convention for convention, verdict in together.items() if verdict == best]
    reason = (
        f"All of them hold{' loosely' if best == LOOSELY else ''} under {join_words([f'({name})' for name in under])}."
        if best != FAILS
        else f"None of the {len(conventions)} conventions makes all {len(claims)} statements hold."
    )
    return Verdict(best, reason, measured, "; ".join(texts))


@judge("phases")
def phases_decide(
    evidence: Evidence,
    a: Range,
    inner_share: float,
    close: float,
    opposite: float,
    correlation: float,
    share: float,
    loose_share: float,
) -> Verdict:
    """Judge whether close phases of the end blocks lead to synchrony and opposite phases to antiphase, under both laws.

    inner_share : amplitude of the inner blocks, as a fraction, of the judged states; other fractions are reported too
    close, opposite : phase difference in degrees up to which phases are close, and from which they are opposite
    correlation : of the velocities of the end blocks; up to this value they are in antiphase
    share : required fraction of states with this outcome, by the lower end of a Wilson interval

    The claim holds if this is true at every amplitude. It holds loosely if it is true at all amplitudes at which every
    velocity is positive at the start, whatever the phases: only these states are oscillations about uniform sliding.
    The paper does not mention the inner block. If the claim holds for one computed fraction and fails for
    another, it depends on reading.
    """
    evidence.check_blocks()
    phases = evidence.summary("phases")
    evidence.choose(phases, a)
    criteria = Criteria(a, close, opposite, correlation, share, loose_share)
    judged = PhaseOutcomes(phases, inner_share, criteria)
    measured: list[Measured] = []
    changes = []
    for k, size in enumerate(judged.amplitude):
        measured += judged.measured(f"A = {size:g}", np.arange(len(judged.amplitude)) == k)
        if not judged.holds[:, judged.inside, k].all():
            shown = [percent(found.fraction[:, judged.inside, k]) for found in (judged.synchronized, judged.antiphase)]
            changes.append(
                f"A = {size:g}: {shown[0]} of the close phases synchronize, {shown[1]} of the opposite phases end in "
                "antiphase"
            )
    for law, low in zip(judged.laws, judged.synchronized.low, strict=True):
        lost = ~judged.inside & (low[:, judged.without_backward_slip] < share).any(axis=1)
        changes += describe_where("close phases do not synchronize", phases["a"].values, lost, law)
    readings = {_format_inner_block(inner_share): judged.verdict}
    for other in phases["inner_share"].values[phases["inner_share"].values != inner_share].tolist():
        where = _format_inner_block(other)
        try:
            outcomes = PhaseOutcomes(phases, other, criteria)
        except NotTestableError as error:
            changes.append(f"with {where} the claim is {NOT_TESTABLE}: {error}")
            continue
        readings[where] = outcomes.verdict
        changes.append(
            f"with {where} (A = {outcomes.amplitudes}) the claim {outcomes.verdict}, since it is true at "
            f"{outcomes.shares} of the values of a: {outcomes.format_fractions()}"
        )
        measured += outcomes.measured(where, outcomes.without_backward_slip)
    synchronized, antiphase = (
        f"{percent(found.fraction[judged.cells])} of the states, Wilson intervals from "
        f"{100 * found.low[judged.cells].min():.1f} %"
        for found in (judged.synchronized, judged.antiphase)
    )
    reason = (
        f"The end blocks oscillate about uniform sliding with amplitudes at which no block slips backward (A = "
        f"{judged.amplitudes}), {_format_inner_block(inner_share)}. Phases within {close:g}° lead to synchrony "
        f"({synchronized}) and opposite phases to antiphase ({antiphase}) at {judged.shares} of the values of a with "
        f"{a}."
    )
    return combine_readings(readings, reason, measured, changes)


def _format_inner_block(share: float) -> str:
    """Describe the motion of the inner block."""
    return "the inner block sliding uniformly" if share == 0.0 else f"the inner block oscillating with {share:g} A"
