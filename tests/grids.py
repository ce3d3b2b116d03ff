"""Studies of a few points, whose files tests write."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import Any

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.study.paper import PAPER_LAWS
from burridge_knopoff.study.study import Study

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
    *,
    solver: str = "series",
    **settings: Any,
) -> tuple[Study, Path]:
    """Return the study of the points that `simulate` makes with these settings, and the folder of its results.

    initial : the states, those of the paper by name
    models : laws, chain, v and contact of a config where they differ from the paper's
    """
    states = {state if isinstance(state, str) else state.name: state for state in initial}
    blocks = next(3 if isinstance(state, str) else state.blocks for state in states.values())
    config = {**PAPER_MODELS, **(models or {}), **settings}
    config["chain"] = {**config["chain"], "blocks": blocks}
    config["solver"] = dict.fromkeys(config["laws"], solver)
    config["initial"] = {
        name: {} if isinstance(state, str) else {"position": state.position, "velocity": state.velocity}
        for name, state in states.items()
    }
    return Study(config, {"a": a}), folder
