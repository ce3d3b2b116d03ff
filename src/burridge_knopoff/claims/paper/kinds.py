"""Claims on the kind of motion: periodic, quasiperiodic or chaotic."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseShare, LooseTolerance, Tolerance
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import judge_conventions
from burridge_knopoff.claims.evidence import Evidence, check_covered
from burridge_knopoff.claims.outcomes import PERIODIC_KINDS, Reached, Runs, reached_attractor
from burridge_knopoff.claims.range import ABOVE, BELOW, SYNCHRONY, Range
from burridge_knopoff.claims.statement import Statement, Truth, for_all
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    Measured,
    NotTestableError,
    Verdict,
    at_values,
    describe_where,
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
from burridge_knopoff.study.formatting import format_values
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.plateaux import plateaux

if TYPE_CHECKING:
    import xarray

#: The reason not to judge the kind of motion of a run.
UNDETERMINED = "the kind of motion from {initial} under the {law} law is undetermined {where}"


def _all_of_kind(
    evidence: Evidence, initial: Sequence[str], laws: Sequence[str], kinds: Sequence[str], a: Range, loose_share: float
) -> Verdict:
    """Judge whether all runs from some states under some laws have one of several kinds of motion in a range of a.

    kinds : meanings of `kind`: synchronized, periodic, quasiperiodic, chaotic

    Not testable if the runs of undetermined kind decide.
    """
    allowed = [int(kind) for kind in MotionKind if kind.name.lower() in kinds]
    what = join_words(kinds, "or")

    def truth(motion: Runs | Reached) -> Truth:
        kind = motion.kind.sel(law=list(laws))
        return Truth(kind.isin(allowed), kind != MotionKind.UNDETERMINED)

    share = for_all(evidence, initial, a, loose_share, truth, UNDETERMINED, truth)
    measured = share.measured(f"share of a with {what} motion")
    if "attractors" in evidence.summaries:
        attractors = evidence.choose(evidence.summary("attractors"), a).sel(law=list(laws))
        known = (attractors["branch"] >= 0).values & (attractors["kind"].values != MotionKind.UNDETERMINED)
        if known.any():
            of_all = float(np.isin(merge_chaos(attractors["kind"].values), allowed)[known].mean())
            measured.append(Measured(f"share of all attractors with {what} motion", of_all))
    reason = f"The motion is {what} {share.at(a)}."
    # Periodic and quasiperiodic together are regular motion, however the two are divided.
    if ("periodic" in kinds) != ("quasiperiodic" in kinds):
        longest = evidence.config["motion"]["longest_period"]
        reason += f" Motion that repeats within {longest:g} time units counts as periodic."
    return share.conclude(reason, measured, "other motion", "undetermined motion")


@claim("Abstract; Introduction", "lyapunov", "agreement", "attractors")
def regular_below(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    laws: tuple[str, ...] = ("linearized", "nonlinear"),
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """For a < 0.1 the motion is periodic or quasiperiodic."""
    return _all_of_kind(
        evidence,
        initial=initial,
        laws=laws,
        kinds=("synchronized", "periodic", "quasiperiodic"),
        a=a,
        loose_share=loose_share,
    )


@claim("Abstract; Introduction", "lyapunov", "agreement", "attractors")
def chaotic_above(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    laws: tuple[str, ...] = ("linearized", "nonlinear"),
    a: Range = ABOVE,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """For a > 0.1 the motion is chaotic."""
    return _all_of_kind(evidence, initial=initial, laws=laws, kinds=("chaotic",), a=a, loose_share=loose_share)


@claim("Results, Figs. 4a and 6", "motion_minus", "agreement", "attractors", depends_on=("minus_one_section_point",))
def minus_periodic(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus",),
    laws: tuple[str, ...] = ("linearized",),
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From minus positions and velocities are periodic functions of time for a < 0.1."""
    return _all_of_kind(
        evidence, initial=initial, laws=laws, kinds=("synchronized", "periodic"), a=a, loose_share=loose_share
    )


