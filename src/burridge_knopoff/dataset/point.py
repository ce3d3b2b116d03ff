"""Point files: the netCDF form of a trajectory, with all names, attributes and encodings of its variables.

All events are `earlier_event_*`, stored without the states of the blocks, followed by `event_*`, stored with them; the
setting `events` decides how many. At an event the velocity of its block is exactly 0. If the period of an orbit divides
a batch, the batch means are too similar, and `mean_distance_error` leaves out the incomplete last period.
"""

from __future__ import annotations

from collections.abc import Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from burridge_knopoff.dataset.variables import (
    DIRECTION,
    KIND,
    NETCDF_LOCK,
    TIMES,
    YES_OR_NO,
    Variable,
    flag,
    global_attributes,
    write_variables,
    xarray_variables,
)
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.provenance.files import write_whole
from burridge_knopoff.provenance.sources import SOFTWARE
from burridge_knopoff.running.command import CHAIN_OPTIONS, simulate_command
from burridge_knopoff.running.settling import LEVELS, ROUNDING_UNITS
from burridge_knopoff.running.status import STATUS_WORDS, Status
from burridge_knopoff.running.trajectory import Trajectory

# Writing needs netCDF4 only, so that a point job starts fast; `to_dataset` imports xarray.
if TYPE_CHECKING:
    import xarray

STATUS_FLAG = flag("i1", STATUS_WORDS)
SECTION = {"comment": "the attribute `section` gives W: the sum of all x_i, or x_n of one block n"}
RELATIVE = {"comment": "relative to the driver: U - v*tau, U the position of the paper"}

_V = Variable
POINT_VARIABLES: dict[str, Variable] = {
    "a": _V((), "f8", "friction parameter a", coordinate=True),
    "v": _V((), "f8", "driver velocity v", coordinate=True),
    "block": _V(("block",), "i4", "block number: 1 to N along the chain", coordinate=True),
    "initial_position": _V(("block",), "f8", "initial position U(0)"),
    "initial_velocity": _V(("block",), "f8", "initial velocity U'(0)"),
    "initially_slipping": _V(
        ("block",),
        "i1",
        "slipping at the beginning: whether the block slips at the beginning of the run, before its first event",
        {**YES_OR_NO, "comment": "a block has this slip, and one slip from each of its starts"},
    ),
    "status": _V((), "i1", "how the run ended", STATUS_FLAG),
    "end_time": _V((), "f8", "time tau at which the run ended"),
    "event_count": _V((), "i8", "number of events: stops and starts in the whole run"),
    "step_count": _V((), "i8", "number of steps: solver steps in the whole run"),
    "mean_distance": _V(
        (),
        "f8",
        "mean distance <J>: time average of the phase-space distance between the end blocks over the window",
        {"ancillary_variables": "mean_distance_error status"},
    ),
    "mean_distance_error": _V((), "f8", "standard error of <J>: from the batch means"),
    "batch_mean_distance": _V(("batch",), "f8", "batch mean of J: time average over one batch of the window"),
    "batch": _V(("batch",), "f8", "time tau at the middle of the batch", coordinate=True),
    "least_friction": _V((), "f8", "least friction Phi: on a slipping block in the whole run"),
    "least_spring_force": _V((), "f8", "least force on a stuck block: in the whole run"),
    "window_least_friction": _V((), "f8", "least friction Phi in the window: on a slipping block"),
    "window_least_spring_force": _V((), "f8", "least force on a stuck block in window"),
    "lyapunov_exponent": _V(
        ("exponent",),
        "f8",
        "Lyapunov exponent: in the window, in descending order; -infinity if a stop removes the perturbation",
        {"ancillary_variables": "lyapunov_error status"},
    ),
    "lyapunov_error": _V(
        ("exponent",),
        "f8",
        "error of a Lyapunov exponent: standard error of the batches, combined with linear growth over the window",
    ),
    "batch_lyapunov_exponent": _V(
        ("batch", "exponent"), "f8", "Lyapunov exponent of a batch: in one batch of the window"
    ),
    "lyapunov_infinite_count": _V(
        (),
        "i4",
        "number of exponents of -infinity: Lyapunov exponents known to be -infinity, at least the "
        "largest number of blocks stuck at once",
        {"comment": "exact if all 2 N exponents were computed; -1 if none were computed"},
    ),
    "level": _V(("level",), "f8", "level of J", coordinate=True),
    "settling_time": _V(
        ("level",),
        "f8",
        "settling time of J: last time tau at which J is at least at the level, found between events",
        {
            "ancillary_variables": "distance_rounding status",
            "comment": "the beginning of the run if J is always below; NaN if it is not below at the end, and for a "
            "level of rounding",
        },
    ),
    "distance_rounding": _V(
        (),
        "f8",
        f"rounding of J: a lower level is rounding; {ROUNDING_UNITS:g} roundings of the largest |U - v*tau| or |U'| at "
        "the end of the run",
    ),
    "time": _V(("sample",), "f8", "time tau of a sample of J"),
    "distance": _V(("sample",), "f8", "phase-space distance J: between the end blocks"),
    "earlier_event_time": _V(("earlier_event",), "f8", "time tau of an earlier event: before those with states"),
    "earlier_event_block": _V(
        ("earlier_event",), "i4", "block of an earlier event: block that stops or starts, before the events with states"
    ),
    "earlier_event_kind": _V(("earlier_event",), "i1", "kind of event before those with states", KIND),
    "event_time": _V(("event",), "f8", "time tau of an event"),
    "event_block": _V(("event",), "i4", "block that stops or starts"),
    "event_kind": _V(("event",), "i1", "kind of event", KIND),
    "event_position": _V(("event", "block"), "f8", "positions of all blocks at an event", RELATIVE),
    "event_velocity": _V(("event", "block"), "f8", "velocities U' of all blocks at an event"),
    "crossing_time": _V(("crossing",), "f8", "time tau of a crossing of W = 0"),
    "crossing_velocity": _V(("crossing",), "f8", "W' at a crossing of the section W = 0", SECTION),
    "crossing_direction": _V(("crossing",), "i1", "direction in which W crosses 0", DIRECTION),
    "trajectory_time": _V(("trajectory_time",), "f8", "time tau in the last part of the run", coordinate=True),
    "position": _V(("trajectory_time", "block"), "f8", "positions of the blocks", RELATIVE),
    "velocity": _V(("trajectory_time", "block"), "f8", "velocities U' of the blocks"),
}

