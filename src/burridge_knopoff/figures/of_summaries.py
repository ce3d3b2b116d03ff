"""Figures of summaries, each drawn by the module of its name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from matplotlib.figure import Figure

from burridge_knopoff.dataset.given import Given


def make(given: Given, figure: str, from_study: Mapping[str, Any]) -> Figure:
    """Return a figure of summaries; from_study : properties of the study that it shows."""
    module = import_module(f"burridge_knopoff.figures.{figure}")
    return module.draw(*given.summaries("summaries"), **from_study)
