"""The ledger as files, claims.json, claims.csv and claims.md, which docs/data.md describes."""

from __future__ import annotations

import csv
import io
import json
import re
import textwrap
from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from burridge_knopoff.claims.verdict import (
    CONVENTION,
    FAILS,
    HOLDS,
    LOOSELY,
    NOT_TESTABLE,
    READING,
    UNDECIDED,
    join_words,
)

#: Predicates of one statement and of several, by verdict.
PREDICATES = {
    HOLDS: ("holds", "hold"),
    LOOSELY: ("holds loosely", "hold loosely"),
    CONVENTION: ("depends on the convention", "depend on the convention"),
    READING: ("is ambiguous", "are ambiguous"),
    FAILS: ("fails", "fail"),
    UNDECIDED: ("is undecided", "are undecided"),
    NOT_TESTABLE: ("cannot be tested", "cannot be tested"),
}

#: Titles of the topics of the claims.
TITLES = {
    "synchronization": "Synchronization of the end blocks",
    "history": "Dependence on the initial state",
    "kinds": "Kinds of motion",
    "locking": "Frequency locking",
    "section": "Poincaré section",
    "motion": "Motion of the blocks",
    "model": "Equations of motion and uniform sliding",
    "laws": "Linearization of the friction law",
    "blocks": "Chains of one and two blocks",
    "solvers": "Methods of solution",
}

#: What `rounding` of the ledger lists.
ROUNDING = (
    "The paper gives its initial states to three decimals. Another state that rounds to the same numbers reaches "
    "another attractor at these values of a."
)

NUMBERS = ("zero", "one", "two", "three", "four", "five", "six", "seven", "eight", "nine", "ten", "eleven", "twelve")

# Number of characters in a line of Markdown.
WIDTH = 120


