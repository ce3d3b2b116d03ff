"""Remarks on a study before it runs: where its results are replaced, and what a shortened study still contains."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

from burridge_knopoff.provenance.record import read_study_record
from burridge_knopoff.study.chunks import chunks
from burridge_knopoff.study.formatting import format_count
from burridge_knopoff.study.stages import STAGES
from burridge_knopoff.study.study import Study, all_points

#: Most rules that a line names.
MOST_RULES = 3


def replaced_results(study: Study, results: str, config_file: str, overrides: Mapping[str, Any]) -> list[str]:
    """Return a line if the values of --config change the results of a study in place.

    results : folder of the study; config_file : its config; overrides : the values of --config
    """
    if not overrides or "study" in overrides:
        return []
    try:
        if read_study_record(results)["config"] == study.config:
            return []
    except ValueError:
        # Without results there is no record; those of this run would be replaced by the next run without --config.
        pass
    return [
        f"--config {', '.join(overrides)}: {results} will hold the results of the changed config in place of those of "
        f"{config_file}; to keep both, add study=NAME to --config"
    ]


def points_of_grid(study: Study) -> list[str]:
    """Return a line with the number of points of a study of several parameters, and what such a study lacks."""
    if not study.is_plane:
        return []
    sizes = [f"{format_count(len(values), 'value')} of {name}" for name, values in study.parameters.items()]
    sizes += [format_count(len(study.laws), "law"), format_count(len(study.initial), "initial state")]
    points, parts = format_count(len(all_points(study)), "point"), format_count(len(chunks(study)), "job")
    return [
        f"{points} ({', '.join(sizes)}), simulated in {parts}; a study of several parameters has a summary, figures "
        "and a report of its points, but no attractors, basins, bifurcations or claims"
    ]


def kept_stages(study: Study, stages: Collection[str]) -> list[str]:
    """Return a line with those of some stages that a study with `without` still contains."""
    if study.is_plane or not study.config["without"]:
        return []
    kept = [stage for stage in STAGES if stage in stages]
    if not kept:
        return []
    return [
        f"without {', '.join(study.omitted_stages)}: the study still contains {', '.join(kept)} (only the figures of "
        "the paper: snakemake curves)"
    ]


def changed_params(changes: Mapping[str, Sequence[str]]) -> list[str]:
    """Return a line for each change of the config, or of the sources, since the files of some rules were made.

    changes : {change: rules}, see `check.changes`
    """
    return [
        f"changed: {change} ({', '.join(rules[:MOST_RULES])}{f' and {len(rules) - MOST_RULES} more' * truncated})"
        for change, rules in changes.items()
        for truncated in [len(rules) > MOST_RULES]
    ]
