"""Claims on the two friction laws and the ways to solve them: whether they agree, and what they cost."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_shares, under_conventions
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.kinds import kinds_reached
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    at_values,
    by_share,
    known_share,
)
from burridge_knopoff.running.status import Status
from burridge_knopoff.stability.motion import MotionKind, same_result
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray


def laws_agree(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to the same kind of motion and ⟨J⟩ at all a of a range, by the study's criterion."""
    shares, measured, apart = {}, [], []
    for state in initial:
        whole = evidence.compared(evidence.of_state("agreement", state))
        found = evidence.choose(whole, a)
        agrees = found["agrees"].values
        known = agrees >= 0
        unknown = f"the laws could not be compared from {state} {at_values(found['a'].values, ~known)}"
        shares[state] = known_share(agrees == 1, known, loose_share, unknown)
        measured.append(Measured(f"share of a at which the laws agree, {state}", shares[state]))
        parting = whole["parting_a"].item()
        if np.isfinite(parting):
            measured.append(Measured(f"least a at which they disagree, {state}", parting))
        difference = np.abs(found["difference"].values)
        if np.isfinite(difference[agrees == 1]).any():
            measured.append(
                Measured(f"largest |Δ⟨J⟩| where they agree, {state}", float(np.nanmax(difference[agrees == 1])))
            )
        if shares[state] < 1.0:
            apart.append(f"they disagree {at_values(found['a'].values, agrees == 0)} ({state})")
        if not known.all():
            apart.append(f"it is not known {at_values(found['a'].values, ~known)} ({state})")
    verdict, text = judge_shares(shares, loose_share)
    reason = f"The laws agree in ⟨J⟩ and kind of motion at {text} of the values of a with {a}."
    return Verdict(verdict, reason, measured, "; ".join(apart))


