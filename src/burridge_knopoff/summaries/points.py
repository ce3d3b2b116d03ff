"""Reading of point files, with a check that each file contains the run that its name promises."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.run import open_run
from burridge_knopoff.dataset.summary import axes
from burridge_knopoff.study.study import Study

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
        return xarray.load_dataset(path, engine="netcdf4")


def all_events(run: Mapping[str, np.ndarray]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return time, block and kind of all events of a run whose variables EVENTS have been read."""
    time, block, kind = (np.concatenate([run[f"earlier_event_{name}"], run[f"event_{name}"]]) for name in _EVENT)
    return time, block, kind
