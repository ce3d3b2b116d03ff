"""The ledger: every claim with its verdict and what would change it."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from typing import Any

import numpy as np

from burridge_knopoff.claims.choices import other_tolerances
from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.conventions import rounded_state_changes
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.margins import changing_choices
from burridge_knopoff.claims.verdict import NOT_TESTABLE, VERDICTS, NotTestableError, Range, Verdict
from burridge_knopoff.provenance.sources import provenance
from burridge_knopoff.study.paper import PAPER_LAWS


def judge(claim: Claim, evidence: Evidence, parameters: Mapping[str, Any] | None = None) -> Verdict:
    """Return the verdict on a claim; «not testable», with the reason, if the study's data cannot judge it.

    parameters : replace the claim's own
    """
    parameters = claim.parameters if parameters is None else parameters
    try:
        evidence.check_setting()
        evidence.check_laws(_claim_laws(parameters))
        return claim.judge(evidence, **parameters)
    except NotTestableError as error:
        return Verdict(NOT_TESTABLE, f"Not testable here: {error}.")


def _claim_laws(parameters: Mapping[str, Any]) -> list[str]:
    """Return the laws that a claim is about."""
    return np.atleast_1d(parameters.get("laws", parameters.get("law", PAPER_LAWS))).tolist()


def _add_changes(claim: Claim, evidence: Evidence, verdict: Verdict, others: Sequence[tuple[str, Evidence]]) -> Verdict:
    """Return a verdict with the choices that would change it, and where rounded states reach another attractor."""
    changes = [verdict.changes] if verdict.changes else []
    a = claim.parameters.get("a")
    if at := claim.parameters.get("at"):
        a = Range(first=at, last=at)
    if verdict.verdict != NOT_TESTABLE and a and "initial" in claim.parameters and claim.topic != "model":
        states = np.atleast_1d(claim.parameters["initial"]).tolist()
        changes += rounded_state_changes(evidence, states, _claim_laws(claim.parameters), a)
    found = changing_choices(partial(judge, claim), evidence, claim.parameters, verdict, others)
    return replace(verdict, changes="; ".join(changes), changing_choices=found)


def _search_depth(evidence: Evidence) -> str:
    """Describe the depth of the study's search for attractors; empty without a search."""
    try:
        attrs = evidence.summary("refined").attrs
    except NotTestableError:
        return ""
    return (
        f"95 % intervals of basin fractions ±{100.0 * attrs['fraction_width']:g} %, changes along a located within "
        f"{attrs['refine_resolution']:g}, periodic orbits up to a period of {attrs['refine_longest_period']:g}"
    )


def ledger(study: str, claims: list[Claim], evidence: Evidence, figures: Collection[str]) -> dict[str, Any]:
    """Return the judged claims as the content of claims.json, which docs/data.md describes.

    figures : names of the study's figures; a claim with another figure gets none
    """
    verdicts: dict[str, Verdict] = {}
    # A claim about other claims reads their verdicts from the evidence.
    known = replace(evidence, verdicts=verdicts)
    others = list(other_tolerances(known))
    for claim in claims:
        verdicts[claim.name] = _add_changes(claim, known, judge(claim, known), others)
    independent = [verdicts[claim.name].verdict for claim in claims if not claim.depends_on]
    return {
        "study": study,
        **{key: evidence.config[key] for key in ("v", "contact", "start")},
        "depth": _search_depth(evidence),
        **provenance(__name__),
        "counts": {name: sum(verdict.verdict == name for verdict in verdicts.values()) for name in VERDICTS},
        "independent_counts": {name: independent.count(name) for name in VERDICTS},
        "claims": [
            {
                "name": claim.name,
                "topic": claim.topic,
                "statement": claim.statement,
                "place": claim.place,
                "verdict": verdict.verdict,
                "own": verdict.own or verdict.verdict,
                "reason": verdict.reason,
                "measured": [
                    {
                        "quantity": item.quantity,
                        "value": _json_number(item.value),
                        "error": _json_number(item.error),
                        "proved": item.proved,
                    }
                    for item in verdict.measured
                ],
                "changes": verdict.changes,
                "changing_choices": list(verdict.changing_choices),
                "conventions": dict(verdict.conventions),
                "figure": claim.figure if claim.figure in figures else "",
                "depends_on": list(claim.depends_on),
            }
            for claim, verdict in zip(claims, verdicts.values(), strict=True)
        ],
    }


def _json_number(value: float | None) -> float | None:
    """Return a number for JSON: null if it is not finite."""
    return float(value) if value is not None and math.isfinite(value) else None