@claim(
    "Abstract",
    "lyapunov",
    "agreement",
    "attractors",
    depends_on=("minus_synchronizes", "minus_periodic"),
)
def periodic_is_synchronized(
    evidence: Evidence,
    *,
    initial: str = "minus",
    a: Range = BELOW,
    synchrony: Range = SYNCHRONY,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """The periodic solution, that from minus, is synchronized.

    «For the periodic solution, we observe a synchronization»: the one that the paper finds, from minus, and where
    it finds synchrony. Whether other periodic motion is synchronized it does not say.

    synchrony : range in which the paper finds synchrony, which is judged
    a : range of the statement; where the periodic solution is not synchronized there is reported
    """

    def truth(motion: Runs | Reached) -> Truth:
        kind = motion.kind
        periodic = kind.isin((*PERIODIC_KINDS, MotionKind.UNDETERMINED))
        known = kind != MotionKind.UNDETERMINED
        # Laws under which no motion is periodic say nothing.
        laws = kind["law"][(periodic & known).any(("initial", "a")).values].values
        parts = (part.sel(law=laws, initial=initial) for part in (kind == MotionKind.SYNCHRONIZED, known, periodic))
        return Truth(*parts)

    unknown = UNDETERMINED.replace("{initial}", initial)
    share = for_all(evidence, [initial], synchrony, loose_share, truth, unknown, truth)
    if not share.cases:
        raise NotTestableError(f"no run from {initial} is periodic with {synchrony}")
    wider = Statement(evidence, list(truth(Runs(evidence, [initial], a)).cases()), loose_share)
    reason = (
        f"The periodic motion from {initial} is synchronized {share.at(synchrony)}, where "
        f"the paper finds synchrony, and {wider.at(a)}."
    )
    measured = share.measured(f"share of a with {synchrony} at which it is synchronized")
    measured += wider.measured(f"share of a with {a} at which it is synchronized")
    return replace(share, cases=wider.cases).conclude(
        reason, measured, "periodic without synchrony", "undetermined motion", verdict=share.verdict
    )


@claim(
    "Introduction",
    "lyapunov",
    "refined",
    "agreement",
    "orbits",
    depends_on=("regular_below", "chaotic_above"),
)
def transition(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    claimed: float = 0.1,
    tolerance: Tolerance = 0.01,
    loose: LooseTolerance = 0.02,
) -> Verdict:
    """Near a = 0.1 periodic or quasiperiodic motion turns into chaos.

    Holds if the smallest a with a chaotic attractor is within {tolerance:g} of {claimed:g} under both laws, and loosely
    within {loose:g}. It lies between a value of a and the one before it, among all at which attractors were searched
    for, including those inserted where attractors change. Chaos counts only if an ensemble shows that it persists.

    Also reported: the windows of chaos; the smallest a with a chaotic run, whose chaos may be transient; and a_c, where
    synchrony is lost.
    """
    evidence.check_blocks()
    refined = evidence.summary("refined")
    verdicts, measured, texts, windows = [], [], [], []
    for law in PAPER_LAWS:
        search = refined.sel(law=law)
        grid = search["a"].values
        searched = (search["branch"].values >= 0) & (grid > 0.0)[:, None]
        chaotic = np.any(searched & np.isin(search["kind"].values, CHAOS), axis=1)
        first = int(np.argmax(chaotic)) if chaotic.any() else len(grid)
        # Attractors have to be known from 0 to the chaos, or well beyond the claimed value.
        top = grid[first] if chaotic.any() else claimed + 2.0 * loose
        check_covered(grid[searched.any(axis=1)], Range(above=0.0, last=float(top)), "the search for attractors")
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
    kinds = Runs(evidence, initial, Range()).kind
    for state in initial:
        for law in PAPER_LAWS:
            chaotic_runs = kinds.sel(initial=state, law=law) == MotionKind.CHAOTIC
            if chaotic_runs.any():
                first_run = float(kinds["a"][chaotic_runs][0])
                measured.append(Measured(f"smallest a with a chaotic run, {law}, {state}", first_run))
    for law in PAPER_LAWS:
        critical, error = evidence.critical_a(law)
        if np.isfinite(critical):
            measured.append(Measured(f"a at which synchrony loses stability, {law}", critical, error))
    reason = f"The smallest a with a chaotic attractor lies {join_words(texts)}; the paper says near {claimed:g}."
    return Verdict(worst_verdict(verdicts), reason, measured, "; ".join(windows))


@claim("Results", "lyapunov", "lyapunov", "attractors", depends_on=("regular_below",))
def plus_largest_exponent(
    evidence: Evidence,
    *,
    initial: str = "plus",
    law: str = "linearized",
    a: Range = BELOW,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """From plus the largest Lyapunov exponent is close to zero for a < 0.1.

    Holds if it is 0 within its error, by the study's thresholds `motion.zero_exponent` and `motion.standard_errors`, at
    all values of a, and loosely at nine in ten of them.
    """
    settings = MotionSettings(**evidence.config["motion"]).scaled_to_velocity(evidence.config["v"])
    runs = evidence.choose(evidence.state_summary("lyapunov", [initial]), a).sel(law=[law])
    if not runs.sizes.get("exponent"):
        raise NotTestableError("the study computes no Lyapunov exponents")
    exponent, error = (runs[name].isel(exponent=0, initial=0) for name in ("lyapunov_exponent", "lyapunov_error"))

    def is_zero(_runs: Runs) -> Truth:
        zero = exponent.copy(data=is_zero_exponent(exponent.values, error.values, settings))
        return Truth(zero, exponent.notnull() & error.notnull() & np.isfinite(exponent))

    def is_regular(motion: Reached) -> Truth:
        # The largest exponent of regular motion is that of the flow, 0; in chaos it is positive.
        kind = motion.kind.sel(law=[law], initial=initial)
        return Truth(kind.isin((MotionKind.SYNCHRONIZED, *REGULAR)), kind != MotionKind.UNDETERMINED)

    unknown = f"the Lyapunov exponents of the run from {initial} are not known {{where}}"
    share = for_all(evidence, [initial], a, loose_share, is_zero, unknown, is_regular)
    largest = int(np.nanargmax(np.abs(exponent.where(np.isfinite(error))[0])))
    value, spread = exponent.values[0, largest], error.values[0, largest]
    measured = [
        Measured("share of a at which it is 0 within its error", share.share.value),
        Measured(f"largest in modulus, at a = {exponent['a'].values[largest]:g}", value, spread),
    ]
    return share.conclude(
        f"The largest exponent from {initial} ({law}) is 0 within its error {at_values(share.share, a)}.",
        measured,
        "not 0",
        "exponent not known",
    )


@claim(
    "Results, Fig. 7",
    "motion_plus",
    "lyapunov",
    "agreement",
    "rotation",
    "attractors",
    depends_on=("plus_not_periodic",),
)
def plus_aperiodic(
    evidence: Evidence,
    *,
    initial: str = "plus",
    laws: tuple[str, ...] = ("linearized",),
    at: float = 0.08,
) -> Verdict:
    """From plus the motion at a = 0.08 is aperiodic.

    Holds if the motion does not repeat within `motion.longest_period`, or is chaotic. Motion that repeats is periodic,
    however many points its section has.
    """
    verdicts, measured, texts, elsewhere = [], [], [], []
    runs = evidence.choose(evidence.state_summary("lyapunov", initial), Range(above=0.0))
    kinds = Runs(evidence, [initial], Range(above=0.0)).kind.sel(initial=initial)
    longest = evidence.config["motion"]["longest_period"]
    for law in laws:
        run = evidence.at(runs, at).sel(law=law)
        kind = int(kinds.sel(law=law, a=at).item())
        if kind == MotionKind.UNDETERMINED:
            raise NotTestableError(
                f"the kind of motion from {initial} at a = {at:g} under the {law} law is undetermined"
            )
        period = int(run["section_period"].item())
        verdicts.append(_judge_repetition(kind))
        measured.append(Measured(f"section points in a period (0: not periodic), {law}", float(period)))
        if run.sizes.get("exponent", 0) > 1:
            exponent, error = (run[name].values[1] for name in ("lyapunov_exponent", "lyapunov_error"))
            measured.append(Measured(f"second exponent, {law}", float(exponent), float(error)))
        seen = f"after {period} section points" if period else f"within {longest:g} time units"
        repeats = f"repeats {seen}" if kind in PERIODIC_KINDS else f"does not repeat {seen}"
        texts.append(f"{MotionKind(kind).words} ({law}): it {repeats}")
        aperiodic = ~kinds.sel(law=law).isin((*PERIODIC_KINDS, MotionKind.UNDETERMINED))
        elsewhere += describe_where("aperiodic", kinds["a"].values, aperiodic.values, law)
        elsewhere += _locking_ranges(evidence, law, at, kind)

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        reached = {
            law: values
            for law in laws
            if (values := reached_attractor(attractors, at, initial, law, "kind"))
            and values[0] != MotionKind.UNDETERMINED
        }
        if not reached:
            return "", ""
        verdict = worst_verdict(_judge_repetition(kind) for (kind,) in reached.values())
        return verdict, ", ".join(f"{MotionKind(int(kind)).words} ({law})" for law, (kind,) in reached.items())

    reason = f"The motion from {initial} at a = {at:g} is {join_words(texts)}."
    return judge_conventions(evidence, worst_verdict(verdicts), reason, measured, elsewhere, judge_attractors)


def _judge_repetition(kind: int) -> str:
    """Return the verdict on aperiodic motion for a kind."""
    return FAILS if kind in PERIODIC_KINDS else HOLDS


def _locking_ranges(evidence: Evidence, law: str, at: float, kind: int) -> list[str]:
    """Describe the range of a around one a over which branch 1 is locked, if it is locked at this a."""
    if kind != MotionKind.PERIODIC or "rotation" not in evidence.summaries:
        return []
    return [
        f"locked with the ratio {plateau.ratio} only from a = {plateau.first:.5g} to {plateau.last:.5g} ({law})"
        for plateau in plateaux(evidence.summary("rotation").sel(law=law))
        if plateau.first <= at <= plateau.last
    ]
