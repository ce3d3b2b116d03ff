"""⟨J⟩ over (law, initial, a): the paper's Figs. 3a and 3b."""

from __future__ import annotations

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, flag
from burridge_knopoff.simulation import STATUS
from burridge_knopoff.summaries.points import Grid, read_point

_AXES = ("law", "initial", "a")
VARIABLES = {
    "mean_distance": Variable(
        _AXES,
        "f8",
        "time average <J> of the phase-space distance between the end blocks",
        {"ancillary_variables": "mean_distance_error status"},
    ),
    "mean_distance_error": Variable(_AXES, "f8", "standard error of <J> from the batch means"),
    "synchronized": Variable(_AXES, "i1", "whether <J> is below the threshold", flag("i1", {0: "no", 1: "yes"})),
    "least_friction": Variable(_AXES, "f8", "least friction Phi(a U') on a slipping block in the whole run"),
    "window_least_spring_force": Variable(_AXES, "f8", "least spring force s on a stuck block in the window"),
    "event_count": Variable(_AXES, "i8", "number of stops and starts in the whole run"),
    "status": Variable(_AXES, "i1", "how the run ended", flag("i1", dict(enumerate(STATUS)))),
}
_READ = [name for name in VARIABLES if name != "synchronized"]


def summarize(grid: Grid, synchronization_threshold: float) -> xarray.Dataset:
    """Return ⟨J⟩, its error and which points are synchronized; a run that did not complete has NaN and is not."""
    values = {name: np.zeros(grid.shape, dtype=item.dtype) for name, item in VARIABLES.items()}
    for index, point in grid:
        read = read_point(grid, *point, _READ)
        for name in _READ:
            values[name][index] = read[name]
    values["synchronized"] = values["mean_distance"] < synchronization_threshold
    return summary(
        "Mean distance <J> between the end blocks",
        VARIABLES,
        values,
        axes(grid.initial, list(grid.a.values())),
        {"synchronization_threshold": synchronization_threshold},
    )
