"""Summaries of the models of a study, each computed by the module of that name."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from importlib import import_module
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.study.model import models_of


def make(given: Given, summary: str, model: Mapping[str, Any], grid: Sequence[float]) -> xarray.Dataset:
    """Return a summary of models; model, grid : the config's description of the models, and the values of a."""
    module = import_module(f"burridge_knopoff.summaries.{summary}")
    return module.summarize(models_of(model, grid[0]), grid)
