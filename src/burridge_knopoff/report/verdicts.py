"""The verdicts on the paper's statements, read from the file that the rule `claims` writes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.claims.comparison import compare
from burridge_knopoff.claims.formats import count_sentence, group_by_topic, group_untestable, topic_title
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING, UNDECIDED
from burridge_knopoff.provenance.bad_file import BadFile
from burridge_knopoff.report.findings import finding

#: Every verdict with a sign, so that the page does not distinguish them by colour alone.
SIGNS = {HOLDS: "✓", LOOSELY: "≈", CONVENTION: "⇄", READING: "◇", FAILS: "✗", UNDECIDED: "?", NOT_TESTABLE: "–"}

#: The paper's three main claims: its abstract on a < 0.1, on the linearization, and on a > 0.1.
MAIN = ("history_decides", "laws_agree", "chaotic_above")

#: What each verdict means, for a reader of the page.
MEANINGS = {
    HOLDS: "true at every value of a that the statement is about; a number, within its tolerance",
    LOOSELY: "true at nine or more in ten of these values; a number, within its looser tolerance; otherwise in the "
    "weaker sense that its rule gives",
    CONVENTION: "true under one convention, false under another; a convention is a choice of contact and start, of "
    "which the paper leaves the start open",
    READING: "true if the wording is taken one way, false if taken another; each way is a reading",
    FAILS: "false: at fewer than nine in ten of these values, by two values or more, or farther than the tolerances",
    UNDECIDED: "too close to call: one value of a more would make it nine in ten, or unknown values would decide",
    NOT_TESTABLE: "the study did not compute all that the verdict depends on",
}


@dataclass(frozen=True)
class Verdicts:
    """The judged statements of the paper.

    counts : {verdict: number of statements}, every verdict in the order of SIGNS
    independent : the same for statements that neither repeat nor follow from others
    main : the paper's main claims, each a mapping as in the file, with what was found in a sentence as `finding`
    topics : {title of a topic: its claims}; only claims that can be judged
    untestable : {reason: claims that cannot be judged for this reason}
    numbers : the paper's numbers beside the study's, see `compare`
    setting : v, contact and start for which they were judged, with the provenance
    """

    counts: dict[str, int]
    independent: dict[str, int]
    main: list[dict[str, Any]]
    topics: dict[str, list[dict[str, Any]]]
    untestable: dict[str, list[dict[str, Any]]]
    numbers: list[tuple[str, str, str, str]]
    setting: dict[str, Any]

    @property
    def judged(self) -> int:
        """Number of statements with a verdict."""
        return sum(self.counts.values()) - self.counts.get(NOT_TESTABLE, 0)

    @property
    def summary(self) -> str:
        """How many independent statements have each verdict, as a sentence."""
        return f"{count_sentence(self.independent)}."


def read_verdicts(path: str | Path | None) -> Verdicts:
    """Read the verdicts from a file; a study without claims has none.

    Raises BadFile if the rule `claims` did not write the file.
    """
    if path is None:
        return Verdicts({}, {}, [], {}, {}, [], {})
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        claims, counts, independent = (content.pop(key) for key in ("claims", "counts", "independent_counts"))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise BadFile(path, f"is not a file of verdicts ({type(error).__name__}: {error})") from None
    claims = [{**claim, "finding": finding(claim)} for claim in claims]
    main = [claim for name in MAIN for claim in claims if claim["name"] == name]
    topics = {topic_title(topic): of_topic for topic, of_topic in group_by_topic(claims).items()}
    return Verdicts(counts, independent, main, topics, group_untestable(claims), compare(claims), content)
