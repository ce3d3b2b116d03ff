"""The catalogue of slip events of one run of a study."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import xarray

from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.catalogue.slip_events import catalogue_of_run
from burridge_knopoff.dataset.given import Given
from burridge_knopoff.model.initial import initial_state
from burridge_knopoff.study.model import model_of


def make(
    given: Given,
    model: Mapping[str, Any],
    a: float,
    state: Mapping[str, Any],
    run: Mapping[str, Any],
    catalogue: Mapping[str, Any],
) -> xarray.Dataset:
    """Return the slip events of a run; run : its start, solver and step; the other arguments as in a config."""
    settings = CatalogueSettings(**catalogue)
    return catalogue_of_run(model_of(model, given.law, a), initial_state(**state), settings, **run)
