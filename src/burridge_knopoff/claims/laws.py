"""Claims on the two friction laws and the ways to solve them: whether they agree, and what they cost."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
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
    by_value,
    known_share,
)
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import MotionKind, same_result
from burridge_knopoff.running.status import Status
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.judgement import same_mean

if TYPE_CHECKING:
    import xarray


def laws_agree(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to the same ⟨J⟩ at all a of a range, by the study's tolerance of agreement."""
    measured, answers = [], {}
    for state in initial:
        found = _compared(evidence, state, a)
        about = found.attrs
        same = same_mean(
            {name: found[name].values for name in ("mean_distance", "kind", "difference", "difference_error")},
            about["synchronization_threshold"],
            about,
        )
        answers[state] = found["a"].values, same
        difference = np.abs(found["difference"].values[same == Answer.YES])
        if np.isfinite(difference).any():
            measured.append(Measured(f"largest |Δ⟨J⟩| where they agree, {state}", float(np.nanmax(difference))))
    return _by_answers(answers, "in ⟨J⟩", measured, a, loose_share)


def laws_agree_in_kind(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to the same kind of motion at all a of a range.

    A torus and a closed orbit without synchrony are one kind, see `judgement.compare`.
    """
    found = {state: _compared(evidence, state, a) for state in initial}
    answers = {state: (one["a"].values, one["same_kind"].values) for state, one in found.items()}
    return _by_answers(answers, "in the kind of motion", [], a, loose_share)


def _compared(evidence: Evidence, state: str, a: Range) -> xarray.Dataset:
    return evidence.choose(evidence.compared(evidence.of_state("agreement", state)), a)


def _by_answers(
    answers: Mapping[str, tuple[np.ndarray, np.ndarray]],
    what: str,
    measured: Sequence[Measured],
    a: Range,
    loose_share: float,
) -> Verdict:
    """Return the verdict of a claim that the laws agree; answers : {initial state: (a, an Answer each)}."""
    shares, numbers, apart = {}, [], []
    for state, (grid, same) in answers.items():
        known = same != Answer.UNDETERMINED
        unknown = f"the laws could not be compared from {state} {at_values(grid, ~known)}"
        shares[state] = known_share(same == Answer.YES, known, loose_share, unknown)
        numbers.append(Measured(f"share of a at which the laws agree {what}, {state}", shares[state]))
        differ = same == Answer.NO
        if differ.any():
            numbers.append(Measured(f"least a at which they differ, {state}", float(grid[differ][0])))
            apart.append(f"they differ {at_values(grid, differ)} ({state})")
        if not known.all():
            apart.append(f"it is not known {at_values(grid, ~known)} ({state})")
    verdict, text = judge_shares(shares, loose_share)
    reason = f"The laws agree {what} at {text} of the values of a with {a}."
    return Verdict(verdict, reason, [*numbers, *measured], "; ".join(apart))


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
        runs = evidence.of_state("agreement", state)
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
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str, tolerance: float, loose: float
) -> Verdict:
    """Judge by how much the laws of friction differ at the fastest slips of the runs, as a share of static friction.

    law : the linearized one, whose friction is 1 − aU' and tells the speed; tolerance, loose : shares allowed
    part : of the runs, window or run, the transient included
    The laws differ by (aU')²/(1 + aU').
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, part)
    product = grid * evidence.config["v"] * speed
    top = int(np.argmax(product))
    difference = float(product[top] ** 2 / (1.0 + product[top]))
    measured = [
        Measured("largest difference of the laws on a slipping block", difference),
        Measured("largest aU'", float(product[top])),
        Measured("fastest slip over v, least", float(speed.min())),
        Measured("fastest slip over v, most", float(speed.max())),
    ]
    verdict = HOLDS if difference <= tolerance else LOOSELY if difference <= loose else FAILS
    reason = (
        f"With {a} the laws differ by at most {difference:.2g} of the static friction on a slipping block (at a = "
        f"{grid[top]:g}), since slips are {speed.min():.2f} to {speed.max():.2f} times as fast as the driver "
        f"({'in the window' if part == 'window' else 'in the whole run'})."
    )
    return Verdict(verdict, reason, measured)


def springs_help(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge whether stronger springs or larger masses bring the laws nearer to each other, the driver being the same.

    claimed : power of a with which their difference falls: (aU')² would fall with the square of a if U' did not change

    By stronger springs a falls and v grows, and av = cV stays, V being the velocity of the driver and F(0)/(1 + cV) the
    friction. Linearized motion at one a is proportional to v: so is aU' to cV, times the speed of the slips over v,
    which is a function of a alone and known from the windows of the runs.
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, "window")
    power = float(np.polyfit(np.log(grid), 2.0 * np.log(speed), 1)[0])
    least, largest = int(np.argmin(grid)), int(np.argmax(grid))
    ratio = float((speed[least] / speed[largest]) ** 2)
    measured = [
        Measured("power of a with which the difference of the laws falls at fixed V", power),
        Measured(f"what is left of it from a = {grid[largest]:g} to {grid[least]:g}", ratio),
    ]
    reason = (
        f"At a fixed V stronger springs or larger masses change a, but not av = cV. From a = {grid[largest]:g} down to "
        f"{grid[least]:g} the difference of the laws on a slipping block only falls to {100 * ratio:.0f} %, as "
        f"a^{power:.2f} against a^{claimed:g}."
    )
    return Verdict(by_value(power, claimed, tolerance, loose), reason, measured)


def _fastest_slips(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, fastest slip over v) of all runs that completed, from their least friction 1 − aU'."""
    found = []
    for state in initial:
        runs = evidence.choose(evidence.of_state("mean_distance", state), a).sel(law=law)
        friction = runs["window_least_friction" if part == "window" else "least_friction"].values
        known = np.isfinite(friction)
        if not known.any():
            raise NotTestableError(f"no run from {state} completed with {a}")
        found.append((runs["a"].values[known], 1.0 - friction[known]))
    grid, product = (np.concatenate(part) for part in zip(*found, strict=True))
    return grid, product / (grid * evidence.config["v"])


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
