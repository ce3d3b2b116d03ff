"""Grids of point files for tests."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.model.initial import PAPER_STATES, InitialState
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.summaries.points import Grid

#: The defaults that determine the models of a study.
PAPER_MODELS: dict[str, Any] = {
    "laws": {law: {} for law in PAPER_LAWS},
    "chain": {"coupling": 1.0, "pulling": "neighbours", "threshold": 1.0, "ends": "open"},
    "v": 0.1,
    "contact": "one_sided",
}


def grid_of(
    folder: Path,
    initial: Iterable[str | InitialState],
    a: Mapping[str, float],
    models: Mapping[str, Any] | None = None,
    **settings: Any,
) -> Grid:
    """Return the grid of points that `simulate` makes with these settings, from these states.

    models : laws, chain, v and contact of a config where they differ from the paper's
    """
    states = [PAPER_STATES[state] if isinstance(state, str) else state for state in initial]
    models = {**PAPER_MODELS, **(models or {})}
    models["chain"] = {**models["chain"], "blocks": states[0].blocks}
    runs = dict.fromkeys(models["laws"], Settings(**settings))
    return Grid(folder, {state.name: state for state in states}, {"a": a}, runs, models)
