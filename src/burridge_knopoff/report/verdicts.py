"""The verdicts on the paper's statements, read from the file that the rule `claims` writes."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from burridge_knopoff.claims.verdict import CONVENTION, FAILS, HOLDS, LOOSELY, NOT_TESTABLE, content_digest, untestable
from burridge_knopoff.provenance.seal import BadFile

#: Every verdict, with the sign that stands beside its name: the page never tells them by colour alone.
SIGNS = {HOLDS: "✓", LOOSELY: "≈", CONVENTION: "⇄", FAILS: "✗", NOT_TESTABLE: "–"}


@dataclass(frozen=True)
class Verdicts:
    """The judged statements of the paper.

    counts : {verdict: number of statements}, every verdict in the order of SIGNS
    topics : {topic: its claims}, each claim a mapping as in the file, without those that cannot be judged
    untestable : {reason: claims that cannot be judged for it}
    setting : v, contact and start for which they were judged, with the provenance
    """

    counts: dict[str, int]
    topics: dict[str, list[dict[str, Any]]]
    untestable: dict[str, list[dict[str, Any]]]
    setting: dict[str, Any]


_TEXTS = ("name", "topic", "statement", "place", "verdict", "reason")


def read_verdicts(path: str | Path | None) -> Verdicts:
    """Read the verdicts; a study that judges nothing has no file of them.

    Raises BadFile if it is not such a file, and ValueError, one line that names the file, if its counts are not those
    of its claims.
    """
    if path is None:
        return Verdicts({}, {}, {}, {})
    try:
        content = json.loads(Path(path).read_text(encoding="utf-8"))
        if content["digest"] != content_digest(content):
            raise BadFile(path, "has other content than was written")
        claims = [_claim(claim) for claim in content["claims"]]
        stated = {verdict: int(content["counts"].get(verdict, 0)) for verdict in SIGNS}
    except BadFile:
        raise
    except (OSError, ValueError, KeyError, TypeError, AttributeError) as error:
        raise BadFile(path, f"is not a file of verdicts ({type(error).__name__}: {error})") from None
    counts = {verdict: sum(claim["verdict"] == verdict for claim in claims) for verdict in SIGNS}
    if counts != stated:
        raise ValueError(f"{path}: counts: {stated} is not allowed: the claims have {counts}")
    topics: dict[str, list[dict[str, Any]]] = {}
    for claim in claims:
        if claim["verdict"] != NOT_TESTABLE:
            topics.setdefault(claim["topic"], []).append(claim)
    setting = {key: value for key, value in content.items() if key not in ("claims", "counts", "digest")}
    return Verdicts(counts, topics, untestable(claims), setting)


def _claim(claim: dict[str, Any]) -> dict[str, Any]:
    for key in _TEXTS:
        if not isinstance(claim[key], str):
            raise ValueError(f"{key}: {claim[key]!r} is not allowed: text")
    verdicts = [claim["verdict"], claim.get("own") or claim["verdict"], *claim.get("conventions", {}).values()]
    for verdict in verdicts:
        if verdict not in SIGNS:
            raise ValueError(f"verdict: {verdict!r} is not allowed: {' | '.join(SIGNS)}")
    optional: dict[str, Any] = {"measured": [], "changes": "", "conventions": {}, "figure": "", "own": ""}
    return {**optional, **claim}
