"""The results of a study as one tree of datasets, read on demand."""

from __future__ import annotations

from pathlib import Path
from threading import Lock
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.point import POINT_VARIABLES
from burridge_knopoff.dataset.point_identity import point_identity
from burridge_knopoff.dataset.summary import axes
from burridge_knopoff.jobs.checked import check_file
from burridge_knopoff.jobs.jobs import Jobs
from burridge_knopoff.provenance.seal import check_seal
from burridge_knopoff.study.recorded import recorded_study
from burridge_knopoff.study.study import all_points
from burridge_knopoff.values import refusal

# HDF5 is not thread-safe, and xarray's own lock does not cover everything that opening a file reads.
_ONE_AT_A_TIME = Lock()

#: Variables with one number a point.
NUMBERS = tuple(name for name, item in POINT_VARIABLES.items() if not item.dimensions and not item.coordinate)


def open_study(results: str | Path, *, points: bool = True) -> xarray.DataTree:
    """Return all points and summaries of a study as one tree; arrays are read from the files on demand.

    results : folder of a study, results/<study>
    points : whether to open all point files (some milliseconds each); without them there is no grid either

    `tree["summary/<name>"]` is a summary file, `tree["points/<law>/<initial>/a<value>"]` a point file. `tree["grid"]`
    has all variables with one number a point, over (law, initial, a), or over all parameters of the study's `grid` in
    place of a: NaN, or −1 for whole numbers, where a point is missing. docs/data.md describes all variables;
    `tree.attrs` is the config with all defaults. Leftover files, such as summaries of a stage that is now left out, are
    not opened. The files may have been made by other sources than the current ones: `bk check` tells.

    The attributes of the tree are nested, which netCDF cannot hold: `tree.attrs.clear()` before `tree.to_netcdf(…)`.
    Several threads may open studies, one after the other. While one opens, others must not read: HDF5 would crash.

    Raises ValueError, one line, if the folder holds no study of this version, or a file that is damaged or belongs to
    another study; the line has the command that remakes the file.

    >>> from burridge_knopoff import open_study
    >>> study = open_study("results/paper")
    >>> study["grid"].mean_distance.dims
    ('law', 'initial', 'a')
    >>> study["points/linearized/plus/a0.0800"].velocity.dims
    ('trajectory_time', 'block')
    """
    if not isinstance(results, str | Path):
        raise refusal("results", results, "the folder of a study, results/<study>")
    with _ONE_AT_A_TIME:
        return _tree(Path(results), points)


def _tree(results: Path, points: bool) -> xarray.DataTree:
    record, study = recorded_study(results)
    values = {name: list(values.values()) for name, values in study.parameters.items()}
    shape = len(study.laws), len(study.initial), *map(len, values.values())
    nodes = {"/": xarray.Dataset(attrs=record["config"])}
    if points:
        found = {name: np.full(shape, _absent(name)) for name in NUMBERS}
        for index, run in zip(np.ndindex(shape), all_points(study), strict=True):
            name = f"points/{study.point_file.format(**run)}"
            if (results / name).is_file():
                check_seal(results / name, point_identity(study.command(**run)), any_sources=True)
                point = nodes[name.removesuffix(".nc")] = _opened(results / name)
                for number, everywhere in found.items():
                    everywhere[index] = point.variables[number].values
        dimensions = ("law", "initial", *study.wildcards)
        nodes["grid"] = xarray.Dataset(
            {name: (dimensions, found[name], POINT_VARIABLES[name].all_attributes()) for name in NUMBERS},
            axes(law=study.laws, initial=study.initial, **values),
        )
    jobs = Jobs(study)
    files = jobs.all_files
    for path in sorted(results.glob("summary/[!.]*.nc")):
        if (name := f"summary/{path.name}") in files:
            check_file(jobs, results, name, any_sources=True)
            nodes[name.removesuffix(".nc")] = _opened(path)
    return xarray.DataTree.from_dict(nodes, name=study.name)


def _absent(name: str) -> Any:
    """Return the placeholder for the number of a missing point."""
    kind = np.dtype(POINT_VARIABLES[name].dtype)
    return kind.type(np.nan if kind.kind == "f" else -1)


def _opened(path: Path) -> xarray.Dataset:
    try:
        return xarray.open_dataset(path)
    except (OSError, RuntimeError, ValueError) as error:
        raise ValueError(f"{path}: cannot be read ({error})") from error