def group_untestable(claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return {reason: claims that cannot be judged for this reason}."""
    return _grouped("reason", (claim for claim in claims if claim["verdict"] == NOT_TESTABLE))


def group_by_topic(claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    """Return {topic: claims of which the study has data}."""
    return _grouped("topic", (claim for claim in claims if claim["verdict"] != NOT_TESTABLE))


def _grouped(key: str, claims: Iterable[dict[str, Any]]) -> dict[str, list[dict[str, Any]]]:
    groups: dict[str, list[dict[str, Any]]] = {}
    for claim in claims:
        groups.setdefault(claim[key], []).append(claim)
    return groups


def topic_title(topic: str) -> str:
    """Return the heading of a topic."""
    return TITLES.get(topic, topic.capitalize())


def as_json(content: Mapping[str, Any]) -> str:
    """Return the ledger as JSON."""
    return json.dumps(content, ensure_ascii=False, indent=1) + "\n"


def as_csv(content: Mapping[str, Any]) -> str:
    """Return the ledger as CSV, a line for each measured number, or one line for a claim without numbers."""
    lines = io.StringIO()
    writer = csv.writer(lines, lineterminator="\n")
    texts = ("name", "topic", "statement", "place", "verdict", "own")
    numbers = ("quantity", "value", "error", "proved")
    writer.writerow(["claim", *texts[1:], *numbers, "reason", "changes", "changing_choices", "figure"])
    for claim in content["claims"]:
        for item in claim["measured"] or [{"quantity": "", "value": None, "error": None, "proved": False}]:
            writer.writerow(
                [
                    *(claim[key] for key in texts),
                    *(item["quantity"], _text(item["value"]), _text(item["error"]), "proved" if item["proved"] else ""),
                    *(claim["reason"], claim["changes"], "; ".join(claim["changing_choices"]), claim["figure"]),
                ]
            )
    return lines.getvalue()


def count_sentence(counts: Mapping[str, int]) -> str:
    """Return how many independent statements have each verdict: «Of 3 independent statements, 2 hold and 1 fails»."""
    parts = [f"{count} {PREDICATES[verdict][count > 1]}" for verdict, count in counts.items() if count]
    return f"Of {sum(counts.values())} independent statements, {join_words(parts)}"


def dependent_sentence(content: Mapping[str, Any]) -> str:
    """Return how many statements of a ledger depend on others: «nine more repeat these or follow from them.»."""
    number = sum(content["counts"].values()) - sum(content["independent_counts"].values())
    return f"{NUMBERS[number] if number < len(NUMBERS) else number} more repeat these or follow from them."


def as_markdown(content: Mapping[str, Any], figures: str) -> str:
    """Return the ledger as Markdown: a table of verdicts, a section for each claim, and the reasons not to test others.

    figures : folder of the linked figures, relative to the Markdown file
    """
    parts = [f"{count_sentence(content['independent_counts'])}; {dependent_sentence(content)}"]
    if content["depth"]:
        parts.append(f"Depth of the search for attractors: {content['depth']}.")
    if content["rounding"]:
        parts.append(f"{ROUNDING} {'. '.join(content['rounding'])}.")
    topics = group_by_topic(content["claims"])
    if topics:
        rows = [
            f"| {_cell(claim['statement'])} | {claim['verdict']}{' (dependent)' if claim['depends_on'] else ''} "
            f"| [{claim['name']}](#{claim['name']}) |"
            for claims in topics.values()
            for claim in claims
        ]
        parts.append("\n".join(["| statement | verdict | evidence |", "| --- | --- | --- |", *rows]))
    for topic, claims in topics.items():
        parts.append(f"### {topic_title(topic)}")
        for claim in claims:
            parts += _section(claim, figures)
    if reasons := group_untestable(content["claims"]):
        parts.append("### Not testable")
        for reason, claims in reasons.items():
            statements = [_item(f"{claim['statement']} *{claim['place']}* ({claim['name']})", 2) for claim in claims]
            parts.append("\n".join([_item(reason), *statements]))
    # Tables are the only lines that cannot be wrapped.
    return "\n\n".join(part if part.startswith(("|", "- ", "  ")) else _wrap(part) for part in parts) + "\n"


def _section(claim: Mapping[str, Any], figures: str) -> Iterator[str]:
    """Yield the paragraphs of one claim: statement, verdict and reason, rule, exceptions, and what would change it."""
    names = claim["depends_on"]
    yield f"#### {claim['name']}"
    yield f"*{claim['statement']}* ({claim['place']})"
    under = {CONVENTION: "under the study's convention", READING: "under the first reading"}.get(claim["verdict"])
    under_first = f" ({under}: {claim['own']})" if under else ""
    yield f"**{claim['verdict'].capitalize()}**{under_first}. {claim['reason']}"
    yield f"Rule: {claim['rule'][0].lower()}{claim['rule'][1:]}"
    if claim["changes"]:
        items = [_link(item, names) for item in claim["changes"].split("; ")]
        yield "\n".join(["Exceptions and other cases:", "", *map(_item, items)])
    if claim["changing_choices"]:
        yield "\n".join(["What would change the verdict:", "", *map(_item, claim["changing_choices"])])
    depends = f"Depends on {_link(join_words(names), names)}. " if names else ""
    figure = f"Figure: [{claim['figure']}]({figures}/{claim['figure']}.png)." if claim["figure"] else ""
    if depends or figure:
        yield f"{depends}{figure}".rstrip()


def _link(text: str, names: Iterable[str]) -> str:
    """Return a text in which the names of claims link to their sections."""
    return re.sub(r"\b[a-z_]+\b", lambda m: f"[{m[0]}](#{m[0]})" if m[0] in names else m[0], text)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _item(text: str, indent: int = 0) -> str:
    """Return an item of a list."""
    first = " " * indent + "- "
    return textwrap.fill(
        text,
        WIDTH,
        initial_indent=first,
        subsequent_indent=" " * len(first),
        break_long_words=False,
        break_on_hyphens=False,
    )


def _wrap(text: str) -> str:
    """Return a paragraph, with the list that follows it, in lines of WIDTH characters."""
    first, *rest = text.split("\n")
    return "\n".join([textwrap.fill(first, WIDTH, break_long_words=False, break_on_hyphens=False), *rest])


def _text(value: float | None) -> str:
    return "" if value is None else repr(value)
