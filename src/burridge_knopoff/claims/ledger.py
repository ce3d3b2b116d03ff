"""The ledger: every claim with its verdict and what would change it."""

from __future__ import annotations

import math
from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from functools import partial
from graphlib import TopologicalSorter
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.claims.claim import Claim
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.margins import changing_choices
from burridge_knopoff.claims.paper import CLAIMS
from burridge_knopoff.claims.range import Range
from burridge_knopoff.claims.rounding import (
    count_changes,
    describe_rounding,
    other_start_changes,
    rounded_state_changes,
)
from burridge_knopoff.claims.verdict import (
    NOT_TESTABLE,
    OPEN,
    UNDECIDED,
    VERDICTS,
    NotTestableError,
    UndecidedError,
    Verdict,
)
from burridge_knopoff.provenance.sources import provenance
from burridge_knopoff.study.paper import PAPER_LAWS


def judge(claim: Claim, evidence: Evidence, parameters: Mapping[str, Any] | None = None) -> Verdict:
    """Return the verdict on a claim; «undecided» or «not testable», with the reason, if the data cannot judge it.

    parameters : replace the claim's own
    """
    parameters = claim.parameters if parameters is None else parameters
    try:
        evidence.check_setting()
        evidence.check_laws(_claim_laws(parameters))
        if claim.is_of_states:
            evidence.check_variants()
        return claim(evidence, **parameters)
    except UndecidedError as error:
        return Verdict(UNDECIDED, f"Undecided: {error}.")
    except NotTestableError as error:
        return Verdict(NOT_TESTABLE, f"Not testable here: {error}.")


def _claim_laws(parameters: Mapping[str, Any]) -> list[str]:
    """Return the laws that a claim is about."""
    return np.atleast_1d(parameters.get("laws", parameters.get("law", PAPER_LAWS))).tolist()


def _add_changes(claim: Claim, evidence: Evidence, verdict: Verdict) -> Verdict:
    """Return a verdict with the choices that would change it, and where other states or starts change the attractor.

    Under other starts a claim may have been judged already; otherwise the values of a are counted.
    """
    changes = [verdict.changes] if verdict.changes else []
    a = claim.parameters.get("a")
    if at := claim.parameters.get("at"):
        a = Range(first=at, last=at)
    if verdict.verdict not in OPEN and a and claim.is_of_states:
        states = np.atleast_1d(claim.parameters["initial"]).tolist()
        laws = _claim_laws(claim.parameters)
        if evidence.own_convention not in verdict.conventions:
            starts = other_start_changes(evidence, states, laws, a)
            changes += count_changes(starts, "with the other start {state} reaches")
        changes += count_changes(
            rounded_state_changes(evidence, states, laws, a), "some states that round to {state} reach"
        )
    choices = changing_choices(claim, partial(judge, claim), evidence, verdict)
    return replace(verdict, changes="; ".join(changes), changing_choices=choices)


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


def ledger(study: str, claims: Sequence[Claim], evidence: Evidence, figures: Collection[str]) -> dict[str, Any]:
    """Return the judged claims as the content of claims.json, which docs/data.md describes.

    figures : names of the study's figures; a claim with another figure gets none
    """
    verdicts: dict[str, Verdict] = {}
    # A claim about other claims reads their verdicts from the evidence.
    judged = replace(evidence, verdicts=verdicts)
    # Claims come after those on which they depend.
    by_name = {claim.name: claim for claim in claims}
    for name in TopologicalSorter({claim.name: claim.depends_on for claim in claims}).static_order():
        if name in by_name:
            verdicts[name] = _add_changes(by_name[name], judged, judge(by_name[name], judged))
    independent = [verdicts[claim.name].verdict for claim in claims if not claim.depends_on]
    return {
        "study": study,
        **{key: evidence.config[key] for key in ("v", "contact", "start")},
        "depth": _search_depth(evidence),
        "rounding": describe_rounding(evidence),
        **provenance(__name__),
        "counts": {name: sum(verdict.verdict == name for verdict in verdicts.values()) for name in VERDICTS},
        "independent_counts": {name: independent.count(name) for name in VERDICTS},
        "claims": [_entry(claim, verdicts[claim.name], figures) for claim in claims],
    }


def _entry(claim: Claim, verdict: Verdict, figures: Collection[str]) -> dict[str, Any]:
    """Return a claim with its verdict as an entry of claims.json."""
    return {
        "name": claim.name,
        "topic": claim.topic,
        "statement": claim.statement,
        "rule": claim.rule,
        "place": claim.place,
        "verdict": verdict.verdict,
        "own": verdict.own or verdict.verdict,
        "reason": verdict.reason,
        "measured": [
            {**vars(item), "value": _json_number(item.value), "error": _json_number(item.error)}
            for item in verdict.measured
        ],
        "changes": verdict.changes,
        "changing_choices": list(verdict.changing_choices),
        "conventions": dict(verdict.conventions),
        "figure": claim.figure if claim.figure in figures else "",
        "depends_on": list(claim.depends_on),
    }


def verdicts(
    config: Mapping[str, Any], summaries: Mapping[str, xarray.Dataset], figures: Sequence[str]
) -> tuple[str, str, str]:
    """Return the verdicts on all claims of a study as JSON, CSV and Markdown.

    config : the keys of a study's config that claims read, and the name of the study
    summaries : by name; figures : names of those pictures of the study to which claims refer
    """
    content = ledger(config["study"], list(CLAIMS.values()), Evidence(summaries, config), figures)
    return as_json(content), as_csv(content), as_markdown(content, "../figures")


def _json_number(value: float | None) -> float | None:
    """Return a number for JSON: null if it is not finite."""
    return float(value) if value is not None and math.isfinite(value) else None