#: Dimensions whose sizes differ between the runs of a study.
RAGGED_DIMENSIONS = ("earlier_event", "event", "crossing")

_RESERVED = POINT_VARIABLES.keys() | {name for item in POINT_VARIABLES.values() for name in item.dimensions}


def point_values(trajectory: Trajectory) -> dict[str, Any]:
    """Return the values of all point variables."""
    settings = trajectory.settings
    width = settings.window / settings.batches
    special = {
        "a": recorded_a(trajectory.model.law),
        "v": trajectory.model.v,
        "block": np.arange(1, trajectory.model.blocks + 1),
        "initial_position": trajectory.initial.position,
        "initial_velocity": trajectory.initial.velocity,
        "status": Status[trajectory.status.upper()],
        "level": LEVELS,
        "batch": trajectory.begin_time + settings.transient + width * (np.arange(settings.batches) + 0.5),
    }
    return {name: special[name] if name in special else getattr(trajectory, name) for name in POINT_VARIABLES}


def point_attributes(trajectory: Trajectory) -> dict[str, Any]:
    """Return the global attributes of a point file."""
    model, settings = trajectory.model, trajectory.settings
    title = f"Burridge-Knopoff chain of {model.blocks} blocks, {model.law.name} friction law"
    contents = "One run: event sequence, section crossings and phase-space distance between the end blocks."
    attributes = {
        "source": f"{SOFTWARE}, event-driven or time-stepping simulation",
        "history": _history(trajectory),
        **model_attributes(model),
        "solver": settings.solver,
        "initial": trajectory.initial.name,
        "contact": model.contact,
        "start": settings.start,
        "events": settings.events,
        "section": str(settings.section),
        "transient": settings.transient,
        "window": settings.window,
    }
    if settings.has_fixed_step:
        attributes["step"] = settings.step
    if trajectory.missing_derivative:
        attributes["missing_derivative"] = trajectory.missing_derivative
    return global_attributes(title, attributes, module=__name__, contents=contents)


