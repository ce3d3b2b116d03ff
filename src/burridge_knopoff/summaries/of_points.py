"""Summaries of the points of a study, each computed by the module of that name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from inspect import signature
from typing import Any

import xarray

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.summaries.points import Grid


def make(given: Given, config: Mapping[str, Any]) -> tuple[xarray.Dataset | str, ...]:
    """Return a summary of points and other summaries, followed by its `table` and `digest` if its module has them."""
    module = import_module(given.module)
    # The keys of the config that the summary itself uses, after the grid of points.
    used = [*signature(module.summarize).parameters][1:]
    others = {name: config[name] for name in used if name in config}
    dataset = module.summarize(Grid.from_job(given, config), *given.summaries("summaries"), **others)
    texts = [getattr(module, text)(dataset) for text in ("table", "digest") if hasattr(module, text)]
    return dataset, *texts
