"""The verdicts on the paper's statements, read from the file that the rule `claims` writes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.claims.formats import group_by_topic, group_untestable
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING
from burridge_knopoff.provenance.bad_file import BadFile

#: Every verdict with a sign, so that the page does not distinguish them by colour alone.
SIGNS = {HOLDS: "✓", LOOSELY: "≈", CONVENTION: "⇄", READING: "◇", FAILS: "✗", NOT_TESTABLE: "–"}

#: The paper's three main claims: its abstract on a < 0.1, on the linearization, and on a > 0.1.
MAIN = ("history_decides", "laws_agree", "chaotic_above")

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


@dataclass(frozen=True)
class Verdicts:
    """The judged statements of the paper.

    counts : {verdict: number of statements}, every verdict in the order of SIGNS
    independent : the same for statements that neither repeat nor follow from others
    main : the paper's main claims, each a mapping as in the file
    topics : {title of a topic: its claims}; only claims that can be judged
    untestable : {reason: claims that cannot be judged for this reason}
    setting : v, contact and start for which they were judged, with the provenance
    """

    counts: dict[str, int]
    independent: dict[str, int]
    main: list[dict[str, Any]]
    topics: dict[str, list[dict[str, Any]]]
    untestable: dict[str, list[dict[str, Any]]]
    setting: dict[str, Any]

    @property
    def judged(self) -> int:
        """Number of statements with a verdict."""
        return sum(self.counts.values()) - self.counts.get(NOT_TESTABLE, 0)


def read_verdicts(path: str | Path | None) -> Verdicts:
    """Read the verdicts from a file; a study without claims has none.

    Raises BadFile if the rule `claims` did not write the file.
    """
    if path is None:
        return Verdicts({}, {}, [], {}, {}, {})
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        claims, counts, independent = (content.pop(key) for key in ("claims", "counts", "independent_counts"))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise BadFile(path, f"is not a file of verdicts ({type(error).__name__}: {error})") from None
    main = [claim for name in MAIN for claim in claims if claim["name"] == name]
    topics = {TITLES.get(topic, topic.capitalize()): of_topic for topic, of_topic in group_by_topic(claims).items()}
    return Verdicts(counts, independent, main, topics, group_untestable(claims), content)
