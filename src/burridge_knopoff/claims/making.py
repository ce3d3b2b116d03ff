"""The claims of a study: their verdicts, as JSON, CSV and Markdown."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import xarray

from burridge_knopoff.claims.claim import FILE, claims_of
from burridge_knopoff.claims.evidence import Evidence
from burridge_knopoff.claims.formats import as_csv, as_json, as_markdown
from burridge_knopoff.claims.ledger import ledger
from burridge_knopoff.study.yaml_file import read_yaml


def verdicts(
    config: Mapping[str, Any], summaries: Mapping[str, xarray.Dataset], figures: Sequence[str]
) -> tuple[str, str, str]:
    """Return the verdicts in the three formats.

    config : the keys of a study's config that judges read, and the name of the study
    summaries : by name; figures : names of those pictures of the study to which claims refer
    """
    content = ledger(config["study"], claims_of(read_yaml(FILE)), Evidence(summaries, config), figures)
    return as_json(content), as_csv(content), as_markdown(content, "../figures")
