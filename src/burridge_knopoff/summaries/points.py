"""Reading of point files, with a check that each file contains the run that its name promises."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.columns import empty_columns
from burridge_knopoff.dataset.point import POINT_VARIABLES, RAGGED_DIMENSIONS, with_run_coordinates
from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.dataset.summary import axes
from burridge_knopoff.dataset.variables import TIMES, xarray_variables
from burridge_knopoff.messages import refusal, suggestion
from burridge_knopoff.study.study import Study, all_points

_EVENT = ("time", "block", "kind")

#: The variables of a point file that hold all its events.
EVENTS = tuple(f"{part}event_{name}" for part in ("earlier_", "") for name in _EVENT)


def point_axes(study: Study) -> dict[str, Any]:
    """Return the coordinates of a summary over (law, initial, a), or the study's parameters in place of a."""
    values = {name: list(values.values()) for name, values in study.parameters.items()}
    return axes(law=study.laws, initial=study.initial, **values)


def read_point(study: Study, results: Path, point: Mapping[str, str], names: Sequence[str]) -> dict[str, np.ndarray]:
    """Return the named variables of one run.

    results : folder of the study; point : the wildcards of the run, see `Study.run_of`
    Raises BadFile, one line, if the file is missing, corrupt, or another run.
    """
    with open_run(results / study.run_file(**point), study.command(**point)) as dataset:
        return {name: dataset[name][...] for name in names}


def open_point(study: Study, results: Path, point: Mapping[str, str]) -> xarray.Dataset:
    """Return one run as an xarray Dataset, loaded into memory; parameters and errors are those of `read_point`."""
    path = results / study.run_file(**point)
    with open_run(path, study.command(**point)):
        return with_run_coordinates(xarray.load_dataset(path, engine="netcdf4"))


def combine_points(study: Study, results: Path, names: Collection[str] = ()) -> xarray.Dataset:
    """Return variables of the points in the results as a Dataset over the coordinates of `point_axes`, in memory.

    results : folder of the study
    names : of the variables, by default all of the same size in every run

    Values of points that are not there are missing. Parameters of a law are coordinates only if the study has one law.
    Raises ValueError, one line, for any other name, and BadFile, one line, for a point that is corrupt or another run,
    and if no point is there.
    """
    common = {
        name: item
        for name, item in POINT_VARIABLES.items()
        if not (item.coordinate or name in TIMES.values() or {*item.dimensions} & {*RAGGED_DIMENSIONS})
    }
    for name in names:
        if name not in common:
            raise refusal("names", name, f"variables over neither events nor crossings{suggestion(name, common)}")
    grid = point_axes(study)
    variables = {name: replace(common[name], dimensions=(*grid, *common[name].dimensions)) for name in names or common}
    places = np.ndindex(*(len(values) for _, values, _ in grid.values()))
    points = dict(zip(places, all_points(study), strict=True))
    present = {place: point for place, point in points.items() if (results / study.run_file(**point)).is_file()}
    first = open_point(study, results, next(iter((present or points).values()))).drop_dims(RAGGED_DIMENSIONS)
    coordinates = {
        name: values.variable
        for name, values in first.coords.items()
        if name not in grid and (len(study.laws) == 1 or f"law_{name}" not in first.attrs)
    }
    sizes = {f"{name}": size for name, size in first.sizes.items()}
    values = empty_columns(variables, sizes | {name: len(values) for name, (_, values, _) in grid.items()})
    attributes = first.attrs
    for place, point in present.items():
        with open_run(results / study.run_file(**point), study.command(**point)) as dataset:
            for name, array in values.items():
                array[place] = dataset[name][...]
            of_run = vars(dataset)
            attributes = {
                name: value
                for name, value in attributes.items()
                if name in of_run and np.array_equal(value, of_run[name])
            }
    return xarray.Dataset(xarray_variables(variables, values), {**grid, **coordinates}, attributes)


def all_events(run: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run whose variables EVENTS have been read."""
    time, block, kind = (np.concatenate([run[f"earlier_event_{name}"], run[f"event_{name}"]]) for name in _EVENT)
    return time, block, kind
