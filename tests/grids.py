"""Grids of point files as tests need them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.friction import LAWS
from burridge_knopoff.initial import PAPER_STATES, InitialState
from burridge_knopoff.settings import Settings
from burridge_knopoff.summaries.points import Grid


def grid_of(folder: Path, initial: Iterable[str | InitialState], a: Mapping[str, float], **settings: Any) -> Grid:
    """Return the grid of points that `simulate` makes with these settings, under both laws, from these states."""
    states = [PAPER_STATES[state] if isinstance(state, str) else state for state in initial]
    return Grid(folder, {state.name: state for state in states}, a, dict.fromkeys(LAWS, Settings(**settings)))
