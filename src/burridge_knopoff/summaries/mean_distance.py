"""⟨J⟩ over (law, initial, a): the paper's Figs. 3a and 3b."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
import xarray

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries.points import Grid, read_point

#: Levels of J that define settling: visible to the eye, visible in a figure, synchronization threshold, rounding error.
LEVELS = (1.0e-2, 1.0e-3, 1.0e-6, 2.0e-15)
LEVEL = Variable(("level",), "f8", "level of J", coordinate=True)

_AXES = ("law", "initial", "a")
VARIABLES = {
    "mean_distance": Variable(
        _AXES,
        "f8",
        "time average <J> of the phase-space distance between the end blocks",
        {"ancillary_variables": "mean_distance_error status"},
    ),
    "mean_distance_error": Variable(_AXES, "f8", "standard error of <J> from the batch means"),
    "synchronized": Variable(_AXES, "i1", "whether <J> is below the threshold", YES_OR_NO),
    "least_friction": Variable(_AXES, "f8", "smallest friction Phi on a slipping block in the whole run"),
    "window_least_friction": Variable(_AXES, "f8", "smallest friction Phi on a slipping block in the window"),
    "window_least_spring_force": Variable(_AXES, "f8", "smallest spring force on a stuck block in the window"),
    "event_count": Variable(_AXES, "i8", "number of stops and starts in the whole run"),
    "status": Variable(_AXES, "i1", "how the run ended", STATUS_FLAG),
    "settling_time": Variable(
        (*_AXES, "level"), "f8", "earliest sampled time tau after which all samples of J are below the level"
    ),
}
_UNDEFINED = replace(
    VARIABLES["synchronized"],
    attributes={
        **VARIABLES["synchronized"].attributes,
        "comment": "synchrony is not defined: the chain is not its own mirror image",
    },
)
_READ = [name for name in VARIABLES if name not in ("synchronized", "settling_time")]


def summarize(grid: Grid, synchronization_threshold: float) -> xarray.Dataset:
    """Return ⟨J⟩, its error, the settling times of J and which points are synchronized.

    A run that did not complete has NaN and counts as not synchronized, as does every run of a chain that is not its own
    mirror image.
    """
    values = {name: np.zeros(grid.shape, dtype=item.dtype) for name, item in VARIABLES.items()}
    values["settling_time"] = np.full((*grid.shape, len(LEVELS)), np.nan)
    for index, point in grid:
        read = read_point(grid, point, [*_READ, "time", "distance"])
        for name in _READ:
            values[name][index] = read[name]
        if read["status"] == Status.COMPLETED:
            values["settling_time"][index] = settling_time(read["time"], read["distance"], LEVELS)
    values["synchronized"] = values["mean_distance"] < synchronization_threshold
    variables = VARIABLES
    if not grid.is_mirror_symmetric:
        values["synchronized"][...] = False
        variables = {**VARIABLES, "synchronized": _UNDEFINED}
    return summary(
        "Mean distance <J> between the end blocks",
        variables,
        values,
        {
            **grid.axes(),
            "level": ("level", np.array(LEVELS), LEVEL.all_attributes()),
        },
        {"synchronization_threshold": synchronization_threshold},
        module=__name__,
    )


def settling_time(time: np.ndarray, distance: np.ndarray, levels: Sequence[float]) -> list[float]:
    """Return, for each level, the earliest time after which all samples are below it, NaN if the last one is not."""
    settled = []
    for level in levels:
        first = len(distance) - int(np.argmin(np.append((distance < level)[::-1], False)))
        settled.append(float(time[first]) if first < len(distance) else np.nan)
    return settled
