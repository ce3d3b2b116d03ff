"""Claims on the two friction laws and the solvers: agreement and cost."""

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
    """Judge whether both laws lead to the same ⟨J⟩ at all a of a range, within the study's tolerance of agreement."""
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

    A torus and an unsynchronized closed orbit count as one kind, see `judgement.compare`.
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
    """Return the verdict of a claim that the laws agree; answers : {initial state: (a, an Answer for each)}."""
    shares, numbers, apart = {}, [], []
    for state, (grid, same) in answers.items():
        known = same != Answer.UNDETERMINED
        unknown = f"the laws could not be compared from {state} {at_values(grid, ~known)}"
        shares[state] = known_share(same == Answer.YES, known, loose_share, unknown)
        numbers.append(Measured(f"share of a at which the laws agree {what}, {state}", shares[state]))
        differ = same == Answer.NO
        if differ.any():
            numbers.append(Measured(f"smallest a at which they differ, {state}", float(grid[differ][0])))
            apart.append(f"they differ {at_values(grid, differ)} ({state})")
        if not known.all():
            apart.append(f"unknown {at_values(grid, ~known)} ({state})")
    verdict, text = judge_shares(shares, loose_share)
    reason = f"The laws agree {what} at {text} of the values of a with {a}."
    return Verdict(verdict, reason, [*numbers, *measured], "; ".join(apart))


def solutions_agree(
    evidence: Evidence, initial: Sequence[str], a: Range, relative: float, loose_share: float
) -> Verdict:
    """Judge whether the map, the numerical solution of the linearized law, and that of the nonlinear law agree.

    Solvers of one law agree at a point if their ⟨J⟩ differs from that of the study's solver by no more than the
    fraction `relative`, three standard errors, or the threshold of synchronization. The laws agree at a point if both
    lead to synchrony, both to other regular motion, or both to chaos, which are the paper's results.
    loose_share : fraction of points from which the claim holds loosely
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
            # A solver that cannot do a law has not failed.
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
    """Judge the difference of the friction laws at the fastest slips of the runs, as a fraction of the static friction.

    law : the linearized law, whose friction 1 − aU' gives the speed; tolerance, loose : allowed fractions
    part : part of the runs: window, or run with its transient
    The laws differ by (aU')²/(1 + aU').
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, part)
    product = grid * evidence.config["v"] * speed
    top = int(np.argmax(product))
    difference = float(product[top] ** 2 / (1.0 + product[top]))
    measured = [
        Measured("largest difference of the laws on a slipping block", difference),
        Measured("largest aU'", float(product[top])),
        Measured("smallest ratio of the fastest slip to v", float(speed.min())),
        Measured("largest ratio of the fastest slip to v", float(speed.max())),
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
    """Judge whether stronger springs or larger masses bring the laws closer together, for the same driver.

    claimed : power of a with which the difference falls: (aU')² would fall as the square of a if U' did not change

    Stronger springs decrease a and increase v, but av = cV stays, where V is the velocity of the driver and
    F(0)/(1 + cV) the friction. At one a, linearized motion is proportional to v. Hence aU' is proportional to cV, times
    the ratio of slip speed to v, which is a function of a alone, known from the windows of the runs.
    """
    grid, speed = _fastest_slips(evidence, initial, law, a, "window")
    power = float(np.polyfit(np.log(grid), 2.0 * np.log(speed), 1)[0])
    least, largest = int(np.argmin(grid)), int(np.argmax(grid))
    ratio = float((speed[least] / speed[largest]) ** 2)
    measured = [
        Measured("power of a with which the difference of the laws falls at fixed V", power),
        Measured(f"remaining fraction of it from a = {grid[largest]:g} to {grid[least]:g}", ratio),
    ]
    reason = (
        f"At a fixed V stronger springs or larger masses change a, but not av = cV. From a = {grid[largest]:g} down to "
        f"{grid[least]:g} the difference of the laws on a slipping block only falls to {100 * ratio:.0f} %, as "
        f"a^{power:.2f}; the claim says a^{claimed:g}."
    )
    return Verdict(by_value(power, claimed, tolerance, loose), reason, measured)


def _fastest_slips(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, part: str
) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, fastest slip divided by v) of all completed runs, from their least friction 1 − aU'."""
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
    """Judge whether the map needs far fewer steps per unit time than integration with a fixed step.

    steps : the paper's time steps per unit time
    much, loose : ratio of these to the steps of the map from which the claim holds, and from which it holds loosely. It
        also holds only loosely if other solvers of the differential equations need fewer than `much` times its steps
    A step of the map is a solution between two events, or part of one; it costs some tens of Runge-Kutta steps.
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
        Measured("largest number of steps of the map per unit time", float(own.max())),
        Measured("ratio of the paper's steps to these", ratio),
    ]
    # Other solvers of the linearized equations, with the steps that their accuracy requires rather than the paper's.
    taken = {
        name: float(np.nanmax(rate.sel(solver=name)))
        for name in ("series", "rk4")
        if name in found["solver"].values and np.isfinite(rate.sel(solver=name)).any()
    }
    measured += [Measured(f"largest number of steps of {name} per unit time", number) for name, number in taken.items()]
    if "rk4" in taken:
        error = np.abs(found["difference"].sel(solver="rk4").values)
        measured.append(Measured("largest |Δ⟨J⟩| of rk4 at that step", float(np.nanmax(error))))

    def judged(times: float) -> str:
        return HOLDS if times >= much else LOOSELY if times >= loose else FAILS

    others = {name: number / float(own.max()) for name, number in taken.items()}
    changes = [
        f"compared with {name}, which takes {taken[name]:.4g} steps per unit time: {judged(times)} ({_more(times)})"
        for name, times in others.items()
        if judged(times) != judged(ratio)
    ]
    verdict = LOOSELY if judged(ratio) == HOLDS and changes else judged(ratio)
    reason = (
        f"The map takes at most {own.max():.2f} steps per unit time, the paper's time stepping {steps:,.0f}, "
        f"about {float(f'{ratio:.1g}'):,.0f} times as many."
    )
    return Verdict(verdict, reason, measured, "; ".join(changes))


def _more(times: float) -> str:
    """Describe a ratio of steps: «no more steps», «20 times as many»."""
    return f"{times:.4g} times as many" if f"{times:.4g}" != "1" else "no more steps"
