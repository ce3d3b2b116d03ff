"""Claims on the solvers of the equations: whether their solutions agree, and what they cost."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings, judge_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.outcomes import kinds_reached
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    count_share,
    format_shares,
    judge_shares,
    judge_worst_share,
)
from burridge_knopoff.motion.kind import MotionKind, is_same_result
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray


@judge("agreement", "solvers", "attractors")
def solutions_agree(
    evidence: Evidence, initial: Sequence[str], a: Range, relative: float, loose_share: float
) -> Verdict:
    """Judge whether the map, the numerical solution of the linearized law, and that of the nonlinear law agree.

    Solvers of one law agree at a point, a state and an a at which all of them were tried, if their ⟨J⟩ differs from
    that of the study's solver by no more than the fraction `relative`, three standard errors, or the threshold of
    synchronization. The laws agree at an a if both lead to synchrony, both to other regular motion, or both to chaos,
    which are the paper's results: the runs of the whole grid show it.

    a : range in which the laws are to agree; solvers are compared wherever they were tried
    loose_share : fraction of points, and of the values of a, from which the claim holds loosely
    """
    solved, measured, differences = _compare_solvers(evidence, initial, relative)
    solvers = {"solvers": count_share(np.array(solved))}

    def run_cases() -> Iterator[Case]:
        for state in initial:
            runs = evidence.choose(evidence.state_summary("agreement", state), a)
            kinds = runs["kind"].sel(law=list(PAPER_LAWS)).values
            known = ~(np.isnan(kinds) | (kinds == MotionKind.UNDETERMINED)).any(axis=0)
            unknown = f"the kind of motion from {state} is undetermined"
            yield Case(f"laws, {state}", runs["a"].values, is_same_result(*kinds), known, unknown)

    def judge_attractors(attractors: xarray.Dataset) -> tuple[str, str]:
        """Judge as if the solvers agreed at the same points under every convention."""
        inside, cases = evidence.choose(attractors, a), []
        for state in initial:
            one, other = (kinds_reached(inside, state, law) for law in PAPER_LAWS)
            known = (one != MotionKind.UNDETERMINED) & (other != MotionKind.UNDETERMINED)
            cases.append(Case(f"laws, {state}", inside["a"].values, is_same_result(one, other), known))
        if not all(case.is_decided(loose_share) for case in cases):
            return "", ""
        return judge_shares({**solvers, **{case.name: case.share for case in cases}}, loose_share)

    found = for_all(loose_share, run_cases())
    for state, case in zip(initial, found.cases, strict=True):
        differences += [f"{text} ({state})" for text in case.exceptions("the laws differ")]
    shares = {**solvers, **found.shares}
    own = judge_worst_share(shares, loose_share)
    laws = format_shares({state: shares[f"laws, {state}"] for state in initial})
    reason = (
        f"The solvers of each law agree on ⟨J⟩ at {sum(solved)} of {len(solved)} points (initial state, a), and the "
        f"laws have the same result (synchrony, other regular motion or chaos) at {laws} of the values of a with {a}."
    )
    numbers = [Measured(f"share with agreement of the {name}", share.value) for name, share in shares.items()]
    return judge_conventions(evidence, own, reason, [*numbers, *measured], differences, judge_attractors)


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
        solvers = evidence.choose(evidence.summary("solvers").sel(initial=state), Range(above=0.0), least=1)
        for value in solvers["a"].values:
            found = solvers.sel(a=value)
            mean, difference, error = (
                found[name].values for name in ("mean_distance", "difference", "difference_error")
            )
            there = np.isfinite(difference)
            # A solver that cannot treat a law has not failed.
            if (found["status"].values > Status.COMPLETED).any() or (there.sum(axis=-1) < 2).all():
                continue
            allowed = np.maximum.reduce(
                [relative * np.abs(mean), standard_errors * np.nan_to_num(error), np.full_like(mean, threshold)]
            )
            solved.append(bool((np.abs(difference) <= allowed)[there].all()))
            largest = float(np.abs(difference[there]).max())
            measured.append(Measured(f"largest |Δ⟨J⟩| between solvers, {state}, a = {value:g}", largest))
            if not solved[-1]:
                differences.append(f"the solvers differ at a = {value:g} ({state})")
    if not solved:
        raise NotTestableError("no point was completed by all solvers")
    return solved, measured, differences


@judge("solvers")
def map_is_cheaper(evidence: Evidence, steps: float, much: float, loose: float) -> Verdict:
    """Judge whether the map needs far fewer steps per unit time than solvers of the differential equations.

    These may be read as the paper's own; as Runge-Kutta with the step of the study; or as Taylor series, which solve
    the same equations from event to event.

    steps : the paper's time steps per unit time
    much, loose : ratio of their steps to those of the map above which the claim holds, and above which it holds loosely

    Unlike times, steps do not depend on the machine. A step of the map is a solution between two events, or part of
    one; it takes as long as a few Runge-Kutta steps.
    """
    evidence.check_blocks()
    found = evidence.summary("solvers").sel(law="linearized")
    if "map" not in found["solver"].values:
        raise NotTestableError("the study has no run with the solver map")
    rate = (found["step_count"] / found["end_time"]).where(found["step_count"] >= 0)
    own = rate.sel(solver="map").values
    own = own[np.isfinite(own)]
    if not len(own):
        raise NotTestableError("no run with the solver map completed")
    largest = float(own.max())
    taken = {"the paper's time stepping": steps}
    for name in ("rk4", "series"):
        if name in found["solver"].values and np.isfinite(rate.sel(solver=name)).any():
            taken[name] = float(np.nanmax(rate.sel(solver=name)))
    ratios = {name: number / largest for name, number in taken.items()}
    measured = [Measured("largest number of steps of the map per unit time", largest)]
    for name, number in taken.items():
        measured.append(Measured(f"number of steps per unit time, {name}", number))
        measured.append(Measured(f"ratio of these to those of the map, {name}", ratios[name]))
    if "rk4" in taken:
        error = np.abs(found["difference"].sel(solver="rk4").values)
        measured.append(Measured("largest |Δ⟨J⟩| of rk4 at that step", float(np.nanmax(error))))
    readings = {
        f"compared with {name}": HOLDS if ratio >= much else LOOSELY if ratio >= loose else FAILS
        for name, ratio in ratios.items()
    }
    texts = [
        f"{name} takes {taken[name]:.4g}, {_format_ratio(ratio)} ({readings[f'compared with {name}']})"
        for name, ratio in ratios.items()
    ]
    reason = f"The map takes at most {largest:.2f} steps per unit time; {'; '.join(texts)}."
    return combine_readings(readings, reason, measured)


def _format_ratio(times: float) -> str:
    """Return a ratio of steps as text: «no more steps», «20 times as many»."""
    return f"{times:.4g} times as many" if f"{times:.4g}" != "1" else "no more steps"
