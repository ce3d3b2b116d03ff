"""The ledger as files, claims.json, claims.csv and claims.md, which docs/data.md describes."""

from __future__ import annotations

import csv
import io
import json
from collections.abc import Iterable, Mapping
from typing import Any

from burridge_knopoff.claims.verdict import NOT_TESTABLE


def untestable(claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return {reason: claims that cannot be judged for this reason}."""
    return _grouped("reason", (claim for claim in claims if claim["verdict"] == NOT_TESTABLE))


def by_topic(claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return {topic: claims that could be judged}."""
    return _grouped("topic", (claim for claim in claims if claim["verdict"] != NOT_TESTABLE))


def _grouped(key: str, claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    found: dict[str, list[dict[str, Any]]] = {}
    for claim in claims:
        found.setdefault(claim[key], []).append(claim)
    return found


def as_json(content: Mapping[str, Any]) -> str:
    """Return the ledger as JSON."""
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def as_csv(content: Mapping[str, Any]) -> str:
    """Return the ledger as CSV, a line for each measured number, or one line for a claim without numbers."""
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    texts = ("name", "topic", "statement", "place", "verdict", "own")
    head = ["claim", *texts[1:], "quantity", "value", "error", "proved", "reason", "changes", "turns", "figure"]
    writer.writerow(head)
    for claim in content["claims"]:
        for item in claim["measured"] or [{"quantity": "", "value": None, "error": None, "proved": False}]:
            writer.writerow(
                [
                    *(claim[key] for key in texts),
                    *(item["quantity"], _text(item["value"]), _text(item["error"]), "proved" if item["proved"] else ""),
                    *(claim["reason"], claim["changes"], "; ".join(claim["turns"]), claim["figure"]),
                ]
            )
    return lines.getvalue()


def as_markdown(content: Mapping[str, Any], figures: str) -> str:
    """Return the ledger as Markdown: a table for each topic, and a line for each reason why claims are not testable.

    figures : folder of the linked figures, relative to the Markdown file
    """
    every, independent = content["counts"], content["independent_counts"]
    lines = [
        f"{sum(independent.values())} independent statements: {_counts(independent)}.",
        "",
        f"All {sum(every.values())}, with those that repeat others or follow from them: {_counts(every)}.",
    ]
    if content["depth"]:
        lines += ["", f"Depth of the search for attractors: {content['depth']}."]
    for topic, claims in by_topic(content["claims"]).items():
        lines += [
            "",
            f"### {topic.capitalize()}",
            "",
            "| claim | verdict | why | where it changes | what would change it | figure |",
            "|---|---|---|---|---|---|",
        ]
        for claim in claims:
            figure = f"[{claim['figure']}]({figures}/{claim['figure']}.png)" if claim["figure"] else ""
            own = f" (here: {claim['own']})" if claim["own"] != claim["verdict"] else ""
            judged = f"**{claim['verdict']}**{own}"
            turning = "; ".join(claim["turns"]) or "no other choice that was tried"
            depends = f" Depends on {', '.join(claim['depends_on'])}." if claim["depends_on"] else ""
            statement = f"{claim['statement']} *{claim['place']}*{depends}"
            cells = [statement, judged, claim["reason"], claim["changes"], turning]
            lines.append("| " + " | ".join([*(cell.replace("|", "\\|") for cell in cells), figure]) + " |")
    if reasons := untestable(content["claims"]):
        lines += ["", "### Not testable", ""]
    for reason, claims in reasons.items():
        lines.append(f"- {reason} ({len(claims)}: {', '.join(claim['name'] for claim in claims)})")
    return "\n".join(lines) + "\n"


def _counts(counts: Mapping[str, int]) -> str:
    return "; ".join(f"{name}: {count}" for name, count in counts.items())


def _text(value: float | None) -> str:
    return "" if value is None else repr(value)
