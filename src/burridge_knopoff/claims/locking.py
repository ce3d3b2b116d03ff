"""Claims on frequency locking: of the unsynchronized motion, and of a branch of attractors before chaos."""

from __future__ import annotations

from collections import Counter
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import MIN_VALUES, Evidence
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.verdict import (
    NOT_TESTABLE,
    Measured,
    NotTestableError,
    Range,
    Share,
    Verdict,
    count_share,
    describe_where,
    format_shares,
    join_words,
    judge_share,
    judge_worst_share,
    share_is_decided,
    worst_verdict,
)
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.motion.kind import CHAOS, REGULAR, MotionKind
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.plateaux import plateaux

if TYPE_CHECKING:
    import xarray

# End blocks whose frequencies differ by no more have one frequency; on tori frequencies are known to a tenth of this.
# An exponent is negative if it is below 0 by this many standard errors.
FREQUENCY_TOLERANCE = 1e-6
STANDARD_ERRORS = 3.0

TORUS = "quasiperiodic motion, or chaos too weak to be distinguished from it,"
UNFOLLOWED = "a periodic orbit too long to be continued, or a torus near it,"
#: What precedes chaos if frequency locking is that of a torus, and if every periodic orbit counts as locked.
LOCKED = "a periodic orbit to which a torus has locked"
CLOSED = "any periodic orbit"


@judge("rotation")
def branch_locked(evidence: Evidence, a: Range, detuning: float, loose_share: float) -> Verdict:
    """Judge whether the end blocks of branch 1, which is not synchronized, are locked at all a of a range.

    The paper speaks of the phases of the lateral blocks. At equal masses their equal frequencies would show nothing,
    since the motion is its own mirror image. They are locked if they keep one frequency when the mass of one of them
    becomes 1 + `detuning` times as large, and if a perturbation of their relative phase decays: without any locking,
    three blocks would have three Lyapunov exponents of 0.

    If they are locked to the middle block as well, the rotation number is a ratio of whole numbers that is constant in
    a. The verdict reports where, but does not depend on it. The fraction of a is taken over the values of the grid. A
    value with an undetermined kind of motion does not count.

    loose_share : fraction of a from which the claim holds loosely
    """
    evidence.check_blocks()
    rotation = evidence.summary("rotation")
    if detuning not in rotation["detuning"].values:
        raise NotTestableError(f"rotation.nc has no motion with a detuning of {detuning:g}")
    shares: dict[str, Share] = {}
    measured, where = [], []
    for law in PAPER_LAWS:
        found = rotation.sel(law=law)
        inside = a.choose(found["a"].values)
        known = inside & (found["in_grid"].values == 1) & (found["locked"].values >= 0)
        if known.sum() < MIN_VALUES:
            raise NotTestableError(f"branch 1 is regular motion at fewer than {MIN_VALUES} values of a ({law})")
        grid = found["a"].values[known]
        detuned = found.sel(detuning=detuning).isel(value=known)
        detuned_difference = np.abs(
            detuned["detuned_frequency"].values[:, -1] - detuned["detuned_frequency"].values[:, 0]
        )
        third, error = (detuned[name].values[:, 2] for name in ("detuned_exponent", "detuned_exponent_error"))
        are_locked = (detuned_difference <= FREQUENCY_TOLERANCE) & (third < -STANDARD_ERRORS * error)
        shares[law] = count_share(are_locked)
        measured.append(
            Measured(f"share of a at which the end blocks are locked to each other, {law}", shares[law].value)
        )
        for name, values in (("difference of their frequencies", detuned_difference), ("third exponent", third)):
            if np.isfinite(values).any():
                measured.append(Measured(f"largest {name}, {law}", float(np.nanmax(values))))
        where += describe_where("the end blocks are not locked to each other", grid, ~are_locked, law)
        locked = found["locked"].values[known] == 1
        measured.append(
            Measured(f"share of a at which they are locked to the middle block, {law}", count_share(locked).value)
        )
        number = found["rotation_number"].values[inside]
        measured += [
            Measured(f"smallest rotation number, {law}", float(np.nanmin(number))),
            Measured(f"largest rotation number, {law}", float(np.nanmax(number))),
        ]
        found_plateaux = [one for one in plateaux(found.isel(value=inside)) if one.last > one.first]
        if found_plateaux:
            measured.append(
                Measured(
                    f"width in a of all plateaux that were found, {law}", sum(p.last - p.first for p in found_plateaux)
                )
            )
            widest = max(found_plateaux, key=lambda one: one.last - one.first)
            where.append(
                f"the widest plateau, {widest.ratio}, reaches from a = {widest.first:.5g} to {widest.last:.5g} ({law})"
            )
        where += describe_where("locked to the middle block", grid, locked, law)
    reason = (
        f"With {100 * detuning:g} % more mass on one end block, the end blocks of branch 1 keep one frequency, and a "
        f"perturbation of their relative phase decays (the third Lyapunov exponent is negative), at "
        f"{format_shares(shares)} of the values of a with {a}. Each motion was followed for "
        f"{rotation.attrs['detuned_transient'] + 2.0 * rotation.attrs['detuned_window']:g} time units."
    )
    return Verdict(judge_worst_share(shares, loose_share), reason, measured, "; ".join(where))


