"""Claims on the kind of motion: periodic, quasiperiodic or chaotic."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.attractors.lookup import reached_values
from burridge_knopoff.claims.conventions import by_readings, shares_by_readings, under_conventions
from burridge_knopoff.claims.evidence import LEAST_VALUES, Evidence
from burridge_knopoff.claims.for_all import Case, ForAll, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import CLOSED, kinds_of, kinds_reached
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    at_values,
    by_interval,
    shares_text,
    told_where,
    worst,
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

    Not testable if the runs with an unknown kind of motion decide.
    """
    allowed = [int(kind) for kind in MotionKind if kind.name.lower() in kinds]
    what = " or ".join(kinds)

    def cases(inside: xarray.Dataset | None = None) -> Iterator[Case]:
        for law in laws:
            for state in initial:
                grid, kind = kinds_of(evidence, state, law, a, inside)
                known = kind != MotionKind.UNDETERMINED
                unknown = f"the kind of motion from {state} under the {law} law is unknown {at_values(grid, ~known)}"
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
    exceptions = found.exceptions("other motion", "unknown")
    return under_conventions(evidence, found.verdict, reason, measured, exceptions, found.reached(evidence, a, cases))


@judge("agreement", "lyapunov", "attractors")
def periodic_is_synchronized(
    evidence: Evidence, initial: Sequence[str], a: Range, synchrony: Range, points: int, loose_share: float
) -> Verdict:
    """Judge whether runs without synchrony are never periodic: all periodic runs are synchronized.

    Periodic may mean all motion that repeats within `motion.longest_period`, in the range a. Or it may mean motion
    whose section W = 0 is a line, as the paper calls it, where it finds synchrony: more points than `points` are a
    cloud, which it takes for quasiperiodic or chaotic motion.

    synchrony : range of a in which the paper finds synchrony
    """
    longest = evidence.config["motion"]["longest_period"]
    everything = _of_periodic(evidence, initial, a, np.inf, loose_share)
    lines = _of_periodic(evidence, initial, synchrony, points, loose_share)
    shares = {
        f"with {a} that repeat within {longest:g} time units": everything.shares,
        f"with {synchrony} whose section is no cloud": lines.shares,
    }
    readings = shares_by_readings(shares, loose_share)
    measured = [
        Measured(f"share of the periodic runs {reading} that are synchronized, {name}", share.value)
        for reading, of_runs in shares.items()
        for name, share in of_runs.items()
    ]
    texts = [f"{shares_text(of)} of those {name} ({readings[name]})" for name, of in shares.items()]
    changes = everything.exceptions("periodic without synchrony", "unknown")
    for convention, attractors in evidence.other_conventions():
        inside = evidence.choose(attractors, a)
        for law in PAPER_LAWS:
            for state in initial:
                periodic = kinds_reached(inside, state, law) == MotionKind.PERIODIC
                words = f"{convention}: periodic without synchrony"
                changes += told_where(words, inside["a"].values, periodic, f"{law}, {state}")
    return by_readings(readings, f"Of the periodic runs are synchronized: {'; '.join(texts)}.", measured, changes)


def _of_periodic(evidence: Evidence, initial: Sequence[str], a: Range, most: float, loose_share: float) -> ForAll:
    """Return for which of the periodic runs with at most so many section points it is right that they synchronize.

    Raises NotTestableError if no run is periodic, or runs of unknown kind decide.
    """

    def cases() -> Iterator[Case]:
        for law in PAPER_LAWS:
            for state in initial:
                grid, kind = kinds_of(evidence, state, law, a)
                count = evidence.choose(evidence.of_state("lyapunov", state), a).sel(law=law)["section_period"].values
                # A section that does not repeat within the run has more points than can be counted.
                few = np.where(count > 0, count, np.inf) <= most
                synchronized = kind == MotionKind.SYNCHRONIZED
                periodic = synchronized | ((kind == MotionKind.PERIODIC) & few)
                # A run of unknown kind may be periodic without synchrony.
                may_be = periodic | (kind == MotionKind.UNDETERMINED)
                where = at_values(grid, may_be & ~periodic)
                unknown = f"the kind of motion from {state} under the {law} law is unknown {where}"
                if periodic.any():
                    yield Case(f"{law}, {state}", grid, synchronized, periodic, unknown, may_be)

    found = for_all(loose_share, cases())
    if not found.cases:
        raise NotTestableError(f"no run is periodic with {a}")
    return found


