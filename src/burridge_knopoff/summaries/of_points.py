"""Summaries of the points of a study, each computed by the module of that name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.summaries.points import Grid


def make(given: Given, summary: str, config: Mapping[str, Any]) -> tuple[xarray.Dataset | str, ...]:
    """Return a summary of points and of other summaries, followed by its `table` and `digest` if its module has them.

    config : the keys of the config that the module uses
    """
    module = import_module(f"burridge_knopoff.summaries.{summary}")
    dataset = module.summarize(Grid.from_job(given), *given.summaries("summaries"), **config)
    texts = [getattr(module, text)(dataset) for text in ("table", "digest") if hasattr(module, text)]
    return dataset, *texts
