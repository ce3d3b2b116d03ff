"""The study in a folder of results, from the record of its last run."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from burridge_knopoff.messages import escape_unprintable, full_key, unknown_key_error
from burridge_knopoff.model.fields import FOLLOWS, Keys
from burridge_knopoff.provenance.record import NAME, read_study_record
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.study import Study


def recorded_study(results: str | Path) -> tuple[dict[str, Any], Study]:
    """Return the record in a folder of results and the study that it describes.

    Keys that are new since the run of an earlier version have their defaults, which mean what was done before: a key of
    another meaning has another name.

    Raises ValueError, one line that names the record, if the folder has no study, if the config has keys that this
    version lacks, or if the record was edited by hand.
    """
    record, path = read_study_record(results), Path(results, NAME)
    place = escape_unprintable(str(path))
    try:
        config = _with_new_keys(record["config"], CONFIG)
    except ValueError as error:
        raise ValueError(f"{place}: not a study of this version: {error}; run snakemake again") from None
    # A complete config is a config, except that some defaults may be refused if they are given explicitly.
    asked = {name: value for name, value in config.items() if value != CONFIG.fields[name].default}
    # A comparison of solvers that is left out has no values of a; a config cannot ask for that.
    if (solvers := asked.get("solvers", {})).get("a") == []:
        asked["solvers"] = {key: value for key, value in solvers.items() if key != "a"}
    study = load_study(asked, str(path))
    if (study.config, study.parameters) != (config, record["grid"]):
        raise ValueError(f"{place}: not a valid record; run snakemake again to rewrite it")
    # Keys in the order of the run: the order of laws and states counts.
    return record, Study(config, record["grid"])


def _with_new_keys(config: Any, keys: Keys, place: str = "") -> Any:
    """Return a complete config of any version with the defaults of keys that it lacks.

    Raises ValueError, one line, for a key that this version lacks.
    """
    if not isinstance(config, dict):
        raise ValueError(f"{place}: got {config!r}, expected keys")
    complete = dict(config)
    for name, value in config.items():
        if name not in keys.fields:
            raise unknown_key_error(place, name, sorted(keys.fields))
        if isinstance(inside := keys.fields[name].range, Keys):
            complete[name] = _with_new_keys(value, inside, full_key(place, name))
    # A key whose default follows from other keys may be missing.
    new = {name: field for name, field in keys.fields.items() if name not in config and field.default is not FOLLOWS}
    return complete | {name: field.range.form(field.default, full_key(place, name)) for name, field in new.items()}