@judge("refined", "agreement", "orbits")
def onset_of_chaos(
    evidence: Evidence, initial: Sequence[str], claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge the a from which there is a chaotic attractor, under both laws.

    It lies between the smallest a with a chaotic attractor and the value of a before it, among all values at which
    attractors were searched for, including those added where something changes. Chaos that an ensemble does not show to
    last does not count. Also reported: the windows of chaos; the smallest a with a chaotic run, whose chaos may be
    transient; and a_c, where synchrony is lost.
    """
    evidence.check_blocks()
    refined = evidence.summary("refined")
    verdicts, measured, texts, windows = [], [], [], []
    for law in PAPER_LAWS:
        found = refined.sel(law=law)
        grid = found["a"].values
        there = (found["branch"].values >= 0) & (grid > 0.0)[:, None]
        if there.any(axis=1).sum() < LEAST_VALUES:
            raise NotTestableError(f"attractors are known at fewer than {LEAST_VALUES} values of a under the {law} law")
        chaotic = np.any(there & np.isin(found["kind"].values, CHAOS), axis=1)
        first = int(np.argmax(chaotic)) if chaotic.any() else len(grid)
        low, high = float(np.nanmax(grid)), np.inf
        if chaotic.any():
            low, high = grid[first - 1] if first else 0.0, grid[first]
        verdicts.append(by_interval(low, high, claimed, tolerance, loose))
        if np.isfinite(high):
            middle, half = 0.5 * (low + high), 0.5 * (high - low)
            measured.append(Measured(f"smallest a with a chaotic attractor, {law}", middle, half))
            windows.append(f"chaotic attractors {at_values(grid, chaotic)} ({law})")
            texts.append(f"at a = {high:.5g}, and not at {low:.5g} ({law})")
        else:
            texts.append(f"nowhere up to {np.nanmax(grid):g} ({law})")
    for state in initial:
        for law in PAPER_LAWS:
            values, kind = kinds_of(evidence, state, law, Range())
            if (kind == MotionKind.CHAOTIC).any():
                first_run = values[np.argmax(kind == MotionKind.CHAOTIC)]
                measured.append(Measured(f"smallest a with a chaotic run, {law}, {state}", float(first_run)))
    for law in PAPER_LAWS:
        critical, error = evidence.critical_a(law)
        if np.isfinite(critical):
            measured.append(Measured(f"a at which synchrony loses stability, {law}", critical, error))
    reason = f"A chaotic attractor is first found {'; '.join(texts)}; the claim says near {claimed:g}."
    return Verdict(worst(verdicts), reason, measured, "; ".join(windows))


@judge("lyapunov", "attractors")
def largest_exponent_is_zero(evidence: Evidence, initial: str, law: str, a: Range, loose_share: float) -> Verdict:
    """Judge whether the largest Lyapunov exponent is 0 within its error at all a of a range.

    The thresholds are the study's: `motion.zero_exponent` and `motion.standard_errors`.
    """
    runs = evidence.choose(evidence.of_state("lyapunov", initial), a).sel(law=law)
    if not runs.sizes.get("exponent"):
        raise NotTestableError("the study computes no Lyapunov exponents")
    grid = runs["a"].values
    exponent, error = (runs[name].values[:, 0] for name in ("lyapunov_exponent", "lyapunov_error"))
    known = np.isfinite(exponent) & np.isfinite(error)
    settings = MotionSettings(**evidence.config["motion"]).scaled_to_velocity(evidence.config["v"])
    unknown = f"the Lyapunov exponents of the run from {initial} are unknown {at_values(grid, ~known)}"
    case = Case(law, grid, is_zero_exponent(exponent, error, settings), known, unknown)
    found = for_all(loose_share, [case])
    largest = int(np.nanargmax(np.where(known, np.abs(exponent), np.nan)))
    measured = [
        Measured("share of a at which it cannot be told from 0", found.share.value),
        Measured(f"largest in modulus, at a = {grid[largest]:g}", exponent[largest], error[largest]),
    ]
    reason = (
        f"The largest exponent from {initial} ({law}) cannot be told from 0 at {found.share} of the values of a with "
        f"{a}."
    )

    def regular(inside: xarray.Dataset) -> list[Case]:
        # The largest exponent of regular motion is that of the flow, 0; in chaos it is positive.
        kind = kinds_reached(inside, initial, law)
        right = np.isin(kind, (MotionKind.SYNCHRONIZED, *REGULAR))
        return [Case(law, inside["a"].values, right, kind != MotionKind.UNDETERMINED)]

    changes = case.exceptions("not 0", "unknown")
    return under_conventions(evidence, found.verdict, reason, measured, changes, found.reached(evidence, a, regular))


@judge("lyapunov", "agreement", "rotation", "attractors")
def aperiodic(evidence: Evidence, initial: str, laws: Sequence[str], at: float, points: int) -> Verdict:
    """Judge whether the motion from a state at one a, under some laws, is aperiodic: chaotic or quasiperiodic.

    Quasiperiodic means regular motion that does not repeat within `motion.longest_period`, locked or not. The claim
    holds loosely if the motion repeats, but only after more than `points` points of the section W = 0, a cloud.
    """
    verdicts, measured, texts, elsewhere = [], [], [], []
    runs = evidence.choose(evidence.of_state("lyapunov", initial), Range(above=0.0))
    longest = evidence.config["motion"]["longest_period"]
    for law in laws:
        run = evidence.at(runs, at).sel(law=law)
        grid, kinds = kinds_of(evidence, initial, law, Range(above=0.0))
        kind = int(kinds[grid == at].item())
        if kind == MotionKind.UNDETERMINED:
            raise NotTestableError(f"the kind of motion from {initial} at a = {at:g} under the {law} law is unknown")
        period = int(run["section_period"].item())
        verdicts.append(_by_repetition(kind, period, points))
        measured.append(Measured(f"section points in a period (0: not periodic), {law}", float(period)))
        if run.sizes.get("exponent", 0) > 1:
            exponent, error = (run[name].values[1] for name in ("lyapunov_exponent", "lyapunov_error"))
            measured.append(Measured(f"second exponent, {law}", float(exponent), float(error)))
        seen = f"after {period} section points" if period else f"within {longest:g} time units"
        repeats = f"repeats {seen}" if kind in CLOSED else f"does not repeat {seen}"
        texts.append(f"{MotionKind(kind).words}: it {repeats} ({law})")
        others = ~np.isin(kinds, (*CLOSED, MotionKind.UNDETERMINED))
        elsewhere += told_where("aperiodic", grid, others, law)
        elsewhere += _neighbours(evidence, law, at, kind)

    def of_branches(attractors: xarray.Dataset) -> tuple[str, str]:
        there, found = attractors.sel(a=[at]), {}
        for law in laws:
            kind = int(kinds_reached(there, initial, law)[0])
            if kind != MotionKind.UNDETERMINED:
                found[law] = kind, int(reached_values(there, initial, law, "section_count")[1][0])
        if not found:
            return "", ""
        verdict = worst(_by_repetition(kind, count, points) for kind, count in found.values())
        return verdict, ", ".join(f"{MotionKind(kind).words} {law}" for law, (kind, _) in found.items())

    reason = f"The motion from {initial} at a = {at:g} is {' and '.join(texts)}."
    return under_conventions(evidence, worst(verdicts), reason, measured, elsewhere, of_branches)


def _by_repetition(kind: int, period: int, points: int) -> str:
    """Return how far motion of a kind, with so many section points in a period, is aperiodic; see `aperiodic`."""
    if kind not in CLOSED:
        return HOLDS
    return LOOSELY if kind == MotionKind.PERIODIC and period > points else FAILS


def _neighbours(evidence: Evidence, law: str, at: float, kind: int) -> list[str]:
    """Return, in words, the range of a over which branch 1 is locked around one a, if it is locked there."""
    if kind != MotionKind.PERIODIC or "rotation" not in evidence.summaries:
        return []
    found = [one for one in plateaux(evidence.summary("rotation").sel(law=law)) if one.first <= at <= one.last]
    return [f"locked, {one.ratio}, only from a = {one.first:.5g} to {one.last:.5g} ({law})" for one in found]
