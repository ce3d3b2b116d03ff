"""All points of a study as one Dataset over its grid."""

from __future__ import annotations

from collections.abc import Collection, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.columns import common_attributes, over_grid
from burridge_knopoff.dataset.point import POINT_VARIABLES, RAGGED_DIMENSIONS, with_run_coordinates
from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.dataset.variables import TIMES, xarray_variables
from burridge_knopoff.messages import refusal, suggestion
from burridge_knopoff.study.study import Study, all_points
from burridge_knopoff.summaries.points import open_point, point_axes


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
    places = np.ndindex(*(len(values) for _, values, _ in grid.values()))
    points = dict(zip(places, all_points(study), strict=True))
    present = {place: point for place, point in points.items() if (results / study.run_file(**point)).is_file()}
    first = with_run_coordinates(open_point(study, results, next(iter((present or points).values()))))
    coordinates = {
        name: values.variable
        for name, values in first.drop_dims(RAGGED_DIMENSIONS).coords.items()
        if name not in grid and (len(study.laws) == 1 or f"law_{name}" not in first.attrs)
    }
    sizes = {f"{name}": size for name, size in first.sizes.items() if name not in grid}
    chosen = {name: common[name] for name in names or common if {*common[name].dimensions} <= sizes.keys()}
    attributes = [first.attrs]

    def rows() -> Iterator[tuple[tuple[int, ...], dict[str, Any]]]:
        for place, point in present.items():
            with open_run(results / study.run_file(**point), study.command(**point)) as dataset:
                attributes[:] = [common_attributes([*attributes, vars(dataset)])]
                yield place, {name: dataset[name][...] for name in chosen}

    values = over_grid(chosen, {name: len(along) for name, (_, along, _) in grid.items()}, rows(), **sizes)
    variables = {name: replace(item, dimensions=(*grid, *item.dimensions)) for name, item in chosen.items()}
    return xarray.Dataset(xarray_variables(variables, values), {**grid, **coordinates}, attributes[0])
