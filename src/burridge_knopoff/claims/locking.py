"""Claims on frequency locking: of the unsynchronized motion, and of a branch of attractors before chaos."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.evidence import LEAST_VALUES, Evidence
from burridge_knopoff.claims.verdict import (
    Measured,
    NotTestableError,
    Range,
    Verdict,
    at_values,
    by_share,
    share_is_decided,
    worst,
)
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.model.sampling import fraction_interval
from burridge_knopoff.motion.kind import CHAOS, REGULAR, MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.plateaux import locked_share, plateaux

if TYPE_CHECKING:
    import xarray

TORUS = "quasiperiodic motion, or chaos too weak to tell from it,"
UNFOLLOWED = "a closed orbit too long to be followed, or a torus beside it,"


def branch_locked(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether the unsynchronized motion, branch 1, is locked at all a of a range, under both laws.

    The rotation number decides. The end blocks always have equal frequencies, since the motion is its own mirror image.
    The fraction of a is taken over the values of the grid; plateaux are also known between the added values. A value
    with an unknown kind of motion counts as neither.

    loose_share : fraction of a from which the claim holds loosely
    """
    evidence.check_blocks()
    rotation = evidence.summary("rotation")
    verdicts, measured, shares, where = [], [], [], []
    for law in PAPER_LAWS:
        found = rotation.sel(law=law)
        inside = a.choose(found["a"].values)
        share, low, high = locked_share(found, inside)
        known = inside & (found["in_grid"].values == 1) & (found["locked"].values >= 0)
        if known.sum() < LEAST_VALUES:
            raise NotTestableError(f"branch 1 is regular motion at fewer than {LEAST_VALUES} values of a ({law})")
        verdicts.append(by_share(share, loose_share))
        shares.append(f"{100 * share:.1f} % ({law}; 95 % Wilson interval {100 * low:.1f} to {100 * high:.1f} %)")
        number = found["rotation_number"].values[inside]
        measured += [
            Measured(f"share of a at which branch 1 is locked, {law}", share),
            Measured(f"smallest rotation number, {law}", float(np.nanmin(number))),
            Measured(f"largest rotation number, {law}", float(np.nanmax(number))),
        ]
        met = [one for one in plateaux(found.isel(value=inside)) if one.last > one.first]
        if met:
            measured.append(
                Measured(f"width in a of all plateaux that were met, {law}", sum(p.last - p.first for p in met))
            )
            widest = max(met, key=lambda one: one.last - one.first)
            where.append(
                f"the widest plateau, {widest.ratio}, reaches from a = {widest.first:.5g} to {widest.last:.5g} ({law})"
            )
        if share:
            where.append(f"locked {at_values(found['a'].values[known], found['locked'].values[known] == 1)} ({law})")
    reason = (
        f"Branch 1 is locked at {', '.join(shares)} of the values of a with {a}: its rotation number there is a "
        "ratio of whole numbers and constant in a. The equal frequencies of its end blocks show no locking: they "
        "follow from its mirror symmetry."
    )
    return Verdict(worst(verdicts), reason, measured, "; ".join(where))


def locking_precedes_chaos(evidence: Evidence, loose_share: float) -> Verdict:
    """Judge whether a closed orbit, not a torus, precedes chaos where a branch of attractors turns chaotic as a grows.

    On a closed orbit the stops of the blocks have rational ratios: they are locked. On a torus they are not. The motion
    before chaos is that of the branch at the next value of a below. An onset does not count if the chaos existed
    before, dying or taking over a branch that ends on it, nor does a bifurcation that a branch passes without a change.
    A torus may be chaos too weak for the search to resolve, or may lock between the values of a; the verdict says so. A
    closed orbit that is too long to be followed to the bifurcation, as in a locking tongue, counts as one of unknown
    kind, since another value of a may show the torus. A closer search finds more onsets, so that those of a study are a
    sample: the claim fails if the 95 % interval of the fraction lies below `loose_share`.

    loose_share : fraction of the onsets of chaos from which the claim holds loosely
    """
    evidence.check_blocks()
    bifurcations = evidence.summary("bifurcations")
    laws = bifurcations.attrs["laws"].split()
    verdicts, measured, texts, others = [], [], [], []
    for name in PAPER_LAWS:
        if name not in laws:
            raise NotTestableError(f"the study has no {name} law")
        own = bifurcations["law"].values == laws.index(name)
        before, after, kinds = (bifurcations[key].values for key in ("motion_before", "motion_after", "kind"))
        changes = own & (bifurcations["change"].values != Change.PASSED) & np.isin(after, CHAOS)
        changes &= ~_chaotic_before(bifurcations, evidence.summary("refined").sel(law=name))
        onset = changes & np.isin(before, (MotionKind.SYNCHRONIZED, *REGULAR))
        unknown = changes & (before == MotionKind.UNDETERMINED)
        places = {
            (float(bifurcations["grid_low"].values[k]), int(bifurcations["to_branch"].values[k])): _doubt(
                before[k], kinds[k]
            )
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
        possible = len(places) - count[TORUS]
        most = fraction_interval(possible, len(places))[2]
        if share < loose_share <= most:
            raise NotTestableError(
                f"a closed orbit comes before chaos at {count['']} to {possible} of {len(places)} places ({name}), and "
                f"the 95 % interval of that share reaches {most:.2f}: whether it is {loose_share:g} is not resolved "
                f"with changes along a located within {evidence.summary('refined').attrs['refine_resolution']:g}"
            )
        verdicts.append(by_share(share, loose_share))
        texts.append(f"{count['']} of {len(places)} ({name})")
        measured.append(Measured(f"share of the beginnings of chaos at which a closed orbit ends, {name}", share))
        ends = Counter(int(bifurcations["kind"].values[k]) for k in np.flatnonzero(onset))
        for kind, often in sorted(ends.items()):
            measured.append(Measured(f"bifurcations there, {BifurcationKind(kind).name.lower()}, {name}", often))
        if unknown.any():
            values = np.unique(bifurcations["a"].values[unknown])
            others.append(f"the motion before is unknown at a = {', '.join(f'{a:.5g}' for a in values)} ({name})")
        for doubt in (TORUS, UNFOLLOWED):
            if there := sorted(place for (place, _), one in places.items() if one == doubt):
                others.append(f"{doubt} before chaos above a = {', '.join(f'{a:g}' for a in there)} ({name})")
    reason = (
        "Where a branch of attractors becomes chaotic as a grows, a closed orbit precedes chaos, not a torus: "
        f"{', '.join(texts)}."
    )
    return Verdict(worst(verdicts), reason, measured, "; ".join(others))


def _doubt(before: int, bifurcation: int) -> str:
    """Return what may precede chaos at a bifurcation instead of a closed orbit; empty if a closed orbit does."""
    if before == MotionKind.QUASIPERIODIC:
        return TORUS
    return UNFOLLOWED if bifurcation == BifurcationKind.UNDETERMINED else ""


def _chaotic_before(bifurcations: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Tell at which bifurcations a branch ends on another one that was chaotic already, shape (bifurcation,)."""
    a, kind = refined["a"].values, refined["kind"].values
    result = np.zeros(bifurcations.sizes["bifurcation"], dtype=bool)
    for k in np.flatnonzero(bifurcations["change"].values == Change.END):
        there = refined["branch"].values == bifurcations["to_branch"].values[k]
        below = np.flatnonzero(there.any(axis=1) & (a <= bifurcations["grid_low"].values[k]))
        result[k] = len(below) > 0 and bool(np.isin(kind[below[-1]][there[below[-1]]], CHAOS).any())
    return result
