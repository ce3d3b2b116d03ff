"""The study that a folder of results holds, by the record of its last run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from burridge_knopoff.model.fields import Keys
from burridge_knopoff.model.ranges import joined
from burridge_knopoff.provenance.record import NAME, read_study_record
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.study import Study


def recorded_study(results: str | Path) -> tuple[dict[str, Any], Study]:
    """Return the record of a folder of results, and the study that it describes.

    Raises ValueError, one line, if the folder holds no study, or one of a version whose configs have other keys.
    """
    record = read_study_record(results)
    if key := _other_key(record["config"], CONFIG):
        raise ValueError(f"{Path(results, NAME)}: not a study of this version ({key}); run snakemake again")
    return record, Study(record["config"], record["grid"])


def _other_key(config: Any, keys: Keys, place: str = "") -> str:
    """Return a key that only one of a config with all defaults and this version has; nothing if they have the same."""
    if not isinstance(config, dict):
        return place
    sections = {name: field.range for name, field in keys.fields.items() if isinstance(field.range, Keys)}
    found = [joined(place, name) for name in sorted(config.keys() ^ keys.fields.keys())]
    found += [_other_key(config[name], inside, joined(place, name)) for name, inside in sections.items() if not found]
    return next(filter(None, found), "")
