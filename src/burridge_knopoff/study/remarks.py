"""What a user may not expect of a study, told before it runs."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Mapping
from typing import Any

from burridge_knopoff.model.initial import PAPER_V, PaperState, has_paper_numbers
from burridge_knopoff.model.parameters import remarks_on_states
from burridge_knopoff.study.study import Study


def remarks(study: Study, given: Mapping[str, Any]) -> list[str]:
    """Return lines on missing parts and on numbers that do not follow the model; given : the config as written."""
    return [*_on_parts(study, given), *_on_states(study)]


def _on_parts(study: Study, given: Mapping[str, Any]) -> Iterator[str]:
    if study.blocks == 1:
        yield "one block: J = 0; no basins, phases or synchronized orbit, which need two end blocks"
    elif given.get("basins") and "basins" not in study.omitted_stages and not study.basin_maps:
        yield "basins: no map, since no default value of basins.a is on the grid; set basins.a"


def _on_states(study: Study) -> Iterator[str]:
    states = [study.state(name) for name in study.initial]
    yield from remarks_on_states(states, (name for name, values in study.parameters.items() if len(values) > 1))
    velocities: Iterable[float] = study.parameters.get("v", {"": study.config["v"]}).values()
    fixed = [state.name for state in states if has_paper_numbers(state) and not isinstance(state, PaperState)]
    if fixed and {*velocities} != {PAPER_V}:
        yield (
            f"initial: {', '.join(fixed)}: the numbers of the paper, which are for v = {PAPER_V:g}; with "
            f"{', '.join(f'{name}: {{}}' for name in fixed)} they follow v"
        )
