"""Claims on chains of few blocks: one, two, and the paper's three."""

from __future__ import annotations

import numpy as np

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import (
    FAILS,
    Measured,
    Range,
    Verdict,
    at_values,
    by_share,
    known_share,
)
from burridge_knopoff.motion.kind import CHAOS, MotionKind


def two_blocks_agree(evidence: Evidence, a: Range, loose_share: float) -> Verdict:
    """Judge whether both laws lead to like motion of the two-block train from all sampled states, in a range of a.

    For comparison, the same is measured for two blocks that are both pulled, which is not the paper's chain.
    """
    both = evidence.choose(evidence.compared(evidence.summary("two_blocks")), a)
    found = both.sel(chain="train")
    agrees, same_kind, margin = (
        found[name].transpose("state", "a").values for name in ("agrees", "same_kind", "margin")
    )
    known, right, grid = *_for_all_states(agrees), found["a"].values
    share = known_share(
        right, known, loose_share, f"the laws could not be compared for two blocks {at_values(grid, ~known)}"
    )
    measured = [Measured("share of a at which the laws agree from all states", share)]
    measured.append(Measured("share of states and a at which they agree", float((agrees == 1)[agrees >= 0].mean())))
    wrong = grid[known & ~right]
    if len(wrong):
        measured += [
            Measured("smallest a at which they disagree", wrong[0]),
            Measured("largest a at which they disagree", wrong[-1]),
        ]
    by_distance = (same_kind == 1) & (agrees >= 0) & np.isfinite(margin)
    if by_distance.any():
        nearest = float(np.abs(margin[by_distance]).min())
        measured.append(Measured("smallest distance of Δ⟨J⟩ from the tolerance where it decides, in errors", nearest))
    other_known, other_right = _for_all_states(both["agrees"].sel(chain="both_pulled").transpose("state", "a").values)
    if other_known.any():
        of_other = float(other_right[other_known].mean())
        measured.append(
            Measured("the same share of a if both blocks are pulled, which is not the paper's chain", of_other)
        )
    states = found.sizes["state"]
    reason = (
        f"In the train model, pulled at its first block only, the laws agree from all {states} sampled states at "
        f"{100 * share:.1f} % of the values of a with {a}."
    )
    changes = [f"they disagree {at_values(grid, known & ~right)}"] if len(wrong) else []
    if not known.all():
        changes.append(f"unknown {at_values(grid, ~known)}")
    return Verdict(by_share(share, loose_share), reason, measured, "; ".join(changes))


def _for_all_states(agrees: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return where it is known whether laws agree from all states, and where they agree; answers : (states, a)."""
    # One state that disagrees decides; to say that all agree, all have to be known.
    return (agrees >= 0).all(axis=0) | (agrees == 0).any(axis=0), (agrees == 1).all(axis=0)


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
    share = known_share(right, known, loose_share, f"the motion of one block is unknown {at_values(grid, ~known)}")
    measured = [Measured("share of a at which one block sticks and slips periodically", share)]
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
        f"One block sticks and slips periodically under both laws at {100 * share:.1f} % of the values of a with {a}; "
        f"{chaotic or 'no'} motions of two or three blocks are chaotic there."
    )
    changes = [f"one block is not periodic {at_values(grid, known & ~right)}"] if (known & ~right).any() else []
    return Verdict(by_share(share, loose_share) if chaotic else FAILS, reason, measured, "; ".join(changes))
