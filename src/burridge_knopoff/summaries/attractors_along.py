"""The attractors of a model along a parameter in one Dataset: branches, basin fractions and changes.

What `attractors.nc` and `bifurcations.nc` hold as well has their names.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from contextlib import suppress
from dataclasses import replace
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.attractors.table import NAMES, name_branches, slot_values, slot_variables
from burridge_knopoff.continuation.attractor_continuation import Continuation
from burridge_knopoff.continuation.branch_changes import BranchChange, branch_changes
from burridge_knopoff.continuation.settings import RefinementSettings
from burridge_knopoff.dataset.columns import Column, column_values
from burridge_knopoff.dataset.summary import axes, summary
from burridge_knopoff.dataset.variables import Variable, xarray_variables
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.settings import MotionSettings
from burridge_knopoff.summaries.attractors import search_attributes
from burridge_knopoff.summaries.bifurcations import BIFURCATIONS
from burridge_knopoff.summaries.branch_numbering import (
    common_branch_names,
    number_in_order,
    number_intermediate_branches,
    renumber,
)
from burridge_knopoff.summaries.branches_along import branch_values, branch_variables


def summarize(
    continuation: Continuation, settings: SearchSettings, motion: MotionSettings, refine: RefinementSettings, start: str
) -> xarray.Dataset:
    """Return the attractors at the values of the grid, and the changes of their branches.

    continuation : the result of the search with these settings
    """
    parameter, plain = continuation.parameter, plain_name(continuation.parameter)
    model = continuation.models[continuation.grid[0]]
    variables = branch_variables(parameter)
    grid = xarray.Dataset(xarray_variables(variables, branch_values(continuation, settings.lifetime)))
    everywhere = _at_all_values(continuation, settings.lifetime, refine)
    numbers: dict[int, int] = {n: n for n in np.unique(grid["branch"].values).tolist() if n >= 0}
    (order,) = number_intermediate_branches([{0: 0} | number_in_order([grid], [numbers])], [everywhere])
    for data in (grid, everywhere):
        for name in [name for name in data.variables if str(name).endswith("branch")]:
            data[name] = data[name].copy(data=renumber(data[name].values, order))
    names = common_branch_names(_with_names(everywhere), _with_names(grid))
    changes, change_values = _changes(branch_changes(grid, everywhere, plain), everywhere, parameter)
    values: dict[Any, Any] = {**grid.variables, **{name: names[name] for name in NAMES}, **change_values}
    others = _numbers(model, parameter)
    further = {name: Variable((), "f8", f"parameter {name}", coordinate=True) for name in others}
    further["law"] = Variable((), "O", "friction law", coordinate=True)
    along = {parameter: [continuation.values[k] for k in continuation.grid], "block": range(1, model.blocks + 1)}
    coordinates = axes(further, **along, **others, law=model.law.name)
    about = {**search_attributes(model, settings, motion, start), "refine_resolution": refine.resolution}
    about |= {"refine_longest_period": refine.longest_period, "history": "burridge_knopoff.continue_attractors"}
    attributes = {name: value for name, value in about.items() if name not in coordinates}
    title = f"Attractors along {parameter}, {model.law.name} friction law"
    return summary(title, {**variables, **NAMES, **changes}, values, coordinates, attributes, module=__name__)


def reserved_names() -> set[str]:
    """Return the names of variables and dimensions, which no parameter of a law can have as a coordinate."""
    variables = {**branch_variables("a"), **NAMES}
    dimensions = {name for item in variables.values() for name in item.dimensions}
    return {*variables, *dimensions, *BIFURCATIONS, "bifurcation", "block", "law"} - {"a", "v"}


def _numbers(model: Model, parameter: str) -> dict[str, float]:
    """Return the values of the other parameters that are one number."""
    numbers = {}
    for name in {*model.parameter_names} - reserved_names():
        with suppress(ValueError):
            numbers[name] = model.parameter(name)
    return {name: numbers[name] for name in model.parameter_names if name in numbers and name != parameter}


def _at_all_values(continuation: Continuation, least_lifetime: float, refine: RefinementSettings) -> xarray.Dataset:
    """Return the attractors at the values of the grid and at those inserted, in the form of `refined.nc`."""
    places = range(len(continuation.models))
    rows = [continuation.rows(k) for k in places]
    values = slot_values(continuation.models, rows, least_lifetime, "value")
    data = xarray_variables(slot_variables("value"), values)
    data[plain_name(continuation.parameter)] = "value", continuation.values
    data["in_grid"] = "value", np.isin(places, continuation.grid)
    return xarray.Dataset(data, attrs={"refine_longest_period": refine.longest_period})


def _with_names(data: xarray.Dataset) -> xarray.Dataset:
    """Return the attractors with the names of their branches."""
    names = name_branches(*(data[name].values for name in ("branch", "symmetry", "stop_rate", "kind")))
    return data.assign(xarray_variables(NAMES, names))


def _changes(
    changes: Sequence[BranchChange], table: xarray.Dataset, parameter: str
) -> tuple[dict[str, Column], dict[str, np.ndarray]]:
    """Return the columns of the changes, those of `bifurcations.nc` that need no periodic orbit, and their values.

    The kind of motion is undetermined where the branch does not exist.
    """
    kind, at = table["kind"].values, table[plain_name(parameter)].values

    def motion(k: int, slot: int) -> int:
        return int(kind[k, slot]) if slot >= 0 else MotionKind.UNDETERMINED

    values: dict[str, tuple[str, Callable[[BranchChange], float]]] = {
        "change": ("change of the branch of attractors", lambda item: item.change),
        "from_branch": (
            f"branch at smaller {parameter}: or to which the branch at larger {parameter} leads",
            lambda item: item.from_branch,
        ),
        "to_branch": (
            f"branch at larger {parameter}: or to which the branch at smaller {parameter} leads",
            lambda item: item.to_branch,
        ),
        "grid_low": (
            f"largest {parameter} below: largest value at which the branch is unchanged",
            lambda item: at[item.low],
        ),
        "grid_high": (
            f"smallest {parameter} above: smallest value at which the branch has changed",
            lambda item: at[item.high],
        ),
        "motion_before": ("kind of motion at grid_low", lambda item: motion(item.low, item.before)),
        "motion_after": ("kind of motion at grid_high", lambda item: motion(item.high, item.after)),
    }
    columns = {
        name: replace(BIFURCATIONS[name], description=text, value=value) for name, (text, value) in values.items()
    }
    return columns, column_values(
        columns, {(k,): item for k, item in enumerate(changes)}, {"bifurcation": len(changes)}
    )
