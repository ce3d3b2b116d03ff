"""The ledger: the claims in `config/claims.yaml`, each with its judge, and their verdicts as files."""

from __future__ import annotations

import csv
import inspect
import io
import json
import math
from collections.abc import Callable, Collection, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.claims import history, kinds, laws, model, motion, synchronization
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.verdict import NOT_TESTABLE, VERDICTS, NotTestableError, Range, Verdict, with_error
from burridge_knopoff.config.message import ConfigError
from burridge_knopoff.config.study import check_file, check_schema, read_schema
from burridge_knopoff.files import display_path
from burridge_knopoff.provenance import CLAIM_SOURCES, provenance

TOPICS = {
    "synchronization": synchronization,
    "history": history,
    "kinds": kinds,
    "motion": motion,
    "model": model,
    "laws": laws,
}

_RANGE = {"from": "first", "to": "last", "above": "above", "below": "below"}


@dataclass(frozen=True)
class Claim:
    """A statement of the paper, in our own words, and how it is judged.

    topic, judge, parameters : the function judge of the module topic, and its arguments
    figure : the figure of the study that shows it
    """

    name: str
    statement: str
    place: str
    topic: str
    judge: Callable[..., Verdict]
    parameters: Mapping[str, Any]
    figure: str


def read_claims(path: str | Path, schema: str | Path) -> list[Claim]:
    """Return the claims in a YAML file, in its order.

    Raises ConfigError, one line, for what the schema forbids, for a judge that does not exist, and for parameters that
    are not its.
    """
    import yaml

    file = display_path(path)
    check_file(path)
    content = yaml.safe_load(Path(path).read_text(encoding="utf-8"))
    check_schema(content, read_schema(schema), file)
    return [_claim(name, item, f"{file}: {name}") for name, item in content.items()]


def _claim(name: str, item: Mapping[str, Any], place: str) -> Claim:
    topic, function = item["judge"].split(".")
    judges = _judges(topic)
    if function not in judges:
        raise ConfigError(f"{place}.judge: {item['judge']!r} is not allowed: one of {', '.join(judges)} of {topic}")
    parameters = dict(item["parameters"])
    expected = list(inspect.signature(judges[function]).parameters)[1:]
    for key in parameters:
        if key not in expected:
            raise ConfigError(f"{place}.parameters.{key}: unknown key; allowed here: {', '.join(expected)}")
    for key in expected:
        if key not in parameters:
            raise ConfigError(f"{place}.parameters.{key}: missing; needed by {item['judge']}")
    if "a" in parameters:
        parameters["a"] = Range(**{_RANGE[key]: float(value) for key, value in parameters["a"].items()})
    statement = " ".join(item["statement"].split())
    return Claim(name, statement, item["place"], topic, judges[function], parameters, item["figure"])


def _judges(topic: str) -> dict[str, Callable[..., Verdict]]:
    """Return the judges of a topic by name: the public functions that its module defines."""
    module = TOPICS[topic]
    return {
        name: function
        for name, function in vars(module).items()
        if inspect.isfunction(function) and function.__module__ == module.__name__ and not name.startswith("_")
    }


def judge(claim: Claim, evidence: Evidence) -> Verdict:
    """Return the verdict of one claim; «not testable» with the reason where the study's data cannot judge it."""
    try:
        evidence.check_setting()
        return claim.judge(evidence, **claim.parameters)
    except NotTestableError as error:
        return Verdict(NOT_TESTABLE, f"Not testable here: {error}.")


def ledger(study: str, claims: list[Claim], evidence: Evidence, figures: Collection[str]) -> dict[str, Any]:
    """Return the judged claims as the content of claims.json, which docs/data.md describes.

    figures : names of the figures of the study; a claim whose figure is not among them has none
    """
    judged = [(claim, judge(claim, evidence)) for claim in claims]
    return {
        "study": study,
        **{key: evidence.config[key] for key in ("v", "contact", "start")},
        **provenance(CLAIM_SOURCES),
        "counts": {name: sum(verdict.verdict == name for _, verdict in judged) for name in VERDICTS},
        "claims": [
            {
                "name": claim.name,
                "topic": claim.topic,
                "statement": claim.statement,
                "place": claim.place,
                "verdict": verdict.verdict,
                "reason": verdict.reason,
                "measured": [
                    {"quantity": item.quantity, "value": _number(item.value), "error": _number(item.error)}
                    for item in verdict.measured
                ],
                "changes": verdict.changes,
                "conventions": dict(verdict.conventions),
                "figure": claim.figure if claim.figure in figures else "",
            }
            for claim, verdict in judged
        ],
    }


def _number(value: float | None) -> float | None:
    """Return a number as JSON knows it: null where it is not finite."""
    return float(value) if value is not None and math.isfinite(value) else None


def as_json(content: Mapping[str, Any]) -> str:
    """Return the ledger as JSON."""
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def as_csv(content: Mapping[str, Any]) -> str:
    """Return the ledger as CSV, a line for each measured figure; a claim without figures has one line."""
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    writer.writerow(
        ["claim", "topic", "statement", "place", "verdict", "quantity", "value", "error", "reason", "changes", "figure"]
    )
    for claim in content["claims"]:
        for item in claim["measured"] or [{"quantity": "", "value": None, "error": None}]:
            writer.writerow(
                [
                    *(claim[key] for key in ("name", "topic", "statement", "place", "verdict")),
                    *(item["quantity"], _text(item["value"]), _text(item["error"])),
                    *(claim[key] for key in ("reason", "changes", "figure")),
                ]
            )
    return lines.getvalue()


def as_markdown(content: Mapping[str, Any], figures: str) -> str:
    """Return the ledger as Markdown tables, one for each topic.

    figures : folder of the figures that a table links to, relative to the file that it goes into
    """
    lines = [
        "; ".join(f"{count} {name}" for name, count in content["counts"].items()) + ".",
    ]
    for topic in TOPICS:
        claims = [claim for claim in content["claims"] if claim["topic"] == topic]
        if not claims:
            continue
        lines += [
            "",
            f"### {topic.capitalize()}",
            "",
            "| claim | verdict | why | where it changes | figure |",
            "|---|---|---|---|---|",
        ]
        for claim in claims:
            figure = f"[{claim['figure']}]({figures}/{claim['figure']}.png)" if claim["figure"] else ""
            cells = [
                f"{claim['statement']} *{claim['place']}*",
                f"**{claim['verdict']}**",
                claim["reason"],
                claim["changes"],
            ]
            lines.append("| " + " | ".join([*(cell.replace("|", "\\|") for cell in cells), figure]) + " |")
    return "\n".join(lines) + "\n"


def _text(value: float | None) -> str:
    return "" if value is None else repr(value)


def measured_text(item: Mapping[str, Any]) -> str:
    """Return a measured figure of the ledger as text, with its error."""
    return "unknown" if item["value"] is None else with_error(item["value"], item["error"])
