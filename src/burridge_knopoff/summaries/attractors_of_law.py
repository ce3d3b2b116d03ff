"""The attractors of one law along a: on the grid, at all values of a, and the section returns of those on the grid."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import xarray

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.stored_returns import returns_of_law
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.model.initial import initial_state
from burridge_knopoff.provenance.keys import digest_of
from burridge_knopoff.provenance.sources import source_fingerprint
from burridge_knopoff.study.grid import values_of
from burridge_knopoff.study.model import model_of, motion_of
from burridge_knopoff.summaries import attractors, refined


def attractors_of_law(config: Mapping[str, Any], law: str, cores: int, cache: Path) -> tuple[xarray.Dataset, ...]:
    """Return the attractors of a law on the grid, at all values of a, and their section returns.

    config : the keys of a study's config that decide them
    cores, cache : number of processes, and the folder in which a study caches what they find
    """
    models, start = [model_of(config, law, a) for a in values_of(config["a"], "a")], config["start"]
    initial = [initial_state(name, **state) for name, state in config["initial"].items()]
    settings, motion = SearchSettings(**config["attractors"]), motion_of(config)
    refine = RefinementSettings(**config["refine"])
    decides = {key: value for key, value in config.items() if key != "a"}
    digest = digest_of(decides, source_fingerprint("burridge_knopoff.continuation.attractor_continuation"))
    folder = cache / f"attractors {law}" / digest
    continuation = continue_attractors(
        models, settings, motion, refine, starts=initial, start=start, processes=cores, folder=folder
    )
    on_grid = attractors.one_law(continuation, initial, settings, motion, start)
    between = refined.one_law(continuation, settings, motion, refine, start)
    return on_grid, between, returns_of_law(models, [continuation.rows(k) for k in continuation.grid], on_grid.attrs)
