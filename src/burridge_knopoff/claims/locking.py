"""Claims on frequency locking: of the end blocks with each other, and of a branch of attractors before chaos."""

from __future__ import annotations

from collections import Counter
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import judge_shares
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Range,
    Verdict,
    at_values,
    by_share,
    known_share,
    share_is_decided,
    worst,
)
from burridge_knopoff.orbits.edge_kind import EdgeKind
from burridge_knopoff.stability.motion import REGULAR, MotionKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.branch_changes import Change

if TYPE_CHECKING:
    import xarray

TORUS = "a torus, or chaos too weak to tell from one,"
UNFOLLOWED = "a closed orbit too long to be followed, or a torus beside it,"


def end_blocks_locked(evidence: Evidence, initial: Sequence[str], a: Range, loose_share: float) -> Verdict:
    """Judge whether the end blocks oscillate at one frequency, within the errors, in the runs of both laws.

    The frequency of a block is that of the highest peak of the spectrum of its velocity; its error is half of what the
    spectrum resolves. Numbers of stops are told as well: blocks that share a frequency need not stop equally often.
    """
    shares, measured, apart, others = {}, [], [], []
    for state in initial:
        whole = evidence.of_state("stick_slip", state)
        runs = evidence.choose(whole, a)
        for law in PAPER_LAWS:
            same, known = _same_frequency(runs.sel(law=law))
            where = at_values(runs["a"].values, ~known)
            unknown = f"no frequency of the end blocks is known from {state} under the {law} law {where}"
            name = f"{law}, {state}"
            shares[name] = known_share(same, known, loose_share, unknown)
            measured.append(Measured(f"share of a at which the end blocks have one frequency, {name}", shares[name]))
            stops = runs["stop_rate"].sel(law=law).values[known]
            with np.errstate(divide="ignore", invalid="ignore"):
                difference = np.abs(stops[:, 0] / stops[:, -1] - 1.0)
            measured.append(Measured(f"largest difference of their numbers of stops, {name}", float(difference.max())))
            elsewhere = whole.sel(law=law).isel(a=~a.choose(whole["a"].values) & (whole["a"].values > 0.0))
            there, seen = _same_frequency(elsewhere)
            if seen.any():
                others.append(bool(there[seen].all()))
                measured.append(Measured(f"share of all other a at which they have, {name}", float(there[seen].mean())))
            if shares[name] < 1.0:
                apart.append(f"two frequencies {at_values(runs['a'].values, known & ~same)} ({name})")
            if not known.all():
                apart.append(f"not known {where} ({name})")
    verdict, text = judge_shares(shares, loose_share)
    reason = f"With {a} both end blocks have one leading frequency, within its error, at {text} of the values of a."
    if others and all(others):
        reason += " They have one at all others as well."
    return Verdict(verdict, reason, measured, "; ".join(apart))


def _same_frequency(runs: xarray.Dataset) -> tuple[np.ndarray, np.ndarray]:
    """Return where the end blocks have one frequency, and where both are known, shape (a,)."""
    frequency, error = (runs[name].values[:, [0, -1]] for name in ("velocity_frequency", "velocity_frequency_error"))
    known = np.isfinite(frequency).all(axis=1)
    with np.errstate(invalid="ignore"):
        return known & (np.abs(np.diff(frequency)[:, 0]) <= np.hypot(*error.T)), known


def locking_precedes_chaos(evidence: Evidence, loose_share: float) -> Verdict:
    """Judge whether a closed orbit, not a torus, precedes chaos where a branch of attractors turns chaotic as a grows.

    On a closed orbit the blocks stop in a ratio of whole numbers: they are locked. On a torus they are not. What a
    branch is like before it turns chaotic is taken at the value of a next below. Chaos that was there before is no
    beginning of chaos, whether it died or a branch ended on it, nor is an edge that a branch passes without a change. A
    torus may be chaos that is weaker than the search resolves, or lock between the values of a, which the verdict says.
    A closed orbit that is too long to be followed to the edge, as in a tongue of a torus, is counted as one as well:
    another value of a may show the torus.

    loose_share : share of the beginnings of chaos from which on the claim holds loosely
    """
    evidence.check_blocks()
    edges = evidence.summary("edges")
    laws = edges.attrs["laws"].split()
    verdicts, measured, texts, others = [], [], [], []
    for name in PAPER_LAWS:
        if name not in laws:
            raise NotTestableError(f"the study has no {name} law")
        own = edges["law"].values == laws.index(name)
        before, after, kinds = (edges[key].values for key in ("motion_before", "motion_after", "kind"))
        changes = own & (edges["change"].values != Change.PASSED) & (after == MotionKind.CHAOTIC)
        changes &= ~_chaotic_before(edges, evidence.summary("refined").sel(law=name))
        onset = changes & np.isin(before, (MotionKind.SYNCHRONIZED, *REGULAR))
        unknown = changes & (before == MotionKind.UNDETERMINED)
        places = {
            (float(edges["grid_low"].values[k]), int(edges["to_branch"].values[k])): _doubt(before[k], kinds[k])
            for k in np.flatnonzero(onset)
        }
        if not places:
            raise NotTestableError(f"no branch of attractors becomes chaotic under the {name} law")
        count = Counter(places.values())
        share = count[""] / len(places)
        if not share_is_decided(count[""], len(places) - count[TORUS], len(places), loose_share):
            raise NotTestableError(
                f"before chaos there is {UNFOLLOWED} at {count[UNFOLLOWED]} of {len(places)} places ({name})"
            )
        verdicts.append(by_share(share, loose_share))
        texts.append(f"{count['']} of {len(places)} ({name})")
        measured.append(Measured(f"share of the beginnings of chaos at which a closed orbit ends, {name}", share))
        ends = Counter(int(edges["kind"].values[k]) for k in np.flatnonzero(onset))
        for kind, often in sorted(ends.items()):
            measured.append(Measured(f"edges there, {EdgeKind(kind).name.lower()}, {name}", often))
        if unknown.any():
            values = np.unique(edges["a"].values[unknown])
            others.append(f"what comes before is not known at a = {', '.join(f'{a:.5g}' for a in values)} ({name})")
        for doubt in (TORUS, UNFOLLOWED):
            if there := sorted(place for (place, _), one in places.items() if one == doubt):
                others.append(f"{doubt} before chaos above a = {', '.join(f'{a:g}' for a in there)} ({name})")
    reason = (
        "Where a branch of attractors becomes chaotic as a grows, a closed orbit comes before, not a torus: "
        f"{', '.join(texts)}."
    )
    return Verdict(worst(verdicts), reason, measured, "; ".join(others))


def _doubt(before: int, edge: int) -> str:
    """Return what may precede chaos at an edge in place of a closed orbit; nothing where one does."""
    if before == MotionKind.QUASIPERIODIC:
        return TORUS
    return UNFOLLOWED if edge == EdgeKind.UNDETERMINED else ""


def _chaotic_before(edges: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Tell, for each edge, whether a branch ends there on another one that was chaotic already, shape (edge,)."""
    a, kind = refined["a"].values, refined["kind"].values
    result = np.zeros(edges.sizes["edge"], dtype=bool)
    for k in np.flatnonzero(edges["change"].values == Change.END):
        there = refined["branch"].values == edges["to_branch"].values[k]
        below = np.flatnonzero(there.any(axis=1) & (a <= edges["grid_low"].values[k]))
        result[k] = len(below) > 0 and bool((kind[below[-1]][there[below[-1]]] == MotionKind.CHAOTIC).any())
    return result
