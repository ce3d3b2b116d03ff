"""The parts of a config that decide what jobs make."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any

from burridge_knopoff.study.model import MODEL_KEYS
from burridge_knopoff.study.study import Study


def keys(study: Study, *names: str) -> dict[str, Any]:
    """Return these keys of the config."""
    return {name: study.config[name] for name in names}


def basin_keys(study: Study, *unused: str) -> dict[str, Any]:
    """Return the keys of `basins` that a job uses, without those that have a name of their own or change no map."""
    others = {"a", "initial", "threads", *unused}
    return {key: value for key, value in study.config["basins"].items() if key not in others}


def catalogue_keys(study: Study) -> dict[str, Any]:
    """Return the keys of `catalogue` that decide a run: those of the fit decide the statistics only."""
    others = {"a", "initial", "low", "high"}
    return {key: value for key, value in study.config["catalogue"].items() if key not in others}


def catalogue_run(study: Study, law: str) -> dict[str, Any]:
    """Return start, solver and step of the runs that record catalogues, which are those of the points."""
    settings = study.settings(law)
    return {"start": settings.start, "solver": settings.solver, "step": settings.step}


def motion_config(study: Study) -> dict[str, Any]:
    """Return how kinds of motion are distinguished."""
    return {**study.config["motion"], **keys(study, "synchronization_threshold", "section")}


def model_config(study: Study, laws: Collection[str] | None = None) -> dict[str, Any]:
    """Return what decides the models of a study under some of its laws, by default all: see `study.model.model_of`."""
    chosen = study.laws if laws is None else laws
    return {**keys(study, *MODEL_KEYS), "laws": {law: study.config["laws"][law] for law in chosen}}


def other_length_config(study: Study, laws: Collection[str] | None = None) -> dict[str, Any]:
    """Return the same for chains of other lengths."""
    config = model_config(study, laws)
    return {**config, "chain": {name: value for name, value in config["chain"].items() if name != "blocks"}}


def refused_length(study: Study) -> str:
    """Return why a study has no chains of other lengths; empty if it may have."""
    if key := study.single_length_key:
        return f"chain.{key}: got {study.config['chain'][key]}, expected one number for chains of another length"
    return ""


def of_laws(study: Study) -> list[dict[str, str]]:
    """Return the wildcards of a job for each law."""
    return [{"law": law} for law in study.laws]
