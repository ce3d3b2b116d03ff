"""Remarks on a study before it runs: where its results are replaced, and what a shortened study still contains."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.study.stages import STAGES


def replaced_results(jobs: Jobs, results: str, config_file: str, overrides: Mapping[str, Any]) -> list[str]:
    """Return a line if the values of --config change the results of a study in place.

    results : folder of the study; config_file : its config; overrides : the values of --config
    """
    if not overrides or "study" in overrides:
        return []
    try:
        if read_study_record(results)["config"] == jobs.study.config:
            return []
    except ValueError:
        # Without results there is no record; those of this run would be replaced by the next run without --config.
        pass
    return [
        f"--config {', '.join(overrides)}: {results} will hold the results of the changed config in place of those of "
        f"{config_file}; to keep both, add study=NAME to --config"
    ]


def kept_stages(jobs: Jobs) -> list[str]:
    """Return a line with the stages that a study with `without` still contains."""
    study = jobs.study
    if study.is_plane or not study.config["without"]:
        return []
    asked = {rule.stage for rule in jobs.requested()}
    kept = [stage for stage in STAGES if stage in asked]
    if not kept:
        return []
    return [
        f"without {', '.join(study.omitted_stages)}: the study still contains {', '.join(kept)} (only the figures of "
        "the paper: snakemake curves)"
    ]