def _history(trajectory: Trajectory) -> str:
    """Return the command that repeats a run, or that none does: it continues from a state of a motion."""
    if isinstance(trajectory.given, ChainState):
        return f"simulate from a state of another run at tau = {trajectory.begin_time!r}"
    return simulate_command(trajectory.model, trajectory.given, trajectory.settings)


def model_attributes(model: Model) -> dict[str, Any]:
    """Return the global attributes that describe the law and the chain of a model."""
    return {
        "law": model.law.name,
        "law_formula": model.law.formula,
        **{f"law_{key}": value for key, value in model.law.parameters.items() if key != "a"},
        **{f"chain_{key}": value for key in CHAIN_OPTIONS if (value := getattr(model.chain, key)) is not None},
    }


def run_coordinates(attributes: Mapping[str, Any]) -> dict[str, tuple[Variable, Any]]:
    """Return the scalar coordinates of a run other than a and v, by name: descriptions and values.

    attributes : global attributes of its point file

    They are law, initial state and the parameters of the law and the chain that are one number, named as in `sweep`. A
    parameter of the law with the name of a variable, a dimension or a parameter of the chain remains an attribute.
    """
    coordinates: dict[str, tuple[Variable, Any]] = {
        "law": (_V((), "O", "friction law", coordinate=True), attributes["law"]),
        "initial": (_V((), "O", "initial state", coordinate=True), attributes["initial"]),
    }
    chain = {f"chain_{key}": field.description.partition(":")[0] for key, field in fields_of(Chain).items()}
    law = {key: f"parameter {key[4:]} of the law" for key in attributes if key.startswith("law_")}
    for key, words in {**chain, **law}.items():
        name, value = key.partition("_")[2], attributes.get(key, "")
        if np.ndim(value) == 0 and not isinstance(value, str) and name not in _RESERVED:
            coordinates.setdefault(name, (_V((), "f8", words, coordinate=True), value))
    return coordinates


def with_run_coordinates(point: xarray.Dataset) -> xarray.Dataset:
    """Return a point with the coordinates of `run_coordinates`, which are attributes alone in earlier versions."""
    return point.assign_coords(
        {
            name: ((), value, item.all_attributes())
            for name, (item, value) in run_coordinates(point.attrs).items()
            if name not in point.variables
        }
    )


def _contents(trajectory: Trajectory) -> tuple[dict[str, Variable], dict[str, Any], dict[str, Any]]:
    """Return the variables of a point file, their values and the global attributes."""
    attributes = point_attributes(trajectory)
    coordinates = run_coordinates(attributes)
    variables = {**{name: item for name, (item, _) in coordinates.items()}, **POINT_VARIABLES}
    values = {**{name: value for name, (_, value) in coordinates.items()}, **point_values(trajectory)}
    return variables, values, attributes


def write_point(trajectory: Trajectory, path: str | Path) -> None:
    """Write a trajectory as a point file. After an error there is no incomplete file.

    Raises OSError if the file cannot be written.
    """
    import netCDF4

    contents = _contents(trajectory)

    def write(name: str) -> None:
        with NETCDF_LOCK, netCDF4.Dataset(name, "w", format="NETCDF4") as dataset:
            write_variables(dataset, *contents)

    write_whole(path, write)


def to_dataset(trajectory: Trajectory) -> xarray.Dataset:
    """Return a trajectory as an xarray Dataset, equal to its point file."""
    import xarray

    variables, values, attributes = _contents(trajectory)
    coordinates = {name for name, item in variables.items() if item.coordinate} | set(TIMES.values())
    return xarray.Dataset(xarray_variables(variables, values), attrs=attributes).set_coords(coordinates)
