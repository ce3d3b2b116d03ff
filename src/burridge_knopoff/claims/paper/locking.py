"""Claims on frequency locking: of the unsynchronized motion, and of a branch of attractors before chaos."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import Detuning, LooseShare, ModeDeviation
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import MIN_VALUES, Evidence, check_covered
from burridge_knopoff.claims.range import BELOW, POSITIVE, Range
from burridge_knopoff.claims.statement import Case, Statement, decided
from burridge_knopoff.claims.verdict import (
    UNDECIDED,
    Measured,
    NotTestableError,
    Share,
    Verdict,
    count_share,
    describe_where,
    extremes,
    join_words,
    judge_share,
    judge_shares,
    share_is_decided,
    worst_verdict,
)
from burridge_knopoff.continuation.branch_changes import Change
from burridge_knopoff.motion.kind import CHAOS, REGULAR, MotionKind
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.periodic_orbits.bifurcation_kind import BifurcationKind
from burridge_knopoff.study.formatting import format_values
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.one_frequency import has_one_frequency
from burridge_knopoff.summaries.plateaux import plateaux

if TYPE_CHECKING:
    import xarray

# An exponent is negative if it is below 0 by this many standard errors.
STANDARD_ERRORS = 3.0

#: The two readings of «frequency locking».
ONE_FREQUENCY, NO_MODE = "one frequency with a stable relative phase", "locking, not a normal mode"
UNRESOLVED = "it is not known whether a perturbation of the relative phase decays"

# A locked torus closes after more turns around the orbit from which it was born than a strong resonance, 1:4.
LEAST_TURNS = 4.5

TORUS = "quasiperiodic motion, or chaos too weak to be distinguished from it,"
UNFOLLOWED = "a periodic orbit too long to be continued, or a torus near it,"
#: What precedes chaos if frequency locking is that of a torus, and if every periodic orbit counts as locked.
LOCKED = "a periodic orbit to which a torus has locked"
CLOSED = "any periodic orbit"
#: The first of these at the transition to chaos only, the onset at the smallest a.
FIRST = f"{LOCKED}, at the first onset"


@claim("Conclusions", "detuning", "rotation")
def branch_locked(
    evidence: Evidence,
    *,
    a: Range = BELOW,
    detuning: Detuning = 0.3,
    mode_deviation: ModeDeviation = 0.38,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """The motion below a = 0.1, which depends on history, is an example of frequency locking, also without
    synchrony.

    If the phases of the lateral blocks are opposite, «this frequency-locking» leads to anti-synchronization: branch
    2 from opposite phases, branch 1 from plus. The end blocks have one frequency there by mirror symmetry, which
    shows nothing; the mass of one of them is therefore 1 + `detuning` times as large.

    Holds if the end blocks are locked at all values of a, on both branches under both laws, and loosely at nine in ten
    of them. A perturbation of their relative phase decays if the third Lyapunov exponent is below 0 by three standard
    errors. If it is not, the exponent is 0 if these errors are at most `motion.zero_exponent`, and otherwise unknown.

    Frequency locking may mean that they keep one frequency, and that a perturbation of their relative phase decays,
    which «analogous to an excitation in linear systems» allows: three blocks that oscillate freely would have three
    Lyapunov exponents of 0. Or it means locking as opposed to a normal mode, which also has one frequency: the end
    blocks do not have the amplitude ratio and phase difference of a mode. With r e^{iθ} their complex ratio and ρ
    that of the nearest mode, they move in the mode if |r e^{iθ}/ρ − 1| is at most `mode_deviation`. With 30 % more
    mass ρ = −0.57: equal amplitudes deviate by 0.76 in antiphase, of which `mode_deviation` is half, and more the
    nearer the end of locking is. With 10 % they deviate by 0.22, which does not decide. Nor does the energy: with
    30 % more mass 95 % of it may be in one mode at any ratio from 0.32 to 0.91.

    If the end blocks of branch 1 are locked to the middle block, the rotation number is a ratio of whole numbers
    that is constant in a. The verdict reports where, but does not depend on it. Fractions of a are taken over the
    values of the grid. A value with an undetermined kind of motion does not count.
    """
    evidence.check_blocks()
    rotation = evidence.summary("rotation")
    if detuning not in rotation["detuning"].values:
        raise NotTestableError(f"rotation.nc has no motion with a detuning of {detuning:g}")
    zero = MotionSettings(**evidence.config["motion"]).scaled_to_velocity(evidence.config["v"]).zero_exponent
    cases: dict[str, list[Case]] = {ONE_FREQUENCY: [], NO_MODE: []}
    measured, where = [], []
    for law in PAPER_LAWS:
        of_law = rotation.sel(law=law)
        in_grid = of_law["in_grid"].values == 1
        check_covered(of_law["a"].values[in_grid], a, "the study")
        in_range = a.choose(of_law["a"].values) & in_grid
        for branch in rotation["branch"].values.tolist():
            name = f"branch {branch}, {law}"
            detuned = of_law.sel(branch=branch, detuning=detuning)
            detuned = detuned.isel(value=in_range & np.isfinite(detuned["detuned_exponent"].values[:, 2]))
            if detuned.sizes["value"] < MIN_VALUES:
                raise NotTestableError(f"branch {branch} is regular at fewer than {MIN_VALUES} values of a ({law})")
            grid, frequency = detuned["a"].values, detuned["detuned_frequency"].values
            third, error = (detuned[key].values[:, 2] for key in ("detuned_exponent", "detuned_exponent_error"))
            deviation = _deviation_from_modes(detuned)
            has_one, spread = has_one_frequency(frequency), STANDARD_ERRORS * error
            one_frequency = has_one & (third < -spread)
            is_locked = one_frequency & (deviation > mode_deviation)
            is_known = ~has_one | one_frequency | (spread <= zero)
            unknown = f"{UNRESOLVED} {format_values(grid, ~is_known)} ({name})"
            of_one = Case(name, grid, one_frequency, is_known, unknown)
            cases[ONE_FREQUENCY].append(of_one)
            cases[NO_MODE].append(Case(name, grid, is_locked, is_known | (deviation <= mode_deviation), unknown))
            measured += [
                Measured(
                    f"largest difference of their frequencies, {name}", np.ptp(frequency[:, [0, -1]], axis=1).max()
                ),
                Measured(f"largest third exponent, {name}", third.max()),
                Measured(f"largest deviation from a mode in amplitude ratio and phase, {name}", deviation.max()),
            ]
            where += of_one.exceptions(
                "the end blocks do not keep one frequency with a stable relative phase", UNRESOLVED
            )
            where += describe_where("the end blocks are locked", grid, is_locked, name)
        numbers, texts = _locked_to_middle(of_law, a, law)
        measured, where = measured + numbers, where + texts
    statements = {reading: decided(Statement(evidence, of_branch, loose_share)) for reading, of_branch in cases.items()}
    verdicts = {reading: judge_shares(statement.shares, loose_share)[0] for reading, statement in statements.items()}
    kept, locked = (statements[reading].at(a) for reading in (ONE_FREQUENCY, NO_MODE))
    measured += statements[ONE_FREQUENCY].measured("share of a at which the end blocks keep one frequency")
    measured += statements[NO_MODE].measured("share of a at which they are locked")
    reason = (
        f"With {100 * detuning:g} % more mass on one of them, the end blocks keep one frequency, and a perturbation of "
        f"their relative phase decays (the third Lyapunov exponent is negative), {kept} "
        f"({verdicts[ONE_FREQUENCY]}). They are locked, their complex amplitude ratio more than "
        f"{100 * mode_deviation:g} % away from that of any normal mode, {locked} ({verdicts[NO_MODE]}). Each motion "
        f"was followed for {rotation.attrs['detuned_transient'] + 2.0 * rotation.attrs['detuned_window']:g} time units "
        "or longer."
    )
    return combine_readings(verdicts, reason, measured, where)


def _deviation_from_modes(detuned: xarray.Dataset) -> np.ndarray:
    """Return |r e^{iθ}/ρ − 1| with the complex amplitude ratio r e^{iθ} of the end blocks and ρ of the nearest mode.

    detuned : motion of one branch at one detuning; the result has the shape (values,)
    """
    ratio = detuned["detuned_end_ratio"].values * np.exp(1j * np.radians(detuned["detuned_end_phase"].values))
    return np.abs(ratio[:, None] / detuned["mode_end_ratio"].values - 1.0).min(axis=1)


def _locked_to_middle(rotation: xarray.Dataset, a: Range, law: str) -> tuple[list[Measured], list[str]]:
    """Return the numbers that tell where branch 1 is locked to the middle block under a law, and describe where."""
    inside = a.choose(rotation["a"].values)
    decided = inside & (rotation["in_grid"].values == 1) & (rotation["locked"].values >= 0)
    locked = rotation["locked"].values[decided] == 1
    share = count_share(locked).value if decided.any() else np.nan
    measured = [Measured(f"share of a at which branch 1 is locked to the middle block, {law}", share)]
    number = rotation["rotation_number"].values[inside]
    if np.isfinite(number).any():
        measured += extremes("rotation number", number[np.isfinite(number)], law)
    where = []
    wide = [plateau for plateau in plateaux(rotation.isel(value=inside)) if plateau.last > plateau.first]
    if wide:
        width = sum(plateau.last - plateau.first for plateau in wide)
        measured.append(Measured(f"width in a of all plateaux that were found, {law}", width))
        widest = max(wide, key=lambda plateau: plateau.last - plateau.first)
        where.append(
            f"the widest plateau, {widest.ratio}, reaches from a = {widest.first:.5g} to {widest.last:.5g} ({law})"
        )
    where += describe_where("branch 1 is locked to the middle block", rotation["a"].values[decided], locked, law)
    return measured, where


@claim("Conclusions", "bifurcations", "bifurcations", "refined")
def locking_precedes_chaos(evidence: Evidence, *, a: Range = POSITIVE, loose_share: LooseShare = 0.9) -> Verdict:
    """Frequency locking precedes the transition to chaos.

    Holds if it precedes the onset of chaos, the first or every one, under both laws, and loosely nine in ten of them.
    An onset is a place where a branch of attractors becomes chaotic as a grows.

    Frequency locking is that of a torus: the branch moves on a torus, locks to a periodic orbit, and then becomes
    chaotic. The transition may be the onset at the smallest a, as in «near a = 0.1 we observe a transition», or each
    onset. In a weaker sense every periodic orbit is locked, since its blocks stop in rational ratios; this is also true
    of an orbit that was never on a torus, for example before a cascade of period doublings, and only a torus that
    breaks up into chaos contradicts it.

    The motion before chaos is that of the branch at the next smaller value of a. An onset does not count if the
    chaos existed before, as a transient or on an attractor on which the branch ends; neither does a bifurcation
    that a branch passes without a change. A torus may be chaos too weak for the search to resolve, or may lock
    between the values of a; the verdict says so. A periodic orbit that is too long to be continued to the
    bifurcation, as in a locking tongue, counts as undetermined, since another value of a may show the torus. A
    closer search finds more onsets, so those of a study are a sample.
    """
    evidence.check_blocks()
    bifurcations = evidence.summary("bifurcations")
    laws = bifurcations.attrs["laws"].split()
    before, after, kinds = (bifurcations[key].values for key in ("motion_before", "motion_after", "kind"))
    readings: dict[str, list[str]] = {FIRST: [], LOCKED: [], CLOSED: []}
    texts: dict[str, list[str]] = {reading: [] for reading in readings}
    measured, remarks = [], []
    for name in PAPER_LAWS:
        if name not in laws:
            raise NotTestableError(f"the study has no {name} law")
        refined = evidence.summary("refined").sel(law=name)
        check_covered(refined["a"].values[refined["in_grid"].values == 1], a, "the study")
        is_law = (bifurcations["law"].values == name) & a.choose(bifurcations["grid_high"].values)
        changes = is_law & (bifurcations["change"].values != Change.PASSED) & np.isin(after, CHAOS)
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
        of_law = bifurcations.isel(bifurcation=is_law)
        on_torus = {
            at: _was_torus(of_law, refined, int(bifurcations["from_branch"].values[k]), at[0])
            for at, k in places.items()
        }
        earlier = unknown & (bifurcations["grid_low"].values < min(places)[0])
        for reading in readings:
            judged = [min(places)] if reading == FIRST else [*places]
            possible = [at for at in judged if precursors[at] != TORUS and (reading == CLOSED or on_torus[at])]
            certain = [at for at in possible if not precursors[at]]
            is_decided = share_is_decided(len(certain), len(possible), len(judged), loose_share)
            is_decided &= reading != FIRST or not earlier.any()
            share = Share(len(certain), len(judged))
            readings[reading].append(judge_share(share, loose_share) if is_decided else UNDECIDED)
            texts[reading].append(f"{share.hits} of {share.count} ({name})")
            measured.append(Measured(f"share of the onsets of chaos that {reading} precedes, {name}", share.value))
            if reading == LOCKED and certain:
                where = ", ".join(f"{low:g}" for low, _ in sorted(certain))
                remarks.append(f"{reading} precedes chaos just above a = {where} ({name})")
        ends = Counter(int(kinds[k]) for k in np.flatnonzero(onset))
        for kind, often in sorted(ends.items()):
            measured.append(Measured(f"bifurcations there, {BifurcationKind(kind).name.lower()}, {name}", often))
        if unknown.any():
            values = np.unique(bifurcations["a"].values[unknown])
            remarks.append(
                f"the motion before chaos is undetermined at a = {', '.join(f'{a:.5g}' for a in values)} ({name})"
            )
        for precursor in (TORUS, UNFOLLOWED):
            if places_of_it := sorted(low for (low, _), text in precursors.items() if text == precursor):
                remarks.append(
                    f"{precursor} precedes chaos just above a = {', '.join(f'{a:g}' for a in places_of_it)} ({name})"
                )
    verdicts = {reading: worst_verdict(of_laws) for reading, of_laws in readings.items()}
    counts = "; ".join(f"{reading} in {join_words(texts[reading])} cases ({verdicts[reading]})" for reading in readings)
    reason = f"Where a branch of attractors becomes chaotic as a grows, with {a}, this precedes chaos: {counts}."
    return combine_readings(verdicts, reason, measured, remarks)


def _possible_precursor(before: int, bifurcation: int) -> str:
    """Return what may precede chaos at a bifurcation instead of a periodic orbit; empty if a periodic orbit does."""
    if before == MotionKind.QUASIPERIODIC:
        return TORUS
    return UNFOLLOWED if bifurcation == BifurcationKind.UNDETERMINED else ""


def _was_torus(bifurcations: xarray.Dataset, refined: xarray.Dataset, branch: int, low: float) -> bool:
    """Return whether a branch moves on a torus at some a up to `low`, and from there to `low` on periodic orbits.

    Where it begins, it is followed to the branch that leads to it. A torus that exists only between two values of a at
    which the branch is seen may have a number of its own. It may be locked wherever it is seen (`_torus_births`).

    bifurcations, refined : of one law. Between values of the grid a branch may not have been searched for.
    """
    a, branches, kind, period = (refined[name].values for name in ("a", "branch", "kind", "period"))
    changes = {name: bifurcations[name].values for name in ("change", "from_branch", "to_branch", "grid_high")}
    births = _torus_births(bifurcations)
    passed: list[int] = []
    for row in np.flatnonzero(a <= low)[::-1]:
        is_branch = branches[row] == branch
        if not is_branch.any():
            if refined["in_grid"].values[row] == 1:
                return False
            passed.append(row)
            continue
        if np.isin(kind[row][is_branch], (*CHAOS, MotionKind.TRANSIENT_CHAOS)).any():
            return False
        of_branch = births["branch"] == branch
        is_between = ~np.isin(branches[passed], np.delete(branches, passed, axis=0))
        for motion, time, is_birth in (
            (kind[row][is_branch], period[row][is_branch], (births["low"] <= a[row]) & (a[row] <= births["high"])),
            (kind[passed][is_between], period[passed][is_between], births["low"] == a[row]),
        ):
            shortest = LEAST_TURNS * births["period"][of_branch & is_birth].min(initial=np.inf)
            if ((motion == MotionKind.QUASIPERIODIC) | (time > shortest)).any():
                return True
        passed = []
        branch = _predecessor(changes, branch, a[row])
    return False


def _torus_births(bifurcations: xarray.Dataset) -> dict[str, np.ndarray]:
    """Return where an orbit loses stability to a torus: its branch, its period, and the values of a on both sides.

    A pair of complex multipliers leaves the unit circle there, at a Neimark–Sacker bifurcation or by a jump at a
    grazing. An attractor on the other side that closes only after several periods of the orbit is the torus, locked.
    """
    imaginary, modulus = (
        function(bifurcations["multiplier_beyond"].values)
        for function in (lambda pair: pair[:, 1], lambda pair: np.hypot(pair[:, 0], pair[:, 1]))
    )
    is_birth = (bifurcations["kind"].values == BifurcationKind.NEIMARK_SACKER) | ((imaginary > 0.0) & (modulus > 1.0))
    is_birth &= bifurcations["turns"].values == 0
    names = {"branch": "from_branch", "period": "period", "low": "grid_low", "high": "grid_high"}
    return {name: bifurcations[column].values[is_birth] for name, column in names.items()}


def _predecessor(changes: Mapping[str, np.ndarray], branch: int, a: float) -> int:
    """Return the branch that ends on a branch which begins at an a and leads back to it; the branch itself if none.

    changes : variables of the bifurcations
    """
    leads = changes["to_branch"] == branch
    begins = leads & (changes["change"] == Change.BEGINNING) & (changes["grid_high"] == a)
    if not begins.any():
        return branch
    ends = leads & (changes["change"] == Change.END)
    sources = [set(changes["from_branch"][rows].tolist()) for rows in (begins, ends)]
    return int(next(iter(sources[0] & sources[1] - {-1}), branch))


def _was_chaotic(bifurcations: xarray.Dataset, refined: xarray.Dataset) -> np.ndarray:
    """Return at which bifurcations a branch ends on another one that was already chaotic, shape (bifurcation,)."""
    a, kind = refined["a"].values, refined["kind"].values
    result = np.zeros(bifurcations.sizes["bifurcation"], dtype=bool)
    for k in np.flatnonzero(bifurcations["change"].values == Change.END):
        on_branch = refined["branch"].values == bifurcations["to_branch"].values[k]
        below = np.flatnonzero(on_branch.any(axis=1) & (a <= bifurcations["grid_low"].values[k]))
        result[k] = len(below) > 0 and bool(np.isin(kind[below[-1]][on_branch[below[-1]]], CHAOS).any())
    return result
