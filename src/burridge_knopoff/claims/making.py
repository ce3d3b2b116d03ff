"""The claims of a study: their verdicts, as JSON, CSV and Markdown."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.claims.claim import FILE, claims_of
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.ledger import ledger
from burridge_knopoff.dataset.given import Given
from burridge_knopoff.study.yaml_file import read_yaml


def make(given: Given, config: Mapping[str, Any]) -> tuple[str, str, str]:
    """Return the verdicts in the three formats; config : the keys that judges read, and the name of the study."""
    paths = given.paths("summaries")
    summaries = dict(zip((path.stem for path in paths), given.summaries("summaries"), strict=True))
    content = ledger(config["study"], claims_of(read_yaml(FILE)), Evidence(summaries, config), given.figures)
    return as_json(content), as_csv(content), as_markdown(content, "../figures")
