"""A claim under each convention of contact and start.

Under the study's own it is judged by the runs, under the others by the attractors that the initial states reach.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, Measured, Verdict, by_share, shares_text, worst

if TYPE_CHECKING:
    import xarray


def under_conventions(
    evidence: Evidence,
    own: str,
    reason: str,
    measured: Sequence[Measured],
    exceptions: Sequence[str],
    judge: Callable[[xarray.Dataset], tuple[str, str]],
) -> Verdict:
    """Return the verdict of a claim that the conventions may decide.

    own : verdict of the study's own runs
    exceptions : where the claim does not hold under the study's own convention
    judge : takes the attractors with what the initial states reach under one convention; returns the verdict and the
        numbers behind it as text, or "" for the verdict if nothing is known

    A claim depends on convention if it holds, at least loosely, under one and fails under another.
    """
    verdicts, others, unknown = {evidence.own_convention: own}, [], []
    if "attractors" in evidence.summaries:
        for name, attractors in evidence.conventions():
            if name == evidence.own_convention:
                continue
            found, numbers = judge(attractors)
            if found:
                verdicts[name] = found
            else:
                unknown.append(name)
            if found and found != own:
                others.append(f"{name}: {found} ({numbers})")
    if unknown:
        others.append(f"not judged under {' and '.join(unknown)}")
    changes = "; ".join([*exceptions, *others])
    return Verdict(by_readings(verdicts, own), reason, measured, changes, dict(sorted(verdicts.items())), own)


def by_readings(verdicts: Mapping[str, str], own: str) -> str:
    """Return the verdict of a claim: its own, but where it holds under one reading and fails under another."""
    fails = [verdict == FAILS for verdict in verdicts.values()]
    return CONVENTION if any(fails) and not all(fails) else own


def judge_shares(shares: Mapping[str, float], loose: float) -> tuple[str, str]:
    """Return (the worst verdict by shares, the shares as text); ("", "") if there are none."""
    if not shares:
        return "", ""
    return worst(by_share(share, loose) for share in shares.values()), shares_text(shares)
