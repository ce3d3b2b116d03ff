"""Judging a claim under each convention of contact and start.

Under the study's convention the runs decide, under the others the attractors that the initial states reach.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from typing import TYPE_CHECKING

from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    READING,
    Measured,
    NotTestableError,
    Range,
    Share,
    Verdict,
    by_share,
    told_where,
    worst,
)

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
    """Return the verdict of a claim that may depend on the convention.

    own : verdict from the study's runs
    exceptions : where the claim does not hold under the study's convention
    judge : takes the attractors with the branches that the initial states reach under one convention; returns the
        verdict and the numbers behind it as text, or "" as the verdict if nothing is known

    A claim depends on convention if it holds, at least loosely, under one convention and fails under another.
    """
    verdicts, others, unknown = {evidence.own_convention: own}, [], []
    for name, attractors in evidence.other_conventions():
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
    verdict = CONVENTION if _divided(verdicts) else own
    return Verdict(verdict, reason, measured, changes, dict(sorted(verdicts.items())), own)


def by_readings(
    verdicts: Mapping[str, str], reason: str, measured: Sequence[Measured], changes: Sequence[str] = ()
) -> Verdict:
    """Return the verdict of a claim with more than one reading, from that under each; the first one is its own.

    It depends on reading if it holds, at least loosely, under one reading and fails under another; if it does not, the
    worst decides. Raises NotTestableError if that is open: it may agree with the others or not.
    """
    own = next(iter(verdicts.values()))
    divided = _divided(verdicts)
    unresolved = [reading for reading, verdict in verdicts.items() if verdict == NOT_TESTABLE]
    if unresolved and not divided:
        raise NotTestableError(f"there are too few values for the reading «{'» and «'.join(unresolved)}»")
    verdict = READING if divided else worst(verdicts.values())
    return Verdict(verdict, reason, measured, "; ".join(changes), verdicts, own)


def shares_by_readings(shares: Mapping[str, Mapping[str, Share]], loose: float) -> dict[str, str]:
    """Return the verdict under each reading for its worst share, for `by_readings`."""
    return {name: worst(by_share(share, loose) for share in of_one.values()) for name, of_one in shares.items()}


def _divided(verdicts: Mapping[str, str]) -> bool:
    """Return whether some verdict is «fails» and some «holds», at least loosely."""
    return FAILS in verdicts.values() and not {HOLDS, LOOSELY}.isdisjoint(verdicts.values())


def of_rounded_states(evidence: Evidence, initial: Sequence[str], laws: Sequence[str], a: Range) -> list[str]:
    """Return, in words, where states that round to the paper's reach another attractor than the paper's states.

    The paper gives positions to three decimals: see `rounded_branch` of attractors.nc.
    """
    if "attractors" not in evidence.summaries:
        return []
    attractors = evidence.own_attractors()
    attractors = attractors.isel(a=a.choose(attractors["a"].values))
    texts = []
    for state in initial:
        for law in laws:
            own, others = (
                attractors[name].sel(law=law, initial=state).values for name in ("initial_branch", "rounded_branch")
            )
            other = ((others != own[:, None]) & (others >= 0) & (own >= 0)[:, None]).any(axis=1)
            words = f"some states that round to {state} reach another attractor"
            texts += told_where(words, attractors["a"].values, other, law)
    return texts
