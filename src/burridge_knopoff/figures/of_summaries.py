"""Figures of summaries, each drawn by the module of its name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from matplotlib.figure import Figure

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.study.study import Study


def make(given: Given, config: Mapping[str, Any]) -> Figure:
    """Return a figure of summaries, and of properties of the study that its module names."""
    module, study = import_module(given.module), Study.of_keys(config)
    properties = {name: getattr(study, name) for name in getattr(module, "FROM_STUDY", ())}
    return module.draw(*given.summaries("summaries"), **properties)
