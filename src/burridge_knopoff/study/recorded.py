"""The study in a folder of results, from the record of its last run."""

from __future__ import annotations

import contextlib
import re
from pathlib import Path
from typing import Any

from burridge_knopoff.dataset.point import point_about
from burridge_knopoff.model.fields import Keys
from burridge_knopoff.provenance.record import NAME, read_study_record, study_folder
from burridge_knopoff.provenance.seal import check_seal
from burridge_knopoff.study.config import CONFIG
from burridge_knopoff.study.load import load_study
from burridge_knopoff.study.paths import VALUE
from burridge_knopoff.study.study import Study
from burridge_knopoff.values import joined, printable

#: Keys without a default, which a complete config need not have.
_OPTIONAL = ("chain.grid", "chain.springs", "catalogue", "catalogue.low", "catalogue.high")


def recorded_study(results: str | Path) -> tuple[dict[str, Any], Study]:
    """Return the record in a folder of results and the study that it describes.

    Raises ValueError, one line that names the record, if the folder has no study, if its config has the keys of another
    version, or if the record was changed by hand.
    """
    record, path = read_study_record(results), Path(results, NAME)
    if key := _other_key(record["config"], CONFIG):
        raise ValueError(f"{printable(str(path))}: not a study of this version ({key}); run snakemake again")
    # The form of a complete config is the config itself. A default may however be refused if it is given explicitly.
    asked = {name: value for name, value in record["config"].items() if value != CONFIG.fields[name].default}
    # A comparison of solvers that is left out has no values of a; a config cannot ask for that.
    if (solvers := asked.get("solvers", {})).get("a") == []:
        asked["solvers"] = {key: value for key, value in solvers.items() if key != "a"}
    study = load_study(asked, str(path))
    if (study.config, study.parameters) != (record["config"], record["grid"]):
        raise ValueError(f"{printable(str(path))}: not the record of a study; run snakemake again, it writes it")
    return record, study


def check_result(path: Path) -> None:
    """Check that a file is intact and, in a study, that it is the expected result; other sources may have made it.

    Raises BadFile as `check_seal` does.
    """
    about, folder = None, study_folder(path)
    if folder:
        # For a file outside a run of the study, or of another version, the expected content is not known.
        with contextlib.suppress(ValueError, KeyError):
            study = recorded_study(folder)[1]
            if run := _run_of(study, path.absolute().relative_to(folder).as_posix()):
                about = point_about(study.command(**run))
    check_seal(path, about, any_sources=True)


def _run_of(study: Study, name: str) -> dict[str, str]:
    """Return the wildcards of the run whose point file has a name; empty if it is none's."""
    parts = {"law": r"\w+", "initial": r"\w+", **dict.fromkeys(study.parameters, VALUE)}
    groups = {name: f"(?P<{name}>{pattern})" for name, pattern in parts.items()}
    file = study.point_file.replace(".nc", r"\.nc").format(**groups)
    found = re.fullmatch(rf"(?:points|solvers/(?P<solver>\w+))/{file}", name)
    return found.groupdict() if found else {}


def _other_key(config: Any, keys: Keys, place: str = "") -> str:
    """Return a key that a complete config has and this version lacks, or the reverse; empty if there is none."""
    if not isinstance(config, dict):
        return place
    there = {name: field.range for name, field in keys.fields.items() if name in config}
    sections = {name: inside for name, inside in there.items() if isinstance(inside, Keys)}
    found = [joined(place, name) for name in sorted(config.keys() ^ keys.fields.keys())]
    found = [key for key in found if key not in _OPTIONAL]
    found += [_other_key(config[name], inside, joined(place, name)) for name, inside in sections.items() if not found]
    return next(filter(None, found), "")
