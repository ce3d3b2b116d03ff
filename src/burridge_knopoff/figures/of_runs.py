"""Figures of single runs, each drawn by the module of its name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from matplotlib.figure import Figure

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.summaries.points import Grid, open_point


def make(given: Given, figure: str, from_study: Mapping[str, Any]) -> Figure:
    """Return a figure of runs, by initial state; from_study : properties of the study that it shows."""
    module, grid = import_module(f"burridge_knopoff.figures.{figure}"), Grid.from_job(given)
    return module.draw({initial: open_point(grid, law, initial, a) for _, (law, initial, a) in grid}, **from_study)
