"""Claims on the kind of motion: periodic, quasiperiodic or chaotic, and what the section W = 0 shows of it."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_shares, reached, under_conventions
from burridge_knopoff.claims.evidence import PAPER_LAWS, Evidence
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    Measured,
    NotTestableError,
    Range,
    Verdict,
    by_share,
    by_value,
    spans,
    worst,
)
from burridge_knopoff.stability.motion import CHAOTIC, KINDS, PERIODIC, QUASIPERIODIC, SYNCHRONIZED, UNDETERMINED

if TYPE_CHECKING:
    import xarray


def _kinds(evidence: Evidence, initial: str, law: str, a: Range) -> tuple[np.ndarray, np.ndarray]:
    """Return (a, kind of motion) of the runs from a state whose kind is known."""
    runs = evidence.choose(evidence.of_state("lyapunov", initial), a).sel(law=law)
    kind = np.nan_to_num(runs["kind"].values, nan=UNDETERMINED).astype(int)
    return runs["a"].values, kind


def all_of_kind(evidence: Evidence, initial: Sequence[str], kinds: Sequence[str], a: Range, loose: float) -> Verdict:
    """Judge whether all runs from some states and under both laws have one of some kinds of motion in a range of a.

    kinds : meanings of `kind`: synchronized, periodic, quasiperiodic, chaotic
    """
    allowed = [number for number, name in KINDS.items() if name in kinds]
    what = " or ".join(kinds)
    shares, measured, exceptions = {}, [], []
    for law in PAPER_LAWS:
        for state in initial:
            grid, kind = _kinds(evidence, state, law, a)
            known = kind != UNDETERMINED
            if not known.any():
                raise NotTestableError(f"no kind of motion is known from {state} under the {law} law with {a}")
            right = np.isin(kind, allowed)
            name = f"{law}, {state}"
            shares[name] = float(right[known].mean())
            measured.append(Measured(f"share of a with {what} motion, {name}", shares[name]))
            if not right[known].all():
                exceptions.append(f"other motion at a = {spans(grid, known & ~right)} ({name})")
    if "attractors" in evidence.summaries:
        attractors = evidence.choose(evidence.summary("attractors"), a)
        known = (attractors["branch"] >= 0).values & (attractors["kind"].values != UNDETERMINED)
        if known.any():
            share = float(np.isin(attractors["kind"].values, allowed)[known].mean())
            measured.append(Measured(f"share of all attractors with {what} motion", share))

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        found = {}
        for law in PAPER_LAWS:
            for state in initial:
                known, kind = reached(evidence.choose(attractors, a), state, law, "kind")
                known &= kind != UNDETERMINED
                if known.any():
                    found[f"{law}, {state}"] = float(np.isin(kind, allowed)[known].mean())
        return judge_shares(found, loose)

    own, text = judge_shares(shares, loose)
    reason = f"The motion is {what} at {text} of the values of a with {a}."
    return under_conventions(evidence, own, reason, measured, exceptions, labels)


def periodic_is_synchronized(evidence: Evidence, initial: Sequence[str], a: Range, loose: float) -> Verdict:
    """Judge whether, in a range of a, runs without synchrony are never periodic: periodic means synchronized."""
    shares, measured, exceptions = {}, [], []
    for law in PAPER_LAWS:
        for state in initial:
            grid, kind = _kinds(evidence, state, law, a)
            periodic = np.isin(kind, (SYNCHRONIZED, PERIODIC))
            if not periodic.any():
                continue
            name = f"{law}, {state}"
            shares[name] = float((kind == SYNCHRONIZED)[periodic].mean())
            measured.append(Measured(f"share of periodic runs that are synchronized, {name}", shares[name]))
            if shares[name] < 1.0:
                exceptions.append(f"periodic without synchrony at a = {spans(grid, kind == PERIODIC)} ({name})")
    if not shares:
        raise NotTestableError(f"no run is periodic with {a}")
    verdict, text = judge_shares(shares, loose)
    reason = f"Of the periodic runs with {a} these are synchronized: {text}."
    return Verdict(verdict, reason, measured, "; ".join(exceptions))


def onset_of_chaos(
    evidence: Evidence, initial: Sequence[str], claimed: float, tolerance: float, loose: float
) -> Verdict:
    """Judge the a from which on runs are chaotic, under both laws; a_c, where synchrony is lost, stands beside it.

    The onset lies between the least a with a chaotic run and the value of the grid before it: that is its error.
    """
    verdicts, measured, texts, windows = [], [], [], []
    for law in PAPER_LAWS:
        for state in initial:
            grid, kind = _kinds(evidence, state, law, Range())
            chaotic = kind == CHAOTIC
            if not chaotic.any():
                verdicts.append(FAILS)
                texts.append(f"none ({law}, {state})")
                continue
            first = int(np.argmax(chaotic))
            low = grid[first - 1] if first else grid[first]
            onset, error = 0.5 * (low + grid[first]), 0.5 * (grid[first] - low)
            verdicts.append(by_value(onset, claimed, tolerance, loose, error))
            measured.append(Measured(f"least a with chaos, {law}, {state}", float(onset), float(error)))
            texts.append(f"{grid[first]:g} ({law}, {state})")
            windows.append(f"chaos at a = {spans(grid, chaotic)} ({law}, {state})")
    if "orbits" in evidence.summaries:
        orbits = evidence.summary("orbits")
        for law in PAPER_LAWS:
            critical, error = (orbits[name].sel(law=law).item() for name in ("critical_a", "critical_a_error"))
            if np.isfinite(critical):
                measured.append(Measured(f"a at which synchrony loses stability, {law}", critical, error))
    reason = f"Chaos is first seen at a = {', '.join(texts)}, against {claimed:g}."
    return Verdict(worst(verdicts), reason, measured, "; ".join(windows))


def largest_exponent_is_zero(evidence: Evidence, initial: str, law: str, a: Range, loose: float) -> Verdict:
    """Judge whether the largest Lyapunov exponent cannot be told from 0 at all a of a range.

    By the study's own thresholds: `motion.zero_exponent` and `motion.standard_errors`.
    """
    runs = evidence.choose(evidence.of_state("lyapunov", initial), a).sel(law=law)
    if not runs.sizes.get("exponent"):
        raise NotTestableError("the study computes no Lyapunov exponents")
    exponent, error = (runs[name].values[:, 0] for name in ("lyapunov_exponent", "lyapunov_error"))
    known = np.isfinite(exponent) & np.isfinite(error)
    if not known.any():
        raise NotTestableError(f"no Lyapunov exponent of a run from {initial} is known with {a}")
    motion = evidence.config["motion"]
    zero = np.abs(exponent) <= np.maximum(motion["zero_exponent"], motion["standard_errors"] * error)
    share = float(zero[known].mean())
    largest = int(np.nanargmax(np.where(known, np.abs(exponent), np.nan)))
    measured = [
        Measured("share of a at which it cannot be told from 0", share),
        Measured(f"largest in modulus, at a = {runs['a'].values[largest]:g}", exponent[largest], error[largest]),
    ]
    reason = (
        f"The largest exponent from {initial} ({law}) cannot be told from 0 at {100 * share:.1f} % of the values of a "
        f"with {a}."
    )
    changes = f"not 0 at a = {spans(runs['a'].values, known & ~zero)}" if share < 1.0 else ""
    return Verdict(by_share(share, loose), reason, measured, changes)


def aperiodic(evidence: Evidence, initial: str, at: float) -> Verdict:
    """Judge whether the motion from a state at one a is aperiodic, under both laws."""
    verdicts, measured, texts, elsewhere = [], [], [], []
    runs = evidence.of_state("lyapunov", initial)
    for law in PAPER_LAWS:
        run = evidence.at(runs, at).sel(law=law)
        kind = UNDETERMINED if np.isnan(run["kind"].item()) else int(run["kind"].item())
        if kind == UNDETERMINED:
            raise NotTestableError(f"the kind of motion from {initial} at a = {at:g} under the {law} law is not known")
        verdicts.append(HOLDS if kind in (QUASIPERIODIC, CHAOTIC) else FAILS)
        period = int(run["section_period"].item())
        measured.append(Measured(f"section points in a period, 0 if there is none, {law}", float(period)))
        if run.sizes.get("exponent", 0) > 1:
            exponent, error = (run[name].values[1] for name in ("lyapunov_exponent", "lyapunov_error"))
            measured.append(Measured(f"second exponent, {law}", float(exponent), float(error)))
        texts.append(f"{KINDS[kind]}{f' with {period} section points' if period else ''} ({law})")
        others = np.isin(runs["kind"].sel(law=law).values, (QUASIPERIODIC, CHAOTIC))
        if others.any():
            elsewhere.append(f"aperiodic at a = {spans(runs['a'].values, others)} ({law})")

    def labels(attractors: xarray.Dataset) -> tuple[str, str]:
        found = {}
        for law in PAPER_LAWS:
            known, kind = reached(attractors.sel(a=[at]), initial, law, "kind")
            if known[0] and kind[0] != UNDETERMINED:
                found[law] = int(kind[0])
        if not found:
            return "", ""
        verdict = worst(HOLDS if kind in (QUASIPERIODIC, CHAOTIC) else FAILS for kind in found.values())
        return verdict, ", ".join(f"{KINDS[kind]} {law}" for law, kind in found.items())

    reason = f"The motion from {initial} at a = {at:g} is {' and '.join(texts)}."
    return under_conventions(evidence, worst(verdicts), reason, measured, elsewhere, labels)


def one_section_point(evidence: Evidence, initial: str, law: str, a: Range, loose: float) -> Verdict:
    """Judge whether the section W = 0, crossed upward, shows one point at each a of a range."""
    runs = evidence.choose(evidence.of_state("lyapunov", initial), a).sel(law=law)
    period = runs["section_period"].values
    known = np.isfinite(period)
    if not known.any():
        raise NotTestableError(f"no run from {initial} completed with {a}")
    one = period == 1
    share = float(one[known].mean())
    measured = [Measured("share of a with one section point", share)]
    reason = (
        f"The section of runs from {initial} ({law}) is one point at {100 * share:.1f} % of the values of a with {a}."
    )
    changes = f"more than one at a = {spans(runs['a'].values, known & ~one)}" if share < 1.0 else ""
    return Verdict(by_share(share, loose), reason, measured, changes)


def cloud_at_lower_velocities(
    evidence: Evidence, initial: Sequence[str], law: str, a: Range, points: int, loose: float
) -> Verdict:
    """Judge whether one state has a cloud of section points where the other has one, and at lower velocities W'.

    initial : the state with one point, the state with the cloud
    points : a section of more points than these is a cloud
    The cloud is lower where its mean W', crossed upward, is below that of the other state.
    """
    from burridge_knopoff.summaries.bifurcation import section_points

    for name in initial:
        evidence.check_state(name)
    bifurcation = evidence.summary("bifurcation")
    line, cloud = (section_points(bifurcation, law, name, 1) for name in initial)
    grid = np.unique(np.concatenate([line[0], cloud[0]]))
    grid = grid[a.choose(grid)]
    if not len(grid):
        raise NotTestableError(f"no run crosses the section with {a}")
    chosen = [[velocity[value == one] for value, velocity in (line, cloud)] for one in grid]
    both = np.array([bool(len(one) and len(other)) for one, other in chosen])
    many = np.array([_distinct(other) > points for _, other in chosen])
    lower = np.array([len(one) and len(other) and other.mean() < one.mean() for one, other in chosen], dtype=bool)
    # In a ragged array runs that crossed nothing, or did not complete, leave no points.
    share = float((many & lower)[both].mean()) if both.any() else 0.0
    entirely = np.array([len(one) and len(other) and other.max() < one.min() for one, other in chosen], dtype=bool)
    measured = [
        Measured(f"share of a with more than {points} section points from {initial[1]}", float(many[both].mean())),
        Measured("share of a with their mean W' below that of " + initial[0], float(lower[both].mean())),
        Measured("share of a with all of them below it", float(entirely[both].mean())),
    ]
    reason = (
        f"From {initial[1]} ({law}) the section is a cloud at lower velocities than from {initial[0]} at "
        f"{100 * share:.1f} % of the values of a with {a}."
    )
    changes = f"no cloud, or none lower, at a = {spans(grid, both & ~(many & lower))}" if share < 1.0 else ""
    return Verdict(by_share(share, loose), reason, measured, changes)


def _distinct(velocity: np.ndarray, tolerance: float = 1e-6) -> int:
    """Return how many section points differ by more than a tolerance, in the second half of a run."""
    settled = np.sort(velocity[len(velocity) // 2 :])
    return int(np.count_nonzero(np.diff(settled) > tolerance)) + 1 if len(settled) else 0
