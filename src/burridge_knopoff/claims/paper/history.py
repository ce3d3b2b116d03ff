"""Claims on what decides between coexisting attractors: initial state, first block, phases of the end blocks."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import (
    ANTIPHASE,
    Close,
    Correlation,
    InnerShare,
    LooseShare,
    Opposite,
    Samples,
    StateShare,
)
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.outcomes import Reached, Runs
from burridge_knopoff.claims.phase_outcomes import Criteria, PhaseOutcomes, percent
from burridge_knopoff.claims.range import BELOW, SYNCHRONY, Range
from burridge_knopoff.claims.statement import Truth, for_all
from burridge_knopoff.claims.verdict import (
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    OPEN,
    UNDECIDED,
    Measured,
    NotTestableError,
    UndecidedError,
    Verdict,
    at_values,
    count_share,
    describe_where,
    extremes,
    join_words,
    judge_shares,
    judge_worst_share,
    worst_verdict,
)
from burridge_knopoff.motion.kind import MotionKind, merge_chaos
from burridge_knopoff.study.paper import PAPER_LAWS

if TYPE_CHECKING:
    import xarray


#: The statements about plus.
OF_PLUS = (
    *("plus_does_not_synchronize", "plus_mean_distance", "plus_stationary", "plus_cloud", "plus_line_disappears"),
    *("plus_largest_exponent", "plus_not_periodic", "plus_aperiodic", "velocities_touch_zero", "antiphase"),
    "half_frequency",
)


@claim("Introduction; Results", "basin_fractions", "attractors")
def history_decides(
    evidence: Evidence, *, a: Range = BELOW, samples: Samples = 100, loose_share: LooseShare = 0.9
) -> Verdict:
    """For a < 0.1 the character of the motion depends on its history.

    Holds if attractors of more than one kind, synchronized, periodic, quasiperiodic or chaotic, coexist at all values
    of a under both laws, and loosely at nine in ten of them. An attractor counts if sampled states or the study's
    initial states reach it. That there is only one takes {samples} sampled states.
    """
    attractors = evidence.choose(evidence.own_attractors(), a)
    shares, measured, single = {}, [], []
    for law in PAPER_LAWS:
        slots = attractors.sel(law=law)
        count, kinds = _coexisting(slots, samples)
        shares[law] = count_share(kinds > 1)
        measured.append(Measured(f"share of a with attractors of more than one kind, {law}", shares[law].value))
        measured.append(Measured(f"most attractors that coexist, {law}", float(count.max())))
        fraction = slots["basin_fraction"].values[(slots["branch"].values == 0) & (slots["basin_count"].values > 0)]
        if len(fraction):
            measured += extremes("basin fraction of synchrony", fraction, law)
        single += describe_where("at most one kind of motion", slots["a"].values, kinds <= 1, law)
    reason = f"Attractors of more than one kind are reached {at_values(shares, a)}."
    return Verdict(judge_worst_share(shares, loose_share), reason, measured, "; ".join(single))


def _coexisting(attractors: xarray.Dataset, samples: int) -> tuple[np.ndarray, np.ndarray]:
    """Return the numbers of attractors reached, and of their kinds of motion, at each a under one law."""
    reached = np.where(attractors["basin_count"].values > 0, attractors["branch"].values, -1)
    started = attractors["initial_branch"].transpose("a", "initial").values
    coexisting = [set(row[row >= 0].tolist()) for row in np.concatenate([reached, started], axis=1)]
    count = np.array([len(branches) for branches in coexisting])
    branch, kind = attractors["branch"].values.tolist(), merge_chaos(attractors["kind"].values).tolist()
    kind_of_branch = [dict(zip(*slots, strict=True)) for slots in zip(branch, kind, strict=True)]
    kinds = [
        {kind_of[number] for number in branches & kind_of.keys()} - {MotionKind.UNDETERMINED}
        for branches, kind_of in zip(coexisting, kind_of_branch, strict=True)
    ]
    if ((count < 2) & (attractors["basin_count"].values.sum(axis=1) < samples)).any():
        raise NotTestableError(f"fewer than {samples} sampled states reach an attractor where one alone is seen")
    return count, np.array([len(of_a) for of_a in kinds])


@claim(
    "Introduction; Results, Fig. 3",
    "mean_distance",
    "mean_distance",
    "attractors",
    depends_on=("minus_synchronizes", "plus_does_not_synchronize"),
)
def first_block_decides(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = SYNCHRONY,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """The initial position of one block alone, minus or plus, switches between synchrony and no synchrony for a
    between 0.005 and 0.08.
    """

    def truth(motion: Runs | Reached) -> Truth:
        first, other = (motion.synchronized.sel(initial=state, drop=True) for state in initial)
        return Truth(first != other, first.notnull() & other.notnull())

    unknown = f"too few runs under the {{law}} law completed at {a}"
    share = for_all(evidence, initial, a, loose_share, truth, unknown, truth)
    return share.conclude(
        f"One of {initial[0]} and {initial[1]} synchronizes and the other does not {share.at(a)}.",
        share.measured("share of a at which the outcome differs"),
        "the outcome is the same",
    )


@claim(
    "Introduction; Results, Fig. 3",
    "mean_distance",
    "mean_distance",
    "attractors",
    depends_on=("minus_synchronizes", "plus_does_not_synchronize"),
)
def same_for_both_laws(
    evidence: Evidence,
    *,
    initial: tuple[str, ...] = ("minus", "plus"),
    a: Range = SYNCHRONY,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """Synchrony depends on the initial state in the same way under both laws, for a between 0.005 and 0.08."""

    def truth(motion: Runs | Reached) -> Truth:
        first, other = (motion.synchronized.sel(law=law, drop=True) for law in PAPER_LAWS)
        return Truth(first == other, first.notnull() & other.notnull())

    unknown = f"too few runs from {{initial}} completed at {a}"
    share = for_all(evidence, initial, a, loose_share, truth, unknown, truth)
    return share.conclude(
        f"Both laws have the same outcome, synchrony or no synchrony, {share.at(a)}.",
        share.measured("share of a with the same outcome"),
        "the outcomes differ",
    )


@claim("Results, Figs. 3, 4b, 5b and 7", "mean_distance", depends_on=OF_PLUS)
def plus_under_one_convention(evidence: Evidence, *, claims: tuple[str, ...] = OF_PLUS) -> Verdict:
    """All statements about plus hold together, under one convention of contact and start.

    Holds if there is a convention under which all of them hold, and loosely if some of them hold loosely there. A
    convention under which one of them is not judged is open, unless another fails there.

    «The total spring force must be greater than F(0)»: the contact is one-sided. The paper leaves open whether
    blocks may stick at τ = 0. Here a symmetric contact counts too, in case the paper's program used it.

    claims : by name; each has to be judged before this one
    """
    verdicts = {name: evidence.verdicts[name] for name in claims}
    for verdict in verdicts.values():
        if verdict.verdict == NOT_TESTABLE or (verdict.verdict in OPEN and not verdict.conventions):
            raise NotTestableError(verdict.reason.partition(": ")[2].removesuffix("."))
    conventions = sorted({convention for verdict in verdicts.values() for convention in verdict.conventions})
    if not conventions:
        raise NotTestableError("the claims are judged under one convention only")
    together, measured, texts = {}, [], []
    for convention in conventions:
        of_convention = {name: verdict.conventions.get(convention) for name, verdict in verdicts.items()}
        judged = {name: verdict for name, verdict in of_convention.items() if verdict}
        measured.append(
            Measured(
                f"claims that hold, of {len(judged)} judged: {convention}", sum(v != FAILS for v in judged.values())
            )
        )
        together[convention] = worst_verdict([*judged.values(), *[UNDECIDED] * (len(judged) < len(claims))])
        against = [name for name, verdict in judged.items() if verdict == FAILS]
        open_ones = [name for name in claims if name not in judged]
        parts = [f"{join_words(against)} {'fail' if len(against) > 1 else 'fails'}"] if against else []
        parts += [f"{join_words(open_ones)} cannot be judged"] if open_ones else []
        texts.append(f"under ({convention}) {', and '.join(parts) or 'all hold'}")
    best = min(together.values(), key=(HOLDS, LOOSELY, UNDECIDED, FAILS).index)
    if best == UNDECIDED:
        raise UndecidedError("; ".join(texts))
    under = [convention for convention, verdict in together.items() if verdict == best]
    reason = (
        f"All of them hold{' loosely' if best == LOOSELY else ''} under {join_words([f'({name})' for name in under])}."
        if best != FAILS
        else f"None of the {len(conventions)} conventions makes all {len(claims)} statements hold."
    )
    return Verdict(best, reason, measured, "; ".join(texts))


@claim("Conclusions; Results, Fig. 3", "phases", "phases")
def phases_decide(
    evidence: Evidence,
    *,
    a: Range = SYNCHRONY,
    inner_share: InnerShare = 0.0,
    close: Close = 30.0,
    opposite: Opposite = 180.0,
    correlation: Correlation = ANTIPHASE,
    share: StateShare = 0.9,
    loose_share: LooseShare = 0.9,
) -> Verdict:
    """End blocks whose initial phases are close synchronize for a between 0.005 and 0.08; opposite phases lead to a
    kind of anti-synchronization, which persists.

    Holds if, at every judged amplitude and at all values of a under both laws, the share of the states at most
    {close:g}° apart that synchronize, and that of the states {opposite:g}° apart that end with a correlation of the
    velocities of {correlation:g} or less, are at least {share:g}, each by the lower end of its Wilson interval; and
    loosely at nine in ten of the values of a.

    The conclusions say «below a = 0.1», but of the synchrony found from 0.005 to 0.08. The paper says neither how
    large the oscillations are nor how the middle block moves. They may be oscillations about uniform sliding, with
    amplitudes at which every velocity is positive at the start, whatever the phases; or of any computed amplitude.
    The middle block may slide uniformly, so that only the end blocks oscillate, or oscillate as well.

    inner_share : amplitude of the inner blocks, as a fraction, under the first reading
    """
    evidence.check_blocks()
    phases = evidence.summary("phases")
    evidence.choose(phases, a)
    if not (phases["inner_share"].values != inner_share).any():
        raise NotTestableError(
            f"phases.inner_share needs a second value beside {inner_share:g}: whether the middle block oscillates "
            "could change the verdict"
        )
    criteria = Criteria(a, close, opposite, correlation, share, loose_share)
    judged = PhaseOutcomes(phases, inner_share, criteria)
    if judged.without_backward_slip.all():
        raise NotTestableError("phases.amplitude needs a value at which some block slips backward")
    measured: list[Measured] = []
    changes = []
    for k, size in enumerate(judged.amplitude):
        measured += judged.measured(f"A = {size:g}", np.arange(len(judged.amplitude)) == k)
        if not judged.holds[:, judged.inside, k].all():
            outcomes_of_size = judged.synchronized, judged.antiphase
            shares = [percent(outcome.fraction[:, judged.inside, k]) for outcome in outcomes_of_size]
            changes.append(
                f"A = {size:g}: {shares[0]} of the close phases synchronize, {shares[1]} of the opposite phases end in "
                "antiphase"
            )
    for law, low in zip(judged.laws, judged.synchronized.low, strict=True):
        lost = ~judged.inside & (low[:, judged.without_backward_slip] < share).any(axis=1)
        changes += describe_where("close phases do not synchronize", phases["a"].values, lost, law)
    everywhere = judged.shares_at(np.ones(len(judged.amplitude), dtype=bool))
    large = judge_shares(everywhere, loose_share)[0]
    readings = {_format_inner_block(inner_share): judged.verdict, "every amplitude": large}
    changes.append(f"at every amplitude the claim {large}, since it is true {at_values(everywhere, a)}")
    for other in phases["inner_share"].values[phases["inner_share"].values != inner_share].tolist():
        where = _format_inner_block(other)
        try:
            outcomes = PhaseOutcomes(phases, other, criteria)
        except NotTestableError as error:
            changes.append(f"with {where} the claim cannot be judged: {error}")
            continue
        readings[where] = outcomes.verdict
        changes.append(
            f"with {where} (A = {outcomes.amplitudes}) the claim {outcomes.verdict}, since it is true "
            f"{at_values(outcomes.shares, a)}: {outcomes.format_fractions()}"
        )
        measured += outcomes.measured(where, outcomes.without_backward_slip)
    synchronized, antiphase = (
        f"{percent(outcome.fraction[judged.cells])} of the states, Wilson intervals from "
        f"{100 * outcome.low[judged.cells].min():.1f} %"
        for outcome in (judged.synchronized, judged.antiphase)
    )
    reason = (
        f"The end blocks oscillate about uniform sliding with amplitudes at which no block slips backward (A = "
        f"{judged.amplitudes}), {_format_inner_block(inner_share)}. Phases within {close:g}° lead to synchrony "
        f"({synchronized}) and opposite phases to antiphase ({antiphase}) "
        f"{at_values(judged.shares, a)}."
    )
    return combine_readings(readings, reason, measured, changes)


def _format_inner_block(share: float) -> str:
    """Describe the motion of the middle block."""
    return "the middle block sliding uniformly" if share == 0.0 else f"the middle block oscillating with {share:g} A"