def two_blocks_agree(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether two blocks end on like motion under both laws, from all sampled states, at all a of a range."""
    found = evidence.choose(evidence.compared(evidence.summary("two_blocks")), a)
    agrees, same_kind, margin = (
        found[name].transpose("state", "a").values for name in ("agrees", "same_kind", "margin")
    )
    # One state that parts them is enough; to say that none does, all have to be known.
    known = (agrees >= 0).all(axis=0) | (agrees == 0).any(axis=0)
    right, grid = (agrees == 1).all(axis=0), found["a"].values
    share = known_share(
        right, known, loose_share, f"the laws could not be compared for two blocks {at_values(grid, ~known)}"
    )
    measured = [Measured("share of a at which the laws agree from all states", share)]
    measured.append(Measured("share of states and a at which they agree", float((agrees == 1)[agrees >= 0].mean())))
    wrong = grid[known & ~right]
    if len(wrong):
        measured += [
            Measured("least a at which they disagree", wrong[0]),
            Measured("largest a at which they disagree", wrong[-1]),
        ]
    by_distance = (same_kind == 1) & (agrees >= 0) & np.isfinite(margin)
    if by_distance.any():
        nearest = float(np.abs(margin[by_distance]).min())
        measured.append(Measured("least distance of Δ⟨J⟩ from the tolerance where it decides, in errors", nearest))
    states = found.sizes["state"]
    reason = f"From all {states} sampled states the laws agree at {100 * share:.1f} % of the values of a with {a}."
    changes = [f"they disagree {at_values(grid, known & ~right)}"] if len(wrong) else []
    if not known.all():
        changes.append(f"it is not known {at_values(grid, ~known)}")
    return Verdict(by_share(share, loose_share), reason, measured, "; ".join(changes))


def solutions_agree(
    evidence: Evidence, initial: Sequence[str], a: Range, relative: float, loose_share: float
) -> Verdict:
    """Judge whether the map, the numerical solution of the linearized law, and that of the nonlinear law agree.

    Solvers of one law agree at a point if their ⟨J⟩ differ from that of the study's own solver by no more than the
    share `relative`, three standard errors, or the threshold of synchronization. The laws agree there if both lead to
    synchrony, or both to other regular motion, or both to chaos: the paper's results are these.
    loose_share : share of points from which on the claim holds loosely
    """
    solved: dict[tuple[str, float], bool] = {}
    compared, measured, apart = [], [], []
    for state in initial:
        runs = evidence.of_state("lyapunov", state)
        solvers = evidence.choose(evidence.summary("solvers").sel(initial=state), a, least=1)
        threshold = evidence.summary("agreement").attrs["synchronization_threshold"]
        for value in solvers["a"].values:
            found = solvers.sel(a=value)
            mean, difference, error = (
                found[name].values for name in ("mean_distance", "difference", "difference_error")
            )
            there = np.isfinite(difference)
            # A solver that a law does not have is none that failed.
            if (found["status"].values > Status.COMPLETED).any() or (there.sum(axis=-1) < 2).all():
                continue
            allowed = np.maximum.reduce(
                [relative * np.abs(mean), 3.0 * np.nan_to_num(error), np.full_like(mean, threshold)]
            )
            within = bool((np.abs(difference) <= allowed)[there].all())
            kinds = evidence.at(runs, value)["kind"].values
            if np.isnan(kinds).any() or (kinds == MotionKind.UNDETERMINED).any():
                continue
            laws = bool(same_result(kinds, kinds[0]).all())
            solved[state, value] = within
            compared.append(laws)
            largest = float(np.abs(difference[there]).max())
            measured.append(Measured(f"largest |Δ⟨J⟩| between solvers, {state}, a = {value:g}", largest))
            if not (within and laws):
                what = "the laws" if within else "the solvers" if laws else "solvers and laws"
                apart.append(f"{what} differ at a = {value:g} ({state})")
    if not solved:
        raise NotTestableError("there is no point at which all solvers completed and the kinds of motion are known")

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        """Judge as if the solvers agreed at the same points under every convention."""
        right = []
        for (state, value), within in solved.items():
            at = [kinds_reached(attractors.sel(a=[value]), state, law) for law in PAPER_LAWS]
            if all(known.all() for known, _ in at):
                (_, one), (_, other) = at
                right.append(within and bool(same_result(one, other).all()))
        return (by_share(float(np.mean(right)), loose_share), f"{sum(right)} of {len(right)}") if right else ("", "")

    share = float(np.mean(np.logical_and(list(solved.values()), compared)))
    reason = (
        f"The solvers of each law agree on ⟨J⟩ at {sum(solved.values())} of {len(solved)} points (states and a), and "
        f"the laws have the same result, synchrony, other regular motion or chaos, at {sum(compared)} of them."
    )
    return under_conventions(evidence, by_share(share, loose_share), reason, measured, apart, labels)


def linearization_justified(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, tolerance: float, loose: float
) -> Verdict:
    """Judge by how much the laws of friction differ at the fastest slips of the runs, as a share of static friction.

    law : the linearized one, whose friction is 1 − aU' and tells the speed; tolerance, loose : shares allowed
    The laws differ by (aU')²/(1 + aU'): what counts is aU', the slip speeds being some multiple of the driver's, so av.
    """
    fastest, where = 0.0, 0.0
    speeds: list[float] = []
    for state in initial:
        runs = evidence.choose(evidence.of_state("mean_distance", state), a).sel(law=law)
        product = 1.0 - runs["least_friction"].values
        known = np.isfinite(product)
        if not known.any():
            raise NotTestableError(f"no run from {state} completed with {a}")
        speeds += (product[known] / (runs["a"].values[known] * evidence.config["v"])).tolist()
        if np.nanmax(product) > fastest:
            fastest, where = float(np.nanmax(product)), float(runs["a"].values[np.nanargmax(product)])
    difference = fastest**2 / (1.0 + fastest)
    measured = [
        Measured("largest difference of the laws on a slipping block", difference),
        Measured("largest aU'", fastest),
        Measured("fastest slip over v, least", min(speeds)),
        Measured("fastest slip over v, most", max(speeds)),
    ]
    verdict = HOLDS if difference <= tolerance else LOOSELY if difference <= loose else FAILS
    reason = (
        f"With {a} the laws differ by at most {difference:.3f} of the static friction on a slipping block (at a = "
        f"{where:g}). What counts is not a but aU': slips are {min(speeds):.0f} to {max(speeds):.0f} times as fast as "
        "the driver, so av."
    )
    return Verdict(verdict, reason, measured)


def map_is_cheaper(evidence: Evidence, steps: float, much: float, loose: float) -> Verdict:
    """Judge whether the map needs far fewer steps in a unit of time than stepping at a fixed step.

    steps : the paper's time steps in a unit of time
    much, loose : the claim holds if they are this many times the steps of the map, loosely if that many; it holds
        loosely as well if other solutions of the differential equations take fewer than so many times the steps
    A step of the map is a solution between two events or part of one; it costs some tens of Runge-Kutta steps.
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
    ratio = steps / float(own.max())
    measured = [
        Measured("steps of the map in a unit of time, most", float(own.max())),
        Measured("times fewer than the paper's steps", ratio),
    ]
    # What else solves the linearized equations: by steps as long as each is accurate with, not the paper's.
    taken = {
        name: float(np.nanmax(rate.sel(solver=name)))
        for name in ("series", "rk4")
        if name in found["solver"].values and np.isfinite(rate.sel(solver=name)).any()
    }
    measured += [Measured(f"steps of {name} in a unit of time, most", number) for name, number in taken.items()]
    if "rk4" in taken:
        error = np.abs(found["difference"].sel(solver="rk4").values)
        measured.append(Measured("largest |Δ⟨J⟩| of rk4 at that step", float(np.nanmax(error))))

    def judged(times: float) -> str:
        return HOLDS if times >= much else LOOSELY if times >= loose else FAILS

    others = {name: number / float(own.max()) for name, number in taken.items()}
    changes = [
        f"against {name}, with {taken[name]:.4g} steps in a unit of time: {judged(times)} ({times:.4g} times as many)"
        for name, times in others.items()
        if judged(times) != judged(ratio)
    ]
    verdict = LOOSELY if judged(ratio) == HOLDS and changes else judged(ratio)
    reason = (
        f"The map takes at most {own.max():.2f} steps in a unit of time, the paper's stepping {steps:,.0f}: "
        f"about {float(f'{ratio:.1g}'):,.0f} times as many."
    )
    return Verdict(verdict, reason, measured, "; ".join(changes))
