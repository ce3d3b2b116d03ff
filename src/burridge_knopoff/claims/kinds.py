"""Claims on the kind of motion: periodic, quasiperiodic or chaotic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.attractors.lookup import reached_values
from burridge_knopoff.claims.conventions import judge_conventions
from burridge_knopoff.claims.evidence import MIN_VALUES, Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import PERIODIC_KINDS, kinds_reached, motion_kinds
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    describe_where,
    format_shares,
    format_values,
    join_words,
    judge_interval,
    worst_verdict,
)
from burridge_knopoff.motion.kind import (
    CHAOS,
    REGULAR,
    MotionKind,
    is_zero_exponent,
    merge_chaos,
)
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.plateaux import plateaux

if TYPE_CHECKING:
    import xarray


@judge("agreement", "attractors")
def all_of_kind(
    evidence: Evidence, initial: Sequence[str], laws: Sequence[str], kinds: Sequence[str], a: Range, loose_share: float
) -> Verdict:
    """Judge whether all runs from some states under some laws have one of several kinds of motion in a range of a.

    kinds : meanings of `kind`: synchronized, periodic, quasiperiodic, chaotic

    Not testable if the runs of undetermined kind decide.
    """
    allowed = [int(kind) for kind in MotionKind if kind.name.lower() in kinds]
    what = join_words(kinds, "or")

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        for law in laws:
            for state in initial:
                grid, kind = motion_kinds(evidence, state, law, a, inside)
                known = kind != MotionKind.UNDETERMINED
                unknown = (
                    f"the kind of motion from {state} under the {law} law is undetermined {format_values(grid, ~known)}"
                )
                yield Case(f"{law}, {state}", grid, np.isin(kind, allowed), known, unknown)

    found = for_all(loose_share, cases())
    measured = found.measured(f"share of a with {what} motion")
    if "attractors" in evidence.summaries:
        attractors = evidence.choose(evidence.summary("attractors"), a).sel(law=list(laws))
        known = (attractors["branch"] >= 0).values & (attractors["kind"].values != MotionKind.UNDETERMINED)
        if known.any():
            share = float(np.isin(merge_chaos(attractors["kind"].values), allowed)[known].mean())
            measured.append(Measured(f"share of all attractors with {what} motion", share))
    reason = f"The motion is {what} at {found} of the values of a with {a}."
    # Periodic and quasiperiodic together are regular motion, however the two are divided.
    if ("periodic" in kinds) != ("quasiperiodic" in kinds):
        longest = evidence.config["motion"]["longest_period"]
        reason += f" Motion that repeats within {longest:g} time units counts as periodic."
    exceptions = found.exceptions("other motion", "undetermined motion")
    return judge_conventions(
        evidence, found.verdict, reason, measured, exceptions, found.convention_judge(evidence, a, cases)
    )


@judge("agreement", "attractors")
def periodic_is_synchronized(
    evidence: Evidence, initial: str, a: Range, synchrony: Range, loose_share: float
) -> Verdict:
    """Judge whether the periodic solution, that from one initial state, is synchronized where it is periodic.

    synchrony : range in which the paper finds synchrony, which is judged
    a : range of the statement; where the periodic solution is not synchronized there is reported
    """

    def cases(inside: xarray.Dataset | None = None, where: Range = synchrony) -> Iterator[Case]:
        for law in PAPER_LAWS:
            grid, kind = motion_kinds(evidence, initial, law, where, inside)
            known = kind != MotionKind.UNDETERMINED
            applies = np.isin(kind, (*PERIODIC_KINDS, MotionKind.UNDETERMINED))
            unknown = (
                f"the kind of motion from {initial} under the {law} law is undetermined {format_values(grid, ~known)}"
            )
            if (applies & known).any():
                yield Case(law, grid, kind == MotionKind.SYNCHRONIZED, known, unknown, applies)

    found = for_all(loose_share, cases())
    if not found.cases:
        raise NotTestableError(f"no run from {initial} is periodic with {synchrony}")
    wider = list(cases(where=a))
    reason = (
        f"The periodic motion from {initial} is synchronized at {found} of the values of a with {synchrony}, where the "
        f"paper finds synchrony, and at {format_shares({case.name: case.share for case in wider})} of those with {a}."
    )
    measured = found.measured(f"share of a with {synchrony} at which it is synchronized")
    measured += [
        Measured(f"share of a with {a} at which it is synchronized, {case.name}", case.share.value) for case in wider
    ]
    exceptions = [
        f"{text} ({case.name})"
        for case in wider
        for text in case.exceptions("periodic without synchrony", "undetermined motion")
    ]
    return judge_conventions(
        evidence, found.verdict, reason, measured, exceptions, found.convention_judge(evidence, synchrony, cases)
    )


@judge("refined", "agreement", "orbits")
def onset_of_chaos(
    evidence: Evidence, initial: Sequence[str], claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge the a from which there is a chaotic attractor, under both laws.

    It lies between the smallest a with a chaotic attractor and the value of a before it, among all values at which
    attractors were searched for, including those inserted where attractors change. Chaos counts only if an ensemble
    shows that it persists. Also reported: the windows of chaos; the smallest a with a chaotic run, whose chaos may be
    transient; and a_c, where synchrony is lost.
    """
    evidence.check_blocks()
    refined = evidence.summary("refined")
    verdicts, measured, texts, windows = [], [], [], []
    for law in PAPER_LAWS:
        found = refined.sel(law=law)
        grid = found["a"].values
        there = (found["branch"].values >= 0) & (grid > 0.0)[:, None]
        if there.any(axis=1).sum() < MIN_VALUES:
            raise NotTestableError(f"attractors are known at fewer than {MIN_VALUES} values of a under the {law} law")
        chaotic = np.any(there & np.isin(found["kind"].values, CHAOS), axis=1)
        first = int(np.argmax(chaotic)) if chaotic.any() else len(grid)
        low, high = float(np.nanmax(grid)), np.inf
        if chaotic.any():
            low, high = grid[first - 1] if first else 0.0, grid[first]
        verdicts.append(judge_interval(low, high, claimed, tolerance, loose))
        if np.isfinite(high):
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            measured.append(Measured(f"smallest a with a chaotic attractor, {law}", middle, half))
            windows.append(f"chaotic attractors {format_values(grid, chaotic)} ({law})")
            texts.append(f"between {low:.5g} and {high:.5g} ({law})")
        else:
            texts.append(f"beyond {np.nanmax(grid):g} ({law})")
    for state in initial:
        for law in PAPER_LAWS:
            values, kind = motion_kinds(evidence, state, law, Range())
            if (kind == MotionKind.CHAOTIC).any():
                first_run = values[np.argmax(kind == MotionKind.CHAOTIC)]
                measured.append(Measured(f"smallest a with a chaotic run, {law}, {state}", float(first_run)))
    for law in PAPER_LAWS:
        critical, error = evidence.critical_a(law)
        if np.isfinite(critical):
            measured.append(Measured(f"a at which synchrony loses stability, {law}", critical, error))
    reason = f"The smallest a with a chaotic attractor lies {join_words(texts)}; the paper says near {claimed:g}."
    return Verdict(worst_verdict(verdicts), reason, measured, "; ".join(windows))