@judge("bifurcations", "refined")
def locking_precedes_chaos(evidence: Evidence, loose_share: float) -> Verdict:
    """Judge whether frequency locking precedes chaos where a branch becomes chaotic as a grows.

    Frequency locking is that of a torus: the branch moves on a torus, locks to a periodic orbit, and then becomes
    chaotic. In a weaker sense every periodic orbit is locked, since its blocks stop in rational ratios; this is also
    true of an orbit that was never on a torus, for example before a cascade of period doublings, and only a torus that
    breaks up into chaos contradicts it.

    The motion before chaos is that of the branch at the next smaller value of a. An onset does not count if the chaos
    existed before, as a transient or on an attractor on which the branch ends; neither does a bifurcation that a branch
    passes without a change. A torus may be chaos too weak for the search to resolve, or may lock between the values of
    a; the verdict says so. A periodic orbit that is too long to be continued to the bifurcation, as in a locking
    tongue, counts as undetermined, since another value of a may show the torus. A closer search finds more onsets, so
    those of a study are a sample: the claim fails if the 95 % interval of the fraction lies below `loose_share`.

    loose_share : fraction of the onsets of chaos from which the claim holds loosely
    """
    evidence.check_blocks()
    bifurcations = evidence.summary("bifurcations")
    laws = bifurcations.attrs["laws"].split()
    before, after, kinds = (bifurcations[key].values for key in ("motion_before", "motion_after", "kind"))
    readings: dict[str, list[str]] = {LOCKED: [], CLOSED: []}
    texts: dict[str, list[str]] = {LOCKED: [], CLOSED: []}
    measured, others = [], []
    for name in PAPER_LAWS:
        if name not in laws:
            raise NotTestableError(f"the study has no {name} law")
        refined = evidence.summary("refined").sel(law=name)
        own = bifurcations["law"].values == name
        changes = own & (bifurcations["change"].values != Change.PASSED) & np.isin(after, CHAOS)
        changes &= ~_was_chaotic(bifurcations, refined)
        onset = changes & np.isin(before, (MotionKind.SYNCHRONIZED, *REGULAR))
        unknown = changes & (before == MotionKind.UNDETERMINED)
        # One onset may have two bifurcations.
        places = {
            (float(bifurcations["grid_low"].values[k]), int(bifurcations["to_branch"].values[k])): k
            for k in np.flatnonzero(onset)
        }
        if not places:
            raise NotTestableError(f"no branch of attractors becomes chaotic under the {name} law")
        precursors = {at: _possible_precursor(before[k], kinds[k]) for at, k in places.items()}
        of_law = bifurcations.isel(bifurcation=own)
        on_torus = {
            at: _was_torus(of_law, refined, int(bifurcations["from_branch"].values[k]), at[0])
            for at, k in places.items()
        }
        for reading in readings:
            possible = [at for at in places if precursors[at] != TORUS and (reading == CLOSED or on_torus[at])]
            certain = [at for at in possible if not precursors[at]]
            is_decided = share_is_decided(len(certain), len(possible), len(places), loose_share)
            share = Share(len(certain), len(places))
            readings[reading].append(judge_share(share, loose_share) if is_decided else NOT_TESTABLE)
            texts[reading].append(f"{share.hits} of {share.count} ({name})")
            measured.append(Measured(f"share of the onsets of chaos that {reading} precedes, {name}", share.value))
            if reading == LOCKED and certain:
                where = ", ".join(f"{low:g}" for low, _ in sorted(certain))
                others.append(f"{reading} precedes chaos just above a = {where} ({name})")
        ends = Counter(int(kinds[k]) for k in np.flatnonzero(onset))
        for kind, often in sorted(ends.items()):
            measured.append(Measured(f"bifurcations there, {BifurcationKind(kind).name.lower()}, {name}", often))
        if unknown.any():
            values = np.unique(bifurcations["a"].values[unknown])
            others.append(
                f"the motion before chaos is undetermined at a = {', '.join(f'{a:.5g}' for a in values)} ({name})"
            )
        for precursor in (TORUS, UNFOLLOWED):
            if there := sorted(low for (low, _), text in precursors.items() if text == precursor):
                others.append(
                    f"{precursor} precedes chaos just above a = {', '.join(f'{a:g}' for a in there)} ({name})"
                )
    verdicts = {reading: worst_verdict(of_laws) for reading, of_laws in readings.items()}
    counts = "; ".join(f"{reading} in {join_words(texts[reading])} cases ({verdicts[reading]})" for reading in readings)
    reason = f"Where a branch of attractors becomes chaotic as a grows, this precedes chaos: {counts}."
    return combine_readings(verdicts, reason, measured, others)


