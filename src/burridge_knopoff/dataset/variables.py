"""Descriptions of netCDF variables and their writing, for every file of the package."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from enum import IntEnum
from threading import RLock
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.provenance.checksum import NAME, content_checksum
from burridge_knopoff.provenance.sources import provenance, versions

if TYPE_CHECKING:
    import netCDF4

CONVENTIONS = "CF-1.11, ACDD-1.3"
KEYWORDS = "stick-slip, friction, Burridge-Knopoff model, spring-block chain, synchronization"
#: The part of the global attribute `summary` that all files share.
SIMULATED = (
    "From simulations of the Burridge-Knopoff model: blocks with stick-slip friction, coupled by springs and pulled by "
    "a driver of constant velocity. All quantities are dimensionless."
)
#: Types of texts: objects, such as names along a dimension, or a column of words, which may be empty.
TEXT = ("O", "U")
#: For netCDF files in a process with several threads: HDF5 is not safe for these, and xarray's own lock does not cover
#: everything that is read when a file is opened.
NETCDF_LOCK = RLock()
COMPRESSION_LEVEL = 5
COMPRESSED_FROM = 64


@dataclass(frozen=True)
class Variable:
    """One netCDF variable: its dimensions, type, description and further attributes.

    description : its name with the paper's symbol, short enough for the axis of a figure; then, if it is not the whole
        description, a colon and the rest, as in "stop rate: stops per unit of time tau in the window"
    nothing : the missing value; by default NaN for numbers, −1 for whole numbers, "" for texts
    """

    dimensions: tuple[str, ...]
    dtype: str
    description: str
    attributes: Mapping[str, Any] = field(default_factory=dict)
    coordinate: bool = False
    nothing: Any = None

    @property
    def missing(self) -> Any:
        """The missing value."""
        default = {"f": np.nan, "i": -1}.get(np.dtype(self.dtype).kind, "")
        return default if self.nothing is None else self.nothing

    def all_attributes(self) -> dict[str, Any]:
        """Return the attributes in the order in which they are written; `comment` has the rest of the description."""
        name, _, rest = self.description.partition(": ")
        attributes: dict[str, Any] = {"long_name": name}
        # Neither flags nor texts have a unit.
        if "flag_values" not in self.attributes and self.dtype not in TEXT:
            attributes["units"] = "1"
        attributes.update(self.attributes)
        if comment := "; ".join(filter(None, [rest, attributes.get("comment")])):
            attributes["comment"] = comment
        return attributes


def global_attributes(title: str, attributes: Mapping[str, Any], *, module: str, contents: str = "") -> dict[str, Any]:
    """Return the global attributes of a file: those of CF and ACDD, further ones, and the provenance.

    contents : one or several sentences on the contents of the file, if the title does not suffice
    module : name of the module that computes the values
    """
    common = {
        "Conventions": CONVENTIONS,
        "title": title,
        "summary": f"{contents or f'{title}.'} {SIMULATED}",
        "keywords": KEYWORDS,
    }
    others = {key: value for key, value in attributes.items() if key not in common}
    return {**common, **others, **provenance(module), "versions": versions()}


def flag(dtype: str, meanings: Iterable[IntEnum] | Mapping[int, str]) -> dict[str, Any]:
    """Return the CF attributes of a flag variable, from an enumeration, or from {number: meaning}."""
    if not isinstance(meanings, Mapping):
        meanings = {int(item): item.name.lower() for item in meanings}
    return {"flag_values": np.array(list(meanings), dtype=dtype), "flag_meanings": " ".join(meanings.values())}


class Answer(IntEnum):
    """The answer to a question, such as whether two laws agree or a run has settled, numbered as in netCDF files."""

    UNDETERMINED = -1
    NO = 0
    YES = 1


ANSWER = flag("i1", Answer)
YES_OR_NO = flag("i1", {0: "no", 1: "yes"})
KIND = flag("i1", {0: "stop", 1: "start"})
DIRECTION = flag("i1", {-1: "downward", 1: "upward"})

#: Description and attributes of the period of a motion.
PERIOD = (
    "period: of the periodic orbit on which the motion lies or to which it is locked, NaN if none was found",
    {"comment": "inf if the exponents are those of an attracting periodic orbit but the motion has not repeated"},
)

#: The variable with the times along each dimension that has no coordinate variable of the same name.
TIMES = {"sample": "time", "event": "event_time", "earlier_event": "earlier_event_time", "crossing": "crossing_time"}


def xarray_variables(variables: Mapping[str, Variable], values: Mapping[Any, Any]) -> dict[str, Any]:
    """Return variables with the values of the same names, in the form that an xarray Dataset expects.

    values : arrays with the dimensions of the variables, or DataArrays, which have dimensions of their own
    """
    return {
        name: (
            getattr(values[name], "dims", item.dimensions),
            np.asarray(values[name], dtype=item.dtype),
            item.all_attributes(),
        )
        for name, item in variables.items()
    }


def write_variables(
    dataset: netCDF4.Dataset,
    variables: Mapping[str, Variable],
    values: Mapping[str, Any],
    attributes: Mapping[str, Any],
) -> None:
    """Write attributes, dimensions, variables and the checksum of all these into an open netCDF file.

    A text is a scalar.
    """
    scalars = " ".join(name for name, item in variables.items() if item.coordinate and not item.dimensions)
    sizes: dict[str, int] = {}
    contents: dict[str, tuple[tuple[str, ...], Any, dict[str, Any]]] = {}
    for name, item in variables.items():
        array, dimensions, named = np.asarray(values[name], dtype=item.dtype), item.dimensions, item.all_attributes()
        if item.dtype in TEXT:
            # Characters, since HDF5 crashes when a file with variable-length strings is opened many times.
            array = np.frombuffer(str(array).encode() or b"\0", "S1")
            dimensions, named["_Encoding"] = (f"string{array.size}",), "utf-8"
        sizes |= zip(dimensions, array.shape, strict=True)
        if not item.coordinate:
            named["coordinates"] = _coordinates(item, scalars)
        contents[name] = dimensions, array, named
    dataset.setncatts({**attributes, NAME: content_checksum(sizes, attributes, contents)})
    for name, size in sizes.items():
        dataset.createDimension(name, size)
    # All variables are defined before the first is written: HDF5 writes all definitions anew after each change.
    arrays = []
    for name, (dimensions, array, named) in contents.items():
        storage: dict[str, Any] = {"fill_value": False}
        if array.size >= COMPRESSED_FROM:
            storage.update(compression="zlib", complevel=COMPRESSION_LEVEL, shuffle=True, chunksizes=array.shape)
        variable = dataset.createVariable(name, array.dtype, dimensions, **storage)
        variable.setncatts(named)
        variable.set_auto_maskandscale(False)
        arrays.append((variable, array))
    for variable, array in arrays:
        variable[...] = array


def _coordinates(item: Variable, scalars: str) -> str:
    """Return the CF attribute `coordinates`: the scalars, and the times of events and crossings."""
    names = [TIMES[dimension] for dimension in item.dimensions if dimension in TIMES]
    return " ".join([*names, scalars]).strip()
