"""The claim that frequency locking precedes chaos, from the edges of the branches of attractors."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import Measured, NotTestableError, Verdict, by_share, worst
from burridge_knopoff.orbits.edge_kind import EdgeKind
from burridge_knopoff.stability.motion import REGULAR, MotionKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.branch_changes import Change

if TYPE_CHECKING:
    import xarray


def locking_precedes_chaos(evidence: Evidence, loose_share: float) -> Verdict:
    """Judge whether branches of attractors, as a grows, become chaotic where a locked orbit ends, under both laws.

    A locked orbit is a closed one: the blocks stop in a ratio of whole numbers. A torus is not locked. What a branch is
    like before it turns chaotic is taken at the value of a next below. Chaos that was there before is no beginning of
    chaos, whether it died or a branch ended on it, nor is an edge that a branch passes without a change.

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
        before, after = edges["motion_before"].values, edges["motion_after"].values
        changes = own & (edges["change"].values != Change.PASSED) & (after == MotionKind.CHAOTIC)
        changes &= ~_chaotic_before(edges, evidence.summary("refined").sel(law=name))
        onset = changes & np.isin(before, (MotionKind.SYNCHRONIZED, *REGULAR))
        unknown = changes & (before == MotionKind.UNDETERMINED)
        places = {
            (float(edges["grid_low"].values[k]), int(edges["to_branch"].values[k])): int(before[k])
            for k in np.flatnonzero(onset)
        }
        if not places:
            raise NotTestableError(f"no branch of attractors becomes chaotic under the {name} law")
        locked = [kind != MotionKind.QUASIPERIODIC for kind in places.values()]
        share = float(np.mean(locked))
        verdicts.append(by_share(share, loose_share))
        texts.append(f"{sum(locked)} of {len(locked)} ({name})")
        measured.append(Measured(f"share of the beginnings of chaos at which a locked orbit ends, {name}", share))
        ends = Counter(int(edges["kind"].values[k]) for k in np.flatnonzero(onset))
        for kind, count in sorted(ends.items()):
            measured.append(Measured(f"edges there that are a {EdgeKind(kind).name.lower()}, {name}", count))
        if unknown.any():
            values = np.unique(edges["a"].values[unknown])
            others.append(f"what comes before is not known at a = {', '.join(f'{a:.5g}' for a in values)} ({name})")
        torus = sorted(place for (place, _), right in zip(places, locked, strict=True) if not right)
        if torus:
            others.append(f"a torus before chaos above a = {', '.join(f'{value:g}' for value in torus)} ({name})")
    reason = (
        f"Where a branch of attractors becomes chaotic as a grows, a locked orbit comes before: {', '.join(texts)}."
    )
    return Verdict(worst(verdicts), reason, measured, "; ".join(others))


def _chaotic_before(edges: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Tell, for each edge, whether a branch ends there on another one that was chaotic already, shape (edge,)."""
    a, kind = refined["a"].values, refined["kind"].values
    result = np.zeros(edges.sizes["edge"], dtype=bool)
    for k in np.flatnonzero(edges["change"].values == Change.END):
        there = refined["branch"].values == edges["to_branch"].values[k]
        below = np.flatnonzero(there.any(axis=1) & (a <= edges["grid_low"].values[k]))
        result[k] = len(below) > 0 and bool((kind[below[-1]][there[below[-1]]] == MotionKind.CHAOTIC).any())
    return result