@judge("lyapunov", "attractors")
def largest_exponent_is_zero(evidence: Evidence, initial: str, law: str, a: Range, loose_share: float) -> Verdict:
    """Judge whether the largest Lyapunov exponent is 0 within its error at all a of a range.

    The thresholds are the study's: `motion.zero_exponent` and `motion.standard_errors`.
    """
    runs = evidence.choose(evidence.state_summary("lyapunov", initial), a).sel(law=law)
    if not runs.sizes.get("exponent"):
        raise NotTestableError("the study computes no Lyapunov exponents")
    grid = runs["a"].values
    exponent, error = (runs[name].values[:, 0] for name in ("lyapunov_exponent", "lyapunov_error"))
    known = np.isfinite(exponent) & np.isfinite(error)
    settings = MotionSettings(**evidence.config["motion"]).scaled_to_velocity(evidence.config["v"])
    unknown = f"the Lyapunov exponents of the run from {initial} are not known {format_values(grid, ~known)}"
    case = Case(law, grid, is_zero_exponent(exponent, error, settings), known, unknown)
    found = for_all(loose_share, [case])
    largest = int(np.nanargmax(np.where(known, np.abs(exponent), np.nan)))
    measured = [
        Measured("share of a at which it is 0 within its error", found.share.value),
        Measured(f"largest in modulus, at a = {grid[largest]:g}", exponent[largest], error[largest]),
    ]
    share = found.share
    reason = (
        f"The largest exponent from {initial} ({law}) is 0 within its error at {share} of the values of a with {a}."
    )

    def regular(inside: xarray.Dataset) -> list[Case]:
        # The largest exponent of regular motion is that of the flow, 0; in chaos it is positive.
        kind = kinds_reached(inside, initial, law)
        right = np.isin(kind, (MotionKind.SYNCHRONIZED, *REGULAR))
        return [Case(law, inside["a"].values, right, kind != MotionKind.UNDETERMINED)]

    changes = case.exceptions("not 0", "exponent not known")
    return judge_conventions(
        evidence, found.verdict, reason, measured, changes, found.convention_judge(evidence, a, regular)
    )