def _possible_precursor(before: int, bifurcation: int) -> str:
    """Return what may precede chaos at a bifurcation instead of a periodic orbit; empty if a periodic orbit does."""
    if before == MotionKind.QUASIPERIODIC:
        return TORUS
    return UNFOLLOWED if bifurcation == BifurcationKind.UNDETERMINED else ""


def _was_torus(bifurcations: xarray.Dataset, refined: xarray.Dataset, branch: int, low: float) -> bool:
    """Return whether a branch moves on a torus at some a up to `low`, and from there to `low` on periodic orbits.

    Where it begins, it is followed to the branch that leads to it.

    bifurcations, refined : of one law. Between values of the grid a branch may not have been searched for.
    """
    a = refined["a"].values
    for row in np.flatnonzero(a <= low)[::-1]:
        kinds = refined["kind"].values[row][refined["branch"].values[row] == branch]
        if not len(kinds) and refined["in_grid"].values[row] == 1:
            return False
        if np.isin(kinds, (*CHAOS, MotionKind.TRANSIENT_CHAOS)).any():
            return False
        if (kinds == MotionKind.QUASIPERIODIC).any():
            return True
        branch = _predecessor(bifurcations, branch, a[row])
    return False


def _predecessor(bifurcations: xarray.Dataset, branch: int, a: float) -> int:
    """Return the branch that ends on a branch which begins at an a and leads back to it; the branch itself if none."""
    to_branch, change = bifurcations["to_branch"].values, bifurcations["change"].values
    begins = (to_branch == branch) & (change == Change.BEGINNING) & (bifurcations["grid_high"].values == a)
    ends = (to_branch == branch) & (change == Change.END)
    sources = [set(bifurcations["from_branch"].values[rows].tolist()) for rows in (begins, ends)]
    return int(next(iter(sources[0] & sources[1] - {-1}), branch))


def _was_chaotic(bifurcations: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Return at which bifurcations a branch ends on another one that was already chaotic, shape (bifurcation,)."""
    a, kind = refined["a"].values, refined["kind"].values
    result = np.zeros(bifurcations.sizes["bifurcation"], dtype=bool)
    for k in np.flatnonzero(bifurcations["change"].values == Change.END):
        there = refined["branch"].values == bifurcations["to_branch"].values[k]
        below = np.flatnonzero(there.any(axis=1) & (a <= bifurcations["grid_low"].values[k]))
        result[k] = len(below) > 0 and bool(np.isin(kind[below[-1]][there[below[-1]]], CHAOS).any())
    return result
