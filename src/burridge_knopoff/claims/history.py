"""Claims on what decides between coexisting attractors: initial state, first block, phases of the end blocks."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import by_readings, under_conventions
from burridge_knopoff.claims.endings import Criteria, Endings, percent
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import synchrony
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    extremes,
    share_of,
    shares_text,
    told_where,
    verdict_of,
    worst,
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
        shares[law] = share_of(kinds > 1)
        measured.append(Measured(f"share of a with attractors of more than one kind, {law}", shares[law].value))
        measured.append(Measured(f"most attractors that coexist, {law}", float(count.max())))
        fraction = found["basin_fraction"].values[(found["branch"].values == 0) & (found["basin_count"].values > 0)]
        if len(fraction):
            measured += extremes("basin fraction of synchrony", fraction, law)
        single += told_where("at most one kind of motion", found["a"].values, kinds <= 1, law)
    reason = f"More than one kind of motion is reached at {shares_text(shares)} of the values of a with {a}."
    return Verdict(verdict_of(shares, loose_share), reason, measured, "; ".join(single))


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
    measured, same = found.measured("share of a at which the outcome differs"), found.exceptions("no difference")
    return under_conventions(evidence, found.verdict, reason, measured, same, found.reached(evidence, a, cases))


@judge("mean_distance", "attractors")
def same_for_both_laws(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead from each initial state to the same outcome, synchrony or none, for all a."""

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        for state in initial:
            found = synchrony(evidence, state, a, inside)
            one, other = (found.sel(law=law).values for law in PAPER_LAWS)
            few = f"too few runs from {state} completed at {a}"
            yield Case(state, found["a"].values, one == other, np.isfinite(one + other), few)

    found = for_all(loose_share, cases())
    reason = f"Both laws have the same outcome, synchrony or none, at {found} of the values of a with {a}."
    measured = found.measured("share of a with the same outcome")
    differ = [text for case in found.cases for text in case.exceptions(f"the outcomes from {case.name} differ")]
    return under_conventions(evidence, found.verdict, reason, measured, differ, found.reached(evidence, a, cases))


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
        together[convention] = worst(judged.values()) if len(judged) == len(claims) else FAILS
        against = [_words(name) for name, verdict in judged.items() if verdict == FAILS]
        open_ones = [_words(name) for name in claims if name not in judged]
        texts.append(
            f"{convention}: "
            + "; ".join(
                [
                    *([f"contradicted by {', '.join(against)}"] if against else ["not contradicted"]),
                    *([f"not judged {', '.join(open_ones)}"] if open_ones else []),
                ]
            )
        )
    best = min(together.values(), key=(HOLDS, LOOSELY, FAILS).index)
    under = [convention for convention, verdict in together.items() if verdict == best]
    reason = (
        f"All of them hold{' loosely' if best == LOOSELY else ''} under {'; '.join(under)}."
        if best != FAILS
        else f"None of the {len(conventions)} conventions makes all {len(claims)} statements hold."
    )
    return Verdict(best, reason, measured, " | ".join(texts))


def _words(name: str) -> str:
    """Return the name of a claim as words: «plus does not synchronize»."""
    return f"«{name.replace('_', ' ')}»"


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
    share : fraction of states that have to end so, by the lower end of a Wilson interval

    The claim holds if this is so at every amplitude, and holds loosely if it is so at all amplitudes at which every
    velocity is positive at the start, whatever the phases: only there are the states oscillations about uniform
    sliding. The paper does not mention the inner block. If the claim holds for one computed fraction and fails for
    another, it depends on reading.
    """
    evidence.check_blocks()
    phases = evidence.summary("phases")
    evidence.choose(phases, a)
    criteria = Criteria(a, close, opposite, correlation, share, loose_share)
    judged = Endings(phases, inner_share, criteria)
    measured: list[Measured] = []
    changes = []
    for k, size in enumerate(judged.amplitude):
        measured += judged.measured(f"A = {size:g}", np.arange(len(judged.amplitude)) == k)
        if not judged.right[:, judged.inside, k].all():
            shown = [percent(found.fraction[:, judged.inside, k]) for found in (judged.together, judged.against)]
            changes.append(
                f"A = {size:g}: {shown[0]} of the close phases synchronize, {shown[1]} of the opposite phases end in "
                "antiphase"
            )
    for law, low in zip(judged.laws, judged.together.low, strict=True):
        lost = ~judged.inside & (low[:, judged.slips] < share).any(axis=1)
        changes += told_where("close phases do not synchronize", phases["a"].values, lost, law)
    readings = {_inner_block(inner_share): judged.verdict}
    for other in phases["inner_share"].values[phases["inner_share"].values != inner_share].tolist():
        where = _inner_block(other)
        try:
            endings = Endings(phases, other, criteria)
        except NotTestableError as error:
            changes.append(f"{where}: {NOT_TESTABLE}, {error}")
            continue
        readings[where] = endings.verdict
        changes.append(
            f"{where} (A = {endings.amplitudes}): {endings.verdict}, true at {endings.shares} of the values of a: "
            f"{endings.told()}"
        )
        measured += endings.measured(where, endings.slips)
    together, against = (
        f"{percent(found.fraction[judged.cells])} of the states, Wilson intervals "
        f"{100 * found.low[judged.cells].min():.1f} % or more"
        for found in (judged.together, judged.against)
    )
    reason = (
        f"With {_inner_block(inner_share)}, end blocks that oscillate about uniform sliding without slipping backward "
        f"(A = {judged.amplitudes}) synchronize from phases within {close:g}° ({together}) and end in antiphase from "
        f"opposite phases ({against}), at {judged.shares} of the values of a with {a}."
    )
    return by_readings(readings, reason, measured, changes)


def _inner_block(share: float) -> str:
    """Describe the motion of the inner block."""
    return "the inner block sliding uniformly" if share == 0.0 else f"the inner block oscillating with {share:g} A"
