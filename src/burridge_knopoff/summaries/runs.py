"""The scalars of all runs over (law, initial, a), or over the parameters of the study in place of a.

Each point file is checked and read once for all of them; `mean_distance`, `lyapunov` and `agreement` are expressions
over this file.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.columns import empty_columns
from burridge_knopoff.dataset.point import POINT_VARIABLES
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import YES_OR_NO, Variable
from burridge_knopoff.motion.period import SECTION, count_distinct, repetition_of
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.running.settling import LEVELS
from burridge_knopoff.running.status import Status
from burridge_knopoff.summaries.points import Grid, read_point
from burridge_knopoff.summaries.sentences import RUN as LINE
from burridge_knopoff.summaries.sentences import incomplete, lines_of

#: Dimensions of a scalar of all runs.
RUN = ("law", "initial", "a")

_COPIED = {
    name: replace(item, dimensions=(*RUN, *item.dimensions))
    for name, item in POINT_VARIABLES.items()
    if item.dimensions in ((), ("exponent",), ("level",)) and not item.coordinate
}
VARIABLES = {
    **_COPIED,
    "section_count": Variable(
        RUN, "i4", "number of section points: distinct W' at upward crossings of W = 0 in the second half of the window"
    ),
    "section_velocity_mean": Variable(RUN, "f8", "mean W' of the section: at all upward crossings of W = 0"),
    "section_velocity_min": Variable(RUN, "f8", "smallest W' of the section: at upward crossings of W = 0"),
    "section_velocity_max": Variable(RUN, "f8", "largest W' of the section: at upward crossings of W = 0"),
    "repetition_points": Variable(
        RUN, "i4", "section points until the state repeats: upward ones; 0 if the state does not repeat"
    ),
    "repetition_period": Variable(RUN, "f8", "time until the state repeats: NaN if it does not"),
    "repetition_divergence": Variable(
        RUN,
        "f8",
        "divergence of cycles: factor by which the distance of successive cycles grows, at most 1 if these converge",
    ),
    "mirror_symmetric": Variable(RUN, "i1", "mirror symmetry: whether the chain is its own mirror image", YES_OR_NO),
}


def over_runs(
    grid: Grid,
    variables: Mapping[str, Variable],
    read: Sequence[str],
    function: Callable[[Mapping[str, np.ndarray], Sequence[str]], Mapping[str, Any]],
    **sizes: int,
) -> dict[str, np.ndarray]:
    """Return the values that a function computes from each run, in arrays over (law, initial, parameters).

    variables : the first three dimensions of each are those of RUN, of which `a` stands for all parameters
    read : names of the variables of a point file that the function needs
    function : takes these variables and the names of the point; variables that it leaves out are missing
    sizes : of the further dimensions
    """
    places = {f"parameter {k}": size for k, size in enumerate(grid.shape[2:])}
    shapes = {"law": grid.shape[0], "initial": grid.shape[1], **places, **sizes}
    dimensions = {
        name: replace(item, dimensions=("law", "initial", *places, *item.dimensions[3:]))
        for name, item in variables.items()
    }
    values = empty_columns(dimensions, shapes)
    for index, point in grid:
        for name, value in function(read_point(grid, point, read), point).items():
            values[name][index] = value
    return values


def summarize(grid: Grid, period_tolerance: float, longest_period: float) -> xarray.Dataset:
    """Return the scalars of all runs.

    period_tolerance, longest_period : of a repetition, see `MotionSettings`
    Raises BadFile, one line, for a point that is missing, corrupt or out of date.
    """
    motion = MotionSettings(period_tolerance=period_tolerance, longest_period=longest_period)

    def scalars(run: Mapping[str, np.ndarray], point: Sequence[str]) -> dict[str, Any]:
        law, _, *names = point
        values: dict[str, Any] = {name: run[name] for name in _COPIED}
        values["mirror_symmetric"] = grid.model_of(law, *names).chain.is_mirror_symmetric
        if run["status"] == Status.COMPLETED:
            upward = run["crossing_velocity"][run["crossing_direction"] > 0]
            values["section_count"] = count_distinct(upward[len(upward) // 2 :])
            if len(upward):
                values |= {f"section_velocity_{name}": getattr(upward, name)() for name in ("mean", "min", "max")}
            repetition = repetition_of(run, motion.scaled_to_velocity(float(run["v"])))
            values |= {f"repetition_{name}": value for name, value in vars(repetition).items()}
        return values

    exponents = next(iter(grid.settings.values())).exponent_count(grid.chain)
    read = [*_COPIED, *SECTION, "v"]
    values = over_runs(grid, VARIABLES, read, scalars, exponent=exponents, level=len(LEVELS))
    parameters = grid.axes()
    coordinates = {**parameters, **axes({"level": POINT_VARIABLES["level"]}, level=LEVELS)}
    # A parameter of the grid has a coordinate of its own.
    if "v" not in parameters:
        coordinates["v"] = ((), grid.models["v"], POINT_VARIABLES["v"].all_attributes())
    about = {"section": str(grid.section), "period_tolerance": period_tolerance, "longest_period": longest_period}
    variables = {
        name: replace(item, dimensions=(*parameters, *item.dimensions[len(RUN) :])) for name, item in VARIABLES.items()
    }
    return summary("Scalars of all runs", variables, values, coordinates, about, module=__name__)


def digest(data: xarray.Dataset) -> str:
    """Return how many runs of each law and initial state completed."""

    def sentence(part: xarray.Dataset) -> str:
        completed = part["status"].values == Status.COMPLETED
        return next(incomplete(completed), f"all {completed.size} runs completed")

    return lines_of(data, LINE, sentence)
