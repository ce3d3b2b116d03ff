"""Claims on the solvers of the equations: whether their solutions agree, and what they cost."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseShare, LooseTolerance, Much, Relative
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.outcomes import Reached, Runs
from burridge_knopoff.claims.range import ABOVE, BELOW, Range
from burridge_knopoff.claims.statement import Case, Truth, for_all
from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Share,
    Verdict,
    count_share,
    judge_shares,
    judge_worst_share,
    worst_verdict,
)
from burridge_knopoff.motion.kind import MotionKind, is_same_result
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray

PAPER_STEPPING = "the paper's time stepping"

# Solvers have to be compared at this many values of a at least.
LEAST_TRIED = 2


@claim("Abstract", "solvers", "agreement", "solvers", "attractors")
def solutions_agree(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = BELOW,
    above: Range = ABOVE,
    relative: Relative = 0.001,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """The results are the same for the linearized map, the linearized numerical and the nonlinear numerical
    solution.

    Holds if the solvers of each law agree at all points, and the laws at all values of a from each state; and loosely
    at nine in ten of each. The laws agree at an a if both lead to synchrony, both to other regular motion, or both to
    chaos. Solvers agree at a point, a state and an a at which all of them were tried, if their ⟨J⟩ differs from that of
    the study's solver by no more than a fraction of {relative:g}, three standard errors, or the threshold of
    synchronization.

    «These results» are those for a < 0.1, the range to which the rest of the paper limits the linearization, or also
    the chaos for a > 0.1, which the abstract names in the sentence before.

    a, above : ranges in which the laws are to agree; solvers are compared wherever they were tried
    """
    if (tried := int(a.choose(evidence.summary("solvers")["a"].values).sum())) < LEAST_TRIED:
        raise NotTestableError(
            f"solvers have to be compared at {LEAST_TRIED} values of a with {a}; solvers.a has {tried} there"
        )
    solved, measured, differences = _compare_solvers(evidence, initial, relative)
    solvers = {"solvers": count_share(np.array(solved))}

    def same_result(motion: Runs | Reached) -> Truth:
        kind, other = (motion.kind.sel(law=law, drop=True) for law in PAPER_LAWS)
        known = (kind != MotionKind.UNDETERMINED) & (other != MotionKind.UNDETERMINED)
        same = kind.copy(data=is_same_result(kind.values, other.values))
        return Truth(same, known & kind.notnull() & other.notnull())

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        """Judge as if the solvers agreed at the same points under every convention."""
        cases = list(same_result(Reached(evidence, evidence.choose(attractors, a), initial)).cases())
        if not all(case.is_decided(loose_share) for case in cases):
            return "", ""
        return judge_shares({**solvers, **_of_laws(cases)}, loose_share)

    unknown = "the kind of motion from {initial} is undetermined {where}"
    laws = for_all(evidence, initial, a, loose_share, same_result, unknown)
    differences += laws.exceptions("the laws differ")
    shares = {**solvers, **_of_laws(laws.cases)}
    verdict = judge_worst_share(shares, loose_share)
    chaos = for_all(evidence, initial, above, loose_share, same_result, unknown)
    of_chaos = judge_shares(chaos.shares, loose_share)[0]
    numbers = [Measured(f"share with agreement of the {name}", share.value) for name, share in shares.items()]
    numbers += chaos.measured(f"share of a with the same result, {above}")
    below = judge_conventions(evidence, verdict, "", [*numbers, *measured], differences, judge_attractors)
    reason = (
        f"The solvers of each law agree on ⟨J⟩ at {sum(solved)} of {len(solved)} points (initial state, a), and the "
        f"laws have the same result (synchrony, other regular motion or chaos) {laws.at(a)} ({below.verdict}), and "
        f"{chaos.at(above)} ({of_chaos})."
    )
    if below.verdict == CONVENTION:
        return replace(below, reason=reason)
    readings = {f"for {a}": below.verdict, f"for {above} as well": worst_verdict([below.verdict, of_chaos])}
    changes = [*filter(None, [below.changes]), *chaos.exceptions("the laws differ")]
    return combine_readings(readings, reason, below.measured, changes)


def _of_laws(cases: Sequence[Case]) -> dict[str, Share]:
    return {f"laws, {case.name}": case.share for case in cases}


def _compare_solvers(
    evidence: Evidence, initial: Sequence[str], relative: float
) -> tuple[list[bool], list[Measured], list[str]]:
    """Return whether the solvers agree at each point, the largest differences, and where they differ, in words.

    Raises NotTestableError if no point was completed by all solvers.
    """
    solved, measured, differences = [], [], []
    tolerances = evidence.summary("agreement").attrs
    threshold, standard_errors = tolerances["synchronization_threshold"], tolerances["standard_errors"]
    for state in initial:
        evidence.check_state(state)
        solvers = evidence.choose(evidence.summary("solvers").sel(initial=state), Range(above=0.0))
        for value in solvers["a"].values:
            runs = solvers.sel(a=value)
            mean, difference, error = (
                runs[name].values for name in ("mean_distance", "difference", "difference_error")
            )
            completed = np.isfinite(difference)
            # A solver that cannot treat a law has not failed.
            if (runs["status"].values > Status.COMPLETED).any() or (completed.sum(axis=-1) < 2).all():
                continue
            allowed = np.maximum.reduce(
                [relative * np.abs(mean), standard_errors * np.nan_to_num(error), np.full_like(mean, threshold)]
            )
            solved.append(bool((np.abs(difference) <= allowed)[completed].all()))
            largest = float(np.abs(difference[completed]).max())
            measured.append(Measured(f"largest |Δ⟨J⟩| between solvers, {state}, a = {value:g}", largest))
            if not solved[-1]:
                differences.append(f"the solvers differ at a = {value:g} ({state})")
    if not solved:
        raise NotTestableError("no point was completed by all solvers")
    return solved, measured, differences


@claim("Conclusions", "solvers", "solvers")
def map_is_cheaper(
    evidence: Evidence, *, steps: float = 1000000.0, much: Much = 1000.0, loose: LooseTolerance = 100.0
) -> Verdict:
    """The map takes far less computing than stepping the differential equations.

    Holds if the paper's own time stepping takes at least {much:g} times as many steps per unit time as the map, and
    loosely if it takes {loose:g} times as many.

    Unlike times, steps do not depend on the machine. A step of the map is a solution between two events, or part of
    one; it takes as long as a few Runge-Kutta steps. The study's other solvers, Runge-Kutta with a larger step and
    Taylor series, are listed but do not decide: the paper does not speak of them.

    steps : the paper's time steps per unit time
    """
    evidence.check_blocks()
    runs = evidence.summary("solvers").sel(law="linearized")
    if "map" not in runs["solver"].values:
        raise NotTestableError("the study has no run with the solver map")
    rate = (runs["step_count"] / runs["end_time"]).where(runs["step_count"] >= 0)
    map_rate = rate.sel(solver="map").values
    map_rate = map_rate[np.isfinite(map_rate)]
    if not len(map_rate):
        raise NotTestableError("no run with the solver map completed")
    largest = float(map_rate.max())
    taken = {PAPER_STEPPING: steps}
    for name in ("rk4", "series"):
        if name in runs["solver"].values and np.isfinite(rate.sel(solver=name)).any():
            taken[name] = float(np.nanmax(rate.sel(solver=name)))
    ratios = {name: number / largest for name, number in taken.items()}
    measured = [Measured("largest number of steps of the map per unit time", largest)]
    for name, number in taken.items():
        measured.append(Measured(f"number of steps per unit time, {name}", number))
        measured.append(Measured(f"ratio of these to those of the map, {name}", ratios[name]))
    if "rk4" in taken:
        error = np.abs(runs["difference"].sel(solver="rk4").values)
        measured.append(Measured("largest |Δ⟨J⟩| of rk4 at that step", float(np.nanmax(error))))
    ratio = ratios[PAPER_STEPPING]
    verdict = HOLDS if ratio >= much else LOOSELY if ratio >= loose else FAILS
    own, *others = (f"{name} takes {taken[name]:.4g}, {_format_ratio(ratio)}" for name, ratio in ratios.items())
    reason = f"The map takes at most {largest:.2f} steps per unit time; {own}."
    return Verdict(verdict, reason, measured, "; ".join(others))


def _format_ratio(times: float) -> str:
    """Return a ratio of steps as text: «no more steps», «20 times as many»."""
    return f"{times:.4g} times as many" if f"{times:.4g}" != "1" else "no more steps"
