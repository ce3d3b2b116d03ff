"""The parts of a config on which the files of jobs depend."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from burridge_knopoff.study.model import MODEL_KEYS
from burridge_knopoff.study.study import Study

#: {property of `Study` on which a rule depends: what a study needs to have it}
_CONDITIONS = {
    "has_several_laws": "a second law in `laws`",
    "has_synchronized_orbit": "a mirror-symmetric chain of 3 blocks",
    "has_one_chain": "the same chain at all points",
}


def keys(study: Study, *names: str) -> dict[str, Any]:
    """Return these keys of the config."""
    return {name: study.config[name] for name in names}


def basin_keys(study: Study, *unused: str) -> dict[str, Any]:
    """Return the keys of `basins` that a job uses, except those that are passed by other names or change no map."""
    others = {"a", "initial", "threads", *unused}
    return {key: value for key, value in study.config["basins"].items() if key not in others}


def catalogue_keys(study: Study) -> dict[str, Any]:
    """Return the keys of `catalogue` on which a run depends; those of the fit affect only the statistics."""
    others = {"a", "initial", "low", "high"}
    return {key: value for key, value in study.config["catalogue"].items() if key not in others}


def catalogue_run_config(study: Study, law: str) -> dict[str, Any]:
    """Return start, solver and step of the points, with which catalogues are recorded."""
    settings = study.settings(law)
    return {"start": settings.start, "solver": settings.solver, "step": settings.step}


def motion_config(study: Study) -> dict[str, Any]:
    """Return the criteria by which kinds of motion are distinguished."""
    return {**study.config["motion"], **keys(study, "synchronization_threshold", "section")}


def model_config(study: Study, laws: Collection[str] | None = None) -> dict[str, Any]:
    """Return the keys that define the models of a study under some of its laws, by default all: see `model_of`."""
    chosen = study.laws if laws is None else laws
    return {**keys(study, *MODEL_KEYS), "laws": {law: study.config["laws"][law] for law in chosen}}


def other_length_config(study: Study, laws: Collection[str] | None = None) -> dict[str, Any]:
    """Return the keys of `model_config` for chains of other lengths."""
    config = model_config(study, laws)
    return {**config, "chain": {name: value for name, value in config["chain"].items() if name != "blocks"}}


def length_refusal(study: Study) -> str:
    """Return the reason why a study can have no chains of other lengths; empty if it can."""
    if key := study.single_length_key:
        return f"chain.{key}: got {study.config['chain'][key]}, expected one number for chains of other lengths"
    return ""


def condition_refusal(study: Study, condition: str) -> str:
    """Return what a study needs to meet a condition, the name of a property of `Study`; empty if it meets it."""
    if not condition or getattr(study, condition):
        return ""
    return f"it needs {_CONDITIONS.get(condition, condition)}"


def law_jobs(study: Study) -> list[dict[str, str]]:
    """Return the wildcards of a job for each law."""
    return [{"law": law} for law in study.laws]
