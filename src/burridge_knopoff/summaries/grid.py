"""⟨J⟩, Lyapunov exponents and kinds of motion over all parameters of a study."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.summary import summary
from burridge_knopoff.motion.kind import motion_of_run
from burridge_knopoff.motion.period import SECTION
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.summaries import lyapunov, mean_distance
from burridge_knopoff.summaries.points import Grid, read_point

_READ = (
    "mean_distance",
    "mean_distance_error",
    "lyapunov_exponent",
    "lyapunov_error",
    "lyapunov_infinite_count",
    "status",
    "event_count",
)
_JUDGED = ("run_kind", "unstable", "section_period", "period")

#: As in summaries over a, with the parameters of the study in place of the dimension a.
VARIABLES = {name: {**mean_distance.VARIABLES, **lyapunov.VARIABLES}[name] for name in (*_READ, *_JUDGED)}
VARIABLES["run_kind"] = replace(
    VARIABLES["run_kind"],
    attributes={key: value for key, value in VARIABLES["run_kind"].attributes.items() if key != "comment"},
)


def summarize(
    grid: Grid, lyapunov_exponents: int, synchronization_threshold: float, motion: Mapping[str, Any]
) -> xarray.Dataset:
    """Return each variable with one number per point, over (law, initial, parameters in the order of the config).

    lyapunov_exponents : number of exponents computed in each run
    motion : the config's section of that name: thresholds of the kinds of motion
    Raises BadFile, one line, for a point that is missing, damaged or out of date.
    """
    chosen = {**motion, "synchronization_threshold": synchronization_threshold, "section": grid.section}
    settings = MotionSettings(**chosen)
    axes = tuple(grid.axes())
    variables = {name: replace(item, dimensions=(*axes, *item.dimensions[3:])) for name, item in VARIABLES.items()}
    values = {}
    for name, item in variables.items():
        shape = (*grid.shape, lyapunov_exponents) if "exponent" in item.dimensions else grid.shape
        values[name] = np.zeros(shape, dtype=item.dtype)
    for index, point in grid:
        read = read_point(grid, point, [*_READ, *SECTION, "v"])
        for name in _READ:
            values[name][index] = read[name]
        law, _, *names = point
        symmetric = grid.model_of(law, *names).chain.is_mirror_symmetric
        found = motion_of_run(read, symmetric, settings.scaled_to_velocity(float(read["v"])))
        values["run_kind"][index], values["unstable"][index] = found.kind, found.unstable
        values["section_period"][index], values["period"][index] = found.section_period, found.period
    return summary(
        "Mean distance, Lyapunov exponents and kinds of motion over several parameters",
        variables,
        values,
        grid.axes(),
        settings.attributes,
        module=__name__,
    )
