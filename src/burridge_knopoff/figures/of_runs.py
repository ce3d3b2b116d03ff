"""Figures of single runs, each drawn by the module of its name."""

from __future__ import annotations

from collections.abc import Mapping
from importlib import import_module
from typing import Any

from matplotlib.figure import Figure

from burridge_knopoff.dataset.given import Given
from burridge_knopoff.summaries.points import Grid, open_point


def make(given: Given, config: Mapping[str, Any]) -> Figure:
    """Return a figure of runs, by initial state."""
    grid = Grid.from_job(given, {**config, "a": [config["figures"]["a"]]})
    runs = {initial: open_point(grid, law, initial, a) for _, (law, initial, a) in grid}
    return import_module(given.module).draw(runs)
