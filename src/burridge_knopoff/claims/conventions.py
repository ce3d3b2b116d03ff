"""Verdicts on a claim under each convention of contact and start, and under each reading.

Under the study's convention the runs decide; under the others, the attractors that the initial states reach. The paper
leaves the start open, but not the contact: its condition for a stuck block to move again is one-sided.
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
    OPEN,
    READING,
    SILENT,
    UNDECIDED,
    Measured,
    NotTestableError,
    Verdict,
    join_words,
    worst_verdict,
)

if TYPE_CHECKING:
    import xarray

#: A stuck block moves again when the spring force is *greater* than the static friction.
PAPER_CONTACT = "one_sided"


def judge_conventions(
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
        verdict and the numbers behind it as text; the verdict is "" if the attractors are not known, and SILENT if the
        statement is about nothing there

    A claim depends on convention if it holds, at least loosely, under one convention and fails under another. If the
    study has the contact of the paper, only conventions with this contact count, and what the others give is listed.

    It is undecided if it is so under a convention that counts, unless the others contradict each other already.
    Raises NotTestableError if the study has no attractors, or if those reached are not known under such a convention.
    """
    verdicts: dict[str, str] = {evidence.own_convention: own}
    others: list[str] = []
    silent: list[str] = []
    unknown: list[str] = []
    undecided: list[str] = []
    for name, attractors in evidence.other_conventions():
        judged, numbers = judge(attractors)
        if judged in ("", SILENT):
            (silent if judged else unknown).append(name)
        elif judged == UNDECIDED:
            undecided.append(name)
            others.append(f"under ({name}) it is undecided: {numbers}")
        else:
            verdicts[name] = judged
            if judged != own:
                others.append(f"under ({name}) it {judged}: {numbers}")
    for words, names in ((f"it {SILENT} under", silent), ("it cannot be judged under", unknown)):
        if names:
            others.append(f"{words} {join_words([f'({name})' for name in names])}")
    counts = [
        name
        for name in (*verdicts, *unknown, *undecided)
        if evidence.config["contact"] != PAPER_CONTACT or name.split(", ")[0] == PAPER_CONTACT
    ]
    verdict = CONVENTION if _is_divided({name: verdicts[name] for name in counts if name in verdicts}) else own
    open_ones = [[f"({name})" for name in names if name in counts] for names in (unknown, undecided)]
    if verdict != CONVENTION and open_ones[0]:
        raise NotTestableError(
            f"under {join_words(open_ones[0])}, which could change the verdict, too few of the attractors reached are "
            "known"
        )
    if verdict != CONVENTION and open_ones[1]:
        verdict, reason = UNDECIDED, f"Undecided: there are too few values under {join_words(open_ones[1])}. {reason}"
    changes = "; ".join([*exceptions, *others])
    return Verdict(verdict, reason, measured, changes, dict(sorted(verdicts.items())), own)


def combine_readings(
    verdicts: Mapping[str, str], reason: str, measured: Sequence[Measured], changes: Sequence[str] = ()
) -> Verdict:
    """Return the verdict of a claim with more than one reading, from the verdict under each; the first one is its own.

    The claim is ambiguous if it holds, at least loosely, under one reading and fails under another. Otherwise the
    worst verdict decides. It is undecided if a reading is open and could contradict the others.
    """
    own = next(iter(verdicts.values()))
    divided = _is_divided(verdicts)
    unresolved = [reading for reading, verdict in verdicts.items() if verdict in OPEN]
    verdict = READING if divided else UNDECIDED if unresolved else worst_verdict(verdicts.values())
    if verdict == UNDECIDED:
        reason = f"Undecided: there are too few values for the reading «{'» and «'.join(unresolved)}». {reason}"
    return Verdict(verdict, reason, measured, "; ".join(changes), verdicts, own)


def _is_divided(verdicts: Mapping[str, str]) -> bool:
    """Return whether some verdict is «fails» and some «holds», at least loosely."""
    return FAILS in verdicts.values() and not {HOLDS, LOOSELY}.isdisjoint(verdicts.values())
