"""Lyapunov exponents over (law, initial, a), and the kind of motion that follows from them and the section points."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.point import STATUS_FLAG
from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.dataset.variables import PERIOD, YES_OR_NO, Variable, flag
from burridge_knopoff.motion.kind import MotionKind, is_zero_exponent, motion_of_run
from burridge_knopoff.motion.period import SECTION
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.summaries.points import Grid, read_point

_AXES = ("law", "initial", "a")
VARIABLES = {
    "lyapunov_exponent": Variable(
        (*_AXES, "exponent"),
        "f8",
        "Lyapunov exponents in the window, in descending order",
        {"ancillary_variables": "lyapunov_error status"},
    ),
    "lyapunov_error": Variable(
        (*_AXES, "exponent"), "f8", "error of a Lyapunov exponent, from batches and from the length of the window"
    ),
    "lyapunov_infinite_count": Variable(_AXES, "i4", "number of Lyapunov exponents known to be -infinity"),
    "run_kind": Variable(
        _AXES,
        "i1",
        "kind of motion that the run alone shows",
        flag("i1", MotionKind) | {"comment": "agreement.nc has the kind of the attractor that the run has reached"},
    ),
    "zero_exponent_count": Variable(_AXES, "i2", "number of computed exponents that cannot be distinguished from 0"),
    "unstable": Variable(_AXES, "i1", "whether the run has stayed on an unstable periodic orbit", YES_OR_NO),
    "section_period": Variable(
        _AXES, "i2", "number of upward section points after which the state of all blocks repeats, 0 if it does not"
    ),
    "period": Variable(_AXES, "f8", *PERIOD),
    "mean_distance": Variable(_AXES, "f8", "time average <J> of the phase-space distance between the end blocks"),
    "status": Variable(_AXES, "i1", "how the run ended", STATUS_FLAG),
}
_COPIED = ("lyapunov_exponent", "lyapunov_error", "lyapunov_infinite_count", "mean_distance", "status")


def summarize(
    grid: Grid, lyapunov_exponents: int, synchronization_threshold: float, motion: Mapping[str, Any]
) -> xarray.Dataset:
    """Return Lyapunov exponents and kinds of motion with the evidence for them.

    lyapunov_exponents : number of exponents computed in each run
    motion : the config's section of that name: thresholds of the kinds of motion
    """
    chosen = {**motion, "synchronization_threshold": synchronization_threshold, "section": grid.section}
    settings = MotionSettings(**chosen).scaled_to_velocity(grid.models["v"])
    symmetric = grid.is_mirror_symmetric
    values = {}
    for name, item in VARIABLES.items():
        shape = (*grid.shape, lyapunov_exponents) if "exponent" in item.dimensions else grid.shape
        values[name] = np.zeros(shape, dtype=item.dtype)
    for index, point in grid:
        read = read_point(grid, point, [*_COPIED, *SECTION])
        for name in _COPIED:
            values[name][index] = read[name]
        found = motion_of_run(read, symmetric, settings)
        values["run_kind"][index], values["unstable"][index] = found.kind, found.unstable
        values["section_period"][index], values["period"][index] = found.section_period, found.period
        exponents = read["lyapunov_exponent"], read["lyapunov_error"]
        values["zero_exponent_count"][index] = np.count_nonzero(is_zero_exponent(*exponents, settings))
    return summary(
        "Lyapunov exponents and kinds of motion",
        VARIABLES,
        values,
        grid.axes(),
        settings.attributes,
        module=__name__,
    )
