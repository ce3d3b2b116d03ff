"""The attractors of one model in one call, in the form of `attractors.nc`."""

from __future__ import annotations

from collections.abc import Sequence

import xarray

from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.attractors.stored_returns import KnownAttractors, known_attractors, returns_of_law
from burridge_knopoff.continuation.attractor_continuation import continue_attractors
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.summaries.attractors import one_law
from burridge_knopoff.summaries.branch_numbering import branch_numbers, merge


def coexisting_attractors(
    model: Model,
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
) -> tuple[xarray.Dataset, KnownAttractors]:
    """Return the attractors of a model, in the form of `attractors.nc` and as arguments of `label_states`.

    settings, motion, starts, start : see `find_attractors`

    Raises ValueError if an initial state does not fit the model, and if no attractor is found.
    """
    continuation = continue_attractors([model], settings, motion, starts=starts, start=start)
    if not continuation.attractors[0]:
        raise ValueError(
            f"transient: got {settings.transient:g}, at which no attractor was found at {model.place}; expected a "
            f"longer one, or more than window {settings.window:g}, time_limit {settings.time_limit:g}, samples "
            f"{settings.samples} (if friction does not depend on speed there is no attractor)"
        )
    parts = [one_law(continuation, starts, settings, motion, start)]
    dataset = merge(parts, branch_numbers(parts, [model], settings))
    dataset.attrs["history"] = "burridge_knopoff, from sampled initial states"
    returns = returns_of_law([model], [continuation.rows(0)], {})
    return dataset, known_attractors(dataset, returns, model)