@judge("lyapunov", "agreement", "rotation", "attractors")
def aperiodic(evidence: Evidence, initial: str, laws: Sequence[str], at: float, points: int) -> Verdict:
    """Judge whether the motion from a state at one a, under some laws, is aperiodic: chaotic or quasiperiodic.

    Quasiperiodic means regular motion that does not repeat within `motion.longest_period`, locked or not. The claim
    holds loosely if the motion repeats only after more than `points` points of the section W = 0, a cloud.
    """
    verdicts, measured, texts, elsewhere = [], [], [], []
    runs = evidence.choose(evidence.state_summary("lyapunov", initial), Range(above=0.0))
    longest = evidence.config["motion"]["longest_period"]
    for law in laws:
        run = evidence.at(runs, at).sel(law=law)
        grid, kinds = motion_kinds(evidence, initial, law, Range(above=0.0))
        kind = int(kinds[grid == at].item())
        if kind == MotionKind.UNDETERMINED:
            raise NotTestableError(
                f"the kind of motion from {initial} at a = {at:g} under the {law} law is undetermined"
            )
        period = int(run["section_period"].item())
        verdicts.append(_judge_repetition(kind, period, points))
        measured.append(Measured(f"section points in a period (0: not periodic), {law}", float(period)))
        if run.sizes.get("exponent", 0) > 1:
            exponent, error = (run[name].values[1] for name in ("lyapunov_exponent", "lyapunov_error"))
            measured.append(Measured(f"second exponent, {law}", float(exponent), float(error)))
        seen = f"after {period} section points" if period else f"within {longest:g} time units"
        cloud = ", which look like a cloud" if period > points else ""
        repeats = f"repeats {seen}{cloud}" if kind in PERIODIC_KINDS else f"does not repeat {seen}"
        texts.append(f"{MotionKind(kind).words} ({law}): it {repeats}")
        others = ~np.isin(kinds, (*PERIODIC_KINDS, MotionKind.UNDETERMINED))
        elsewhere += describe_where("aperiodic", grid, others, law)
        elsewhere += _locking_ranges(evidence, law, at, kind)

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        there, found = attractors.sel(a=[at]), {}
        for law in laws:
            kind = int(kinds_reached(there, initial, law)[0])
            if kind != MotionKind.UNDETERMINED:
                found[law] = kind, int(reached_values(there, initial, law, "section_count")[1][0])
        if not found:
            return "", ""
        verdict = worst_verdict(_judge_repetition(kind, count, points) for kind, count in found.values())
        return verdict, ", ".join(f"{MotionKind(kind).words} ({law})" for law, (kind, _) in found.items())

    reason = f"The motion from {initial} at a = {at:g} is {join_words(texts)}."
    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, elsewhere, judge_attractors)


def _judge_repetition(kind: int, period: int, points: int) -> str:
    """Return the verdict on aperiodic motion for a kind and the section points in a period; see `aperiodic`."""
    if kind not in PERIODIC_KINDS:
        return HOLDS
    return LOOSELY if kind == MotionKind.PERIODIC and period > points else FAILS


def _locking_ranges(evidence: Evidence, law: str, at: float, kind: int) -> list[str]:
    """Describe the range of a around one a over which branch 1 is locked, if it is locked at this a."""
    if kind != MotionKind.PERIODIC or "rotation" not in evidence.summaries:
        return []
    found = [one for one in plateaux(evidence.summary("rotation").sel(law=law)) if one.first <= at <= one.last]
    return [
        f"locked with the ratio {one.ratio} only from a = {one.first:.5g} to {one.last:.5g} ({law})" for one in found
    ]
