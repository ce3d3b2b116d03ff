"""Summary files: xarray Datasets with CF attributes."""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import Any

import netCDF4
import numpy as np
import xarray

from burridge_knopoff.dataset.variables import (
    COMPRESSED_FROM,
    COMPRESSION_LEVEL,
    TEXT,
    Variable,
    global_attributes,
    xarray_variables,
)
from burridge_knopoff.model.parameters import plain_name
from burridge_knopoff.provenance.checksum import add_checksum
from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.opening import open_whole

AXES: dict[str, Variable] = {
    "law": Variable(("law",), "O", "friction law", coordinate=True),
    "initial": Variable(("initial",), "O", "initial state", coordinate=True),
    "other_law": Variable(("other_law",), "O", "other friction law: compared with the first one", coordinate=True),
    "a": Variable(("a",), "f8", "friction parameter a", coordinate=True),
    "block": Variable(("block",), "i4", "block number: 1 to N along the chain", coordinate=True),
    "state": Variable(("state",), "i4", "number of the sampled initial state", coordinate=True),
    "part": Variable(("part",), "O", "part of a complex number", coordinate=True),
}


def axes(further: Mapping[str, Variable] | None = None, /, **values: Any) -> dict[str, Any]:
    """Return coordinates of a summary by name, each with its values: those of AXES, `further` ones, and parameters.

    The coordinate of the parameter `mass[3]` is `mass_3`: netCDF names have letters, digits and underscores only.
    """
    coordinates, variables = {}, {**AXES, **(further or {})}
    for name, along in values.items():
        plain = plain_name(name)
        item = variables.get(name, Variable((plain,), "f8", f"parameter {name}", coordinate=True))
        coordinates[plain] = item.dimensions, np.array(along, dtype=item.dtype), item.all_attributes()
    return coordinates


def summary(
    title: str,
    variables: Mapping[str, Variable],
    values: Mapping[Any, Any],
    coordinates: Mapping[Any, Any],
    attributes: Mapping[str, Any],
    *,
    module: str,
) -> xarray.Dataset:
    """Return a Dataset of variables with the values of the same names.

    values : arrays with the dimensions of the variables, or a Dataset, whose variables keep their own dimensions
    module : name of the module that computes the values
    """
    head = global_attributes(title, {"history": "snakemake, from the point files", **attributes}, module=module)
    return xarray.Dataset(xarray_variables(variables, values), dict(coordinates), head)


def write_summary(dataset: xarray.Dataset, path: str | Path) -> None:
    """Write a summary as netCDF, completely or not at all; the same Dataset gives the same bytes."""
    encoding: dict[str, dict[str, Any]] = {}
    for name, variable in dataset.variables.items():
        encoding[str(name)] = {"_FillValue": None}
        if variable.dtype.kind in TEXT:
            # Characters, since HDF5 crashes when a file with variable-length strings is opened many times.
            encoding[str(name)]["dtype"] = "S1"
        elif variable.size >= COMPRESSED_FROM:
            encoding[str(name)].update(zlib=True, complevel=COMPRESSION_LEVEL, shuffle=True)

    def write(name: str) -> None:
        # Opened once: another process that writes the same summary may remove the file meanwhile.
        with netCDF4.Dataset(name, "w") as file:
            dataset.dump_to_store(xarray.backends.NetCDF4DataStore(file), encoding=encoding)
            add_checksum(file)

    write_whole(path, write)


def open_summary(path: str | Path) -> xarray.Dataset:
    """Return an intact summary, loaded into memory. Raises BadFile if the file is missing or corrupt."""
    with open_whole(path):
        return xarray.load_dataset(path, engine="netcdf4")
