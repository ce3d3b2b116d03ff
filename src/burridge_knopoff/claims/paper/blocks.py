"""Claims on chains of few blocks: one, two, and the paper's three."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from burridge_knopoff.claims.choice import LooseShare
from burridge_knopoff.claims.claim import claim
from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.range import POSITIVE, TWO_BLOCKS, Range
from burridge_knopoff.claims.statement import Statement, Truth, decided
from burridge_knopoff.claims.verdict import (
    FAILS,
    Measured,
    Verdict,
    at_values,
    judge_share,
)
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import CHAOS, MotionKind

if TYPE_CHECKING:
    import xarray

#: The two readings of «the same».
KIND_AND_MEAN, MEAN = "in the kind of motion and in ⟨J⟩", "in ⟨J⟩"


@claim("Introduction; Conclusions; both of an earlier study", "two_blocks", "two_blocks")
def two_blocks_agree(evidence: Evidence, *, a: Range = TWO_BLOCKS, loose_share: LooseShare = 0.9) -> Verdict:
    """In the train model of two blocks both laws give practically the same results for a < 0.3.

    Holds if the laws agree from all sampled states at all values of a, and loosely at nine in ten of them.

    The paper's results are kinds of motion and ⟨J⟩; it does not say what those of the earlier study are. The same may
    mean the kind of motion and ⟨J⟩, or ⟨J⟩ alone. For comparison, the first is measured for two blocks that are both
    pulled as well, which is not the paper's chain.
    """
    summary = evidence.summary("two_blocks")
    both = evidence.choose(evidence.law_comparison(summary), a)
    pairs = both.sel(chain="train")
    answers = {KIND_AND_MEAN: pairs["agrees"], MEAN: pairs["same_mean_distance"]}
    measured, changes, readings, texts = [], [], {}, []
    for reading, agrees in answers.items():
        cases = list(_agreement_of_states(agrees).cases("the laws could not be compared for two blocks {where}"))
        share = decided(Statement(evidence, cases, loose_share))
        readings[reading] = judge_share(share.share, loose_share)
        texts.append(f"{reading} at {share.share} ({readings[reading]})")
        of_states = float((agrees == Answer.YES).where(agrees != Answer.UNDETERMINED).mean())
        measured.append(Measured(f"share of a at which the laws agree {reading} from all states", share.share.value))
        measured.append(Measured(f"share of states and a at which they agree {reading}", of_states))
        wrong = cases[0].a[cases[0].is_known & ~cases[0].is_true]
        if len(wrong):
            measured.append(Measured(f"smallest a at which they disagree {reading}", wrong[0]))
            measured.append(Measured(f"largest a at which they disagree {reading}", wrong[-1]))
        changes += share.exceptions(f"they disagree {reading}", f"undetermined {reading}")
    ratio = abs(pairs["difference"]) / pairs["mean_distance"].max("law", skipna=False)
    if ratio.notnull().any():
        measured.append(Measured("largest |Δ⟨J⟩|/⟨J⟩", float(ratio.max())))
    by_distance = (pairs["same_kind"] == Answer.YES) & (pairs["agrees"] != Answer.UNDETERMINED)
    margin = abs(pairs["margin"]).where(by_distance & np.isfinite(pairs["margin"]))
    if margin.notnull().any():
        nearest = float(margin.min())
        measured.append(Measured("smallest distance of Δ⟨J⟩ from the tolerance where it decides, in errors", nearest))
    both_pulled = _agreement_of_states(both["agrees"].sel(chain="both_pulled"))
    if both_pulled.is_known.any():
        of_other = float(both_pulled.is_true.where(both_pulled.is_known).mean())
        measured.append(Measured("the first share if both blocks are pulled, which is not the paper's chain", of_other))
    reason = (
        f"In the train model, which is pulled at its first block only, the laws agree for all {pairs.sizes['state']} "
        "sampled states "
        f"{' and '.join(texts)} of the values of a with {a}."
    )
    return combine_readings(readings, reason, measured, changes)


def _agreement_of_states(agrees: xarray.DataArray) -> Truth:
    """Return at which a the laws agree for all states; agrees : Answer over (state, a)."""
    # One state that disagrees decides; for agreement of all, all have to be known.
    known = (agrees >= 0).all("state") | (agrees == Answer.NO).any("state")
    return Truth((agrees == Answer.YES).all("state"), known)


@claim("Introduction", "two_blocks", "two_blocks", "agreement")
def periodic_for_one_block(evidence: Evidence, *, a: Range = POSITIVE, loose_share: LooseShare = 0.9) -> Verdict:
    """The blocks start and stop at various times, periodically for one block and perhaps chaotically for two or
    more.

    Holds if one block sticks and slips periodically at all values of a under both laws, and some motion of two blocks
    or of the study's chain is chaotic («perhaps chaotically»); and loosely if one block does at nine in ten of them.

    The two-block train starts from the sampled states of the comparison of two blocks, the single block from the first
    of them.
    """
    evidence.check_runs()
    blocks = evidence.choose(evidence.summary("two_blocks"), a)
    kind, sticks = blocks["one_block_kind"], blocks["one_block_stop_rate"] > 0.0
    truth = Truth(((kind == MotionKind.PERIODIC) & sticks).all("law"), (kind != MotionKind.UNDETERMINED).all("law"))
    cases = list(truth.cases("the motion of one block is undetermined {where}"))
    periodic = decided(Statement(evidence, cases, loose_share))
    measured = [Measured("share of a at which one block sticks and slips periodically", periodic.share.value)]
    kinds = {"the train of two blocks": blocks["kind"].sel(chain="train")}
    if "agreement" in evidence.summaries:
        kinds["the study's chain"] = evidence.choose(evidence.summary("agreement"), a)["kind"]
    chaotic = 0
    for name, kind in kinds.items():
        chaos = kind.isin(CHAOS)
        chaotic += int(chaos.sum())
        measured.append(Measured(f"share of motions of {name} that are chaotic", float(chaos.mean())))
        if chaos.any():
            where = chaos.any([dimension for dimension in chaos.dims if dimension != "a"])
            measured.append(Measured(f"smallest a with chaos of {name}", float(chaos["a"][where][0])))
    reason = (
        f"One block sticks and slips periodically under both laws {at_values(periodic.share, a)}; "
        f"{chaotic or 'no'} motions of two or three blocks are chaotic there."
    )
    verdict = periodic.verdict if chaotic else FAILS
    return periodic.conclude(reason, measured, "one block is not periodic", verdict=verdict)
