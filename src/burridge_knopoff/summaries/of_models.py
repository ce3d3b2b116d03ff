"""Summaries of the models of a study, each computed by the module of that name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.model import models_of


def make(given: Given, config: Mapping[str, Any]) -> xarray.Dataset:
    """Return a summary of the models of a study."""
    grid = values_of(config["a"], "a")
    return import_module(given.module).summarize(models_of(config, grid[0]), grid)
