"""The catalogue of slip events of one run of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray

from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.catalogue.slip_events import catalogue_of_run
from burridge_knopoff.model.fields import settings_from_config
from burridge_knopoff.model.initial import initial_state
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.model import model_of


def events_of_run(config: Mapping[str, Any], law: str) -> xarray.Dataset:
    """Return the slip events of a run; config : the keys of a study's config that define it, with its a."""
    (state,) = config["initial"].items()
    run = settings_from_config(Settings, {**config, "solver": config["solver"][law]})
    return catalogue_of_run(
        model_of(config, law, config["a"]),
        initial_state(state[0], **state[1]),
        settings_from_config(CatalogueSettings, config["catalogue"]),
        start=run.start,
        solver=run.solver,
        step=run.step,
    )
