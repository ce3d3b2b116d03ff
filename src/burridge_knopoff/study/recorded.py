"""The study in a folder of results, from the record of its last run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from burridge_knopoff.model.fields import FOLLOWS, Keys
from burridge_knopoff.provenance.record import NAME, read_study_record
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import Study
from burridge_knopoff.values import escape_unprintable, full_key


def recorded_study(results: str | Path) -> tuple[dict[str, Any], Study]:
    """Return the record in a folder of results and the study that it describes.

    Raises ValueError, one line that names the record, if the folder has no study, if the config has keys of another
    version, or if the record was edited by hand.
    """
    record, path = read_study_record(results), Path(results, NAME)
    if key := _unmatched_key(record["config"], CONFIG):
        raise ValueError(f"{escape_unprintable(str(path))}: not a study of this version ({key}); run snakemake again")
    # A complete config is a config, except that some defaults may be refused if they are given explicitly.
    asked = {name: value for name, value in record["config"].items() if value != CONFIG.fields[name].default}
    # A comparison of solvers that is left out has no values of a; a config cannot ask for that.
    if (solvers := asked.get("solvers", {})).get("a") == []:
        asked["solvers"] = {key: value for key, value in solvers.items() if key != "a"}
    study = load_study(asked, str(path))
    if (study.config, study.parameters) != (record["config"], record["grid"]):
        raise ValueError(f"{escape_unprintable(str(path))}: not a valid record; run snakemake again to rewrite it")
    # Keys in the order of the run, since seals depend on the order.
    return record, Study(record["config"], record["grid"])


def _unmatched_key(config: Any, keys: Keys, place: str = "") -> str:
    """Return a key that a complete config has and this version lacks, or the reverse; empty if there is none."""
    if not isinstance(config, dict):
        return place
    there = {name: field.range for name, field in keys.fields.items() if name in config}
    sections = {name: inside for name, inside in there.items() if isinstance(inside, Keys)}
    # A key whose default follows from other keys may be missing.
    own = {name for name, field in keys.fields.items() if field.default is not FOLLOWS}
    unmatched = [full_key(place, name) for name in sorted({*config} - {*keys.fields} | own - {*config})]
    if not unmatched:
        unmatched = [_unmatched_key(config[name], inside, full_key(place, name)) for name, inside in sections.items()]
    return next(filter(None, unmatched), "")
