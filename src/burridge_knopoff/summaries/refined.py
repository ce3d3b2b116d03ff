"""The attractors of each law at all values of a: those of the grid, and those put in between where something changes.

Each law has values of its own. The file has the slots of `attractors`, over (law, value, attractor), with a over
(law, value): see `stability.continuation`.
"""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.stability.continuation import Continuation
from burridge_knopoff.stability.settings import MotionSettings, Refine, SearchSettings
from burridge_knopoff.summaries import attractors
from burridge_knopoff.summaries.slots import slot_coordinates, slot_values, slot_variables

VARIABLES = {
    "a": Variable(("value",), "f8", "friction parameter a, ascending; NaN beyond the last value of a law"),
    "in_grid": Variable(("value",), "i1", "whether a is in the grid of the study", YES_OR_NO),
    **slot_variables("value"),
}


def one_law(
    found: Continuation, settings: SearchSettings, motion: MotionSettings, refine: Refine, start: str
) -> xarray.Dataset:
    """Return the attractors of one law at all values of a; arguments as in `attractors.one_law`."""
    count = len(found.models)
    values = slot_values(found, range(count), settings.lifetime, "value")
    values["a"] = np.array([model.a for model in found.models])
    values["in_grid"] = np.isin(np.arange(count), found.grid)
    model = found.models[0]
    about = {**attractors.search_attributes(model, settings, motion, start), "refine_resolution": refine.resolution}
    title = f"Attractors at refined values of a, {model.law.name} friction law"
    return summary(title, VARIABLES, values, slot_coordinates(model.blocks), about, module=__name__)
