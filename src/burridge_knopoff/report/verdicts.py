"""The verdicts on the paper's statements, read from the file that the rule `claims` writes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.claims.formats import group_by_topic, group_untestable
from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, READING
from burridge_knopoff.provenance.seal import BadFile

#: Every verdict with a sign, so that the page does not distinguish them by colour alone.
SIGNS = {HOLDS: "✓", LOOSELY: "≈", CONVENTION: "⇄", READING: "◇", FAILS: "✗", NOT_TESTABLE: "–"}


@dataclass(frozen=True)
class Verdicts:
    """The judged statements of the paper.

    counts : {verdict: number of statements}, every verdict in the order of SIGNS
    independent : the same for statements that neither repeat nor follow from others
    topics : {topic: its claims}, each claim a mapping as in the file; only claims that can be judged
    untestable : {reason: claims that cannot be judged for this reason}
    setting : v, contact and start for which they were judged, with the provenance
    """

    counts: dict[str, int]
    independent: dict[str, int]
    topics: dict[str, list[dict[str, Any]]]
    untestable: dict[str, list[dict[str, Any]]]
    setting: dict[str, Any]


def read_verdicts(path: str | Path | None) -> Verdicts:
    """Read the verdicts from a file; a study without claims has none.

    Raises BadFile if the rule `claims` did not write the file.
    """
    if path is None:
        return Verdicts({}, {}, {}, {}, {})
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        claims, counts, independent = (content.pop(key) for key in ("claims", "counts", "independent_counts"))
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise BadFile(path, f"is not a file of verdicts ({type(error).__name__}: {error})") from None
    return Verdicts(counts, independent, group_by_topic(claims), group_untestable(claims), content)
