"""Claims on chains of few blocks: one, two, and the paper's three."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.claims.conventions import combine_readings
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.for_all import Case, for_all
from burridge_knopoff.claims.judge import judge
from burridge_knopoff.claims.verdict import FAILS, Measured, Range, Verdict, format_values, judge_share
from burridge_knopoff.dataset.variables import Answer
from burridge_knopoff.motion.kind import CHAOS, MotionKind

#: The two readings of «the same».
KIND_AND_MEAN, MEAN = "in the kind of motion and in ⟨J⟩", "in ⟨J⟩"


@judge("two_blocks")
def two_blocks_agree(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws give practically the same for the two-block train, from all sampled states at each a.

    The same may mean the kind of motion and ⟨J⟩, or ⟨J⟩ alone, the paper's measure. For comparison, the first is
    measured for two blocks that are both pulled as well, which is not the paper's chain.
    """
    summary = evidence.summary("two_blocks")
    both = evidence.choose(evidence.law_comparison(summary), a)
    found = both.sel(chain="train").transpose("law", "state", "a", ...)
    grid, states = found["a"].values, found.sizes["state"]
    answers = {KIND_AND_MEAN: found["agrees"].values, MEAN: found["same_mean_distance"].values}
    measured, changes, readings, texts = [], [], {}, []
    for reading, agrees in answers.items():
        known, right = _states_agree(agrees)
        unknown = f"the laws could not be compared for two blocks {format_values(grid, ~known)}"
        case = Case(reading, grid, right, known, unknown)
        share = for_all(loose_share, [case]).share
        readings[reading] = judge_share(share, loose_share)
        texts.append(f"{reading} at {share} ({readings[reading]})")
        of_states = float((agrees == Answer.YES)[agrees != Answer.UNDETERMINED].mean())
        measured.append(Measured(f"share of a at which the laws agree {reading} from all states", share.value))
        measured.append(Measured(f"share of states and a at which they agree {reading}", of_states))
        wrong = grid[known & ~right]
        if len(wrong):
            measured.append(Measured(f"smallest a at which they disagree {reading}", wrong[0]))
            measured.append(Measured(f"largest a at which they disagree {reading}", wrong[-1]))
        changes += case.exceptions(f"they disagree {reading}", f"undetermined {reading}")
    ratio = np.abs(found["difference"].values) / found["mean_distance"].max("law", skipna=False).values
    if np.isfinite(ratio).any():
        measured.append(Measured("largest |Δ⟨J⟩|/⟨J⟩", float(np.nanmax(ratio))))
    by_distance = (found["same_kind"].values == Answer.YES) & (answers[KIND_AND_MEAN] != Answer.UNDETERMINED)
    by_distance &= np.isfinite(found["margin"].values)
    if by_distance.any():
        nearest = float(np.abs(found["margin"].values[by_distance]).min())
        measured.append(Measured("smallest distance of Δ⟨J⟩ from the tolerance where it decides, in errors", nearest))
    other_known, other_right = _states_agree(both["agrees"].sel(chain="both_pulled").transpose("state", "a").values)
    if other_known.any():
        of_other = float(other_right[other_known].mean())
        measured.append(Measured("the first share if both blocks are pulled, which is not the paper's chain", of_other))
    reason = (
        f"In the train model, which is pulled at its first block only, the laws agree for all {states} sampled states "
        f"{' and '.join(texts)} of the values of a with {a}."
    )
    return combine_readings(readings, reason, measured, changes)


def _states_agree(agrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where it is known whether laws agree for all states, and where they do; answers : (states, a)."""
    # One state that disagrees decides; for agreement of all, all have to be known.
    return (agrees >= 0).all(axis=0) | (agrees == Answer.NO).any(axis=0), (agrees == Answer.YES).all(axis=0)


@judge("two_blocks", "agreement")
def periodic_for_one_block(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether one block sticks and slips periodically at all a of a range, and more blocks perhaps chaotically.

    The two-block train starts from the sampled states of the comparison of two blocks, the single block from the first
    of them, under both laws. `Perhaps chaotic` requires one chaotic motion of two blocks or of the study's chain.
    """
    evidence.check_runs()
    found = evidence.choose(evidence.summary("two_blocks"), a)
    one = found["one_block_kind"].transpose("a", "law").values
    sticks = (found["one_block_stop_rate"] > 0.0).transpose("a", "law").values
    known = (one != MotionKind.UNDETERMINED).all(axis=1)
    right = ((one == MotionKind.PERIODIC) & sticks).all(axis=1)
    grid = found["a"].values
    case = Case(
        "one block", grid, right, known, f"the motion of one block is undetermined {format_values(grid, ~known)}"
    )
    periodic = for_all(loose_share, [case])
    measured = [Measured("share of a at which one block sticks and slips periodically", periodic.share.value)]
    two = np.isin(found["kind"].sel(chain="train").transpose("a", ...).values.reshape(len(grid), -1), CHAOS)
    evidences = [("the train of two blocks", grid, two)]
    if "agreement" in evidence.summaries:
        runs = evidence.choose(evidence.summary("agreement"), a)
        three = np.isin(runs["kind"].transpose("a", ...).values.reshape(runs.sizes["a"], -1), CHAOS)
        evidences.append(("the study's chain", runs["a"].values, three))
    for name, values, chaos in evidences:
        measured.append(Measured(f"share of motions of {name} that are chaotic", float(chaos.mean())))
        if chaos.any():
            measured.append(Measured(f"smallest a with chaos of {name}", values[chaos.any(axis=1)][0]))
    chaotic = sum(int(chaos.sum()) for *_, chaos in evidences)
    reason = (
        f"One block sticks and slips periodically under both laws at {periodic.share} of the values of a with {a}; "
        f"{chaotic or 'no'} motions of two or three blocks are chaotic there."
    )
    verdict = periodic.verdict if chaotic else FAILS
    return Verdict(verdict, reason, measured, "; ".join(case.exceptions("one block is not periodic")))
