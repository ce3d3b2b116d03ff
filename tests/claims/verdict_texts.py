"""The exact text and numbers of each verdict, in all cases of `alterations.py`.

`python -m tests.claims.verdict_texts` rewrites verdict_texts.json; check the changes before you keep them.
"""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from burridge_knopoff.claims.claim import Claim, read_claims
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.ledger import judge
from burridge_knopoff.claims.verdict import Verdict
from burridge_knopoff.figures.description import picture_names
from burridge_knopoff.model.initial import PAPER_STATES
from tests.claims.alterations import CASES, Alteration
from tests.claims.worlds import evidence, judge_means, paper_world

ROOT = Path(__file__).parents[2]
FILE = Path(__file__).with_name("verdict_texts.json")
PICTURES = picture_names(PAPER_STATES)
CLAIMS: dict[str, Claim] = {claim.name: claim for claim in read_claims(PICTURES)}


def judge_altered(name: str, alteration: Alteration) -> Verdict:
    """Return the verdict on a claim from altered data for which the paper would otherwise be right."""
    world = paper_world()
    alteration(world)
    judge_means(world)
    return judge_claim(name, evidence(world))


def judge_claim(name: str, known: Evidence) -> Verdict:
    """Return the verdict on a claim; a claim about other claims is judged by their verdicts."""
    verdicts = {other: judge(CLAIMS[other], known) for other in CLAIMS[name].parameters.get("claims", ())}
    return judge(CLAIMS[name], replace(known, verdicts=verdicts))


def format_verdict(verdict: Verdict) -> str:
    """Return a verdict, with its texts and numbers, as a line."""
    errors = ["" if item.error is None else f" ± {item.error:.3g}" for item in verdict.measured]
    measured = [f"{item.quantity}: {item.value:.7g}{end}" for item, end in zip(verdict.measured, errors, strict=True)]
    return " | ".join([verdict.verdict, verdict.own, verdict.reason, verdict.changes, *measured])


def write() -> None:
    """Write the lines of each claim, first for data for which the paper is right, then in the order of the cases."""
    cases = [(name, lambda world: None) for name in CLAIMS] + [(name, alteration) for name, _, alteration in CASES]
    found: dict[str, list[str]] = {name: [] for name in CLAIMS}
    for name, alteration in cases:
        found[name].append(format_verdict(judge_altered(name, alteration)))
    FILE.write_text(json.dumps(found, ensure_ascii=False, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    write()
