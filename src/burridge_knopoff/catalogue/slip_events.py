"""Catalogue files: the netCDF form of the slip events of a run, one row per event.

The events are in the order of their beginnings. In a ring `first_block` exceeds `last_block` if the event spans the
seam. `slip_block`, `slip_distance` and `slip_onset` exist with `profiles`, as a CF contiguous ragged array with
`blocks` entries for each event. The attributes `begin_time` and `end_time` are those of the catalogue on the loading
clock; in a run that did not complete the variable `end_time` is earlier.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from burridge_knopoff.catalogue.events import SlipEvents, record_events
from burridge_knopoff.catalogue.settings import CatalogueSettings
from burridge_knopoff.dataset.point import STATUS_FLAG, model_attributes
from burridge_knopoff.dataset.variables import Variable, global_attributes, xarray_variables
from burridge_knopoff.laws.law import recorded_a
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.running.solvers import SOLVERS
from burridge_knopoff.running.status import early_end

if TYPE_CHECKING:
    import xarray

NO_EVENT = "neighbours slip without end (try a slower driver), or the window is too short"

_V = Variable
_EVENT = ("event",)
CATALOGUE_VARIABLES = {
    "a": _V((), "f8", "friction parameter a", coordinate=True),
    "v": _V((), "f8", "driver velocity v", coordinate=True),
    "status": _V((), "i1", "how the run ended", STATUS_FLAG),
    "end_time": _V((), "f8", "time tau at which the run ended"),
    "time": _V(_EVENT, "f8", "time tau of the first start: on the loading clock", coordinate=True),
    "slip_time": _V(
        _EVENT,
        "f8",
        "slip time of the first start",
        {"comment": "equal to time under steady loading; stops between events under quasi-static loading"},
    ),
    "duration": _V(_EVENT, "f8", "duration: slip time from the first start to the last stop"),
    "epicentre": _V(_EVENT, "i4", "block that starts first"),
    "first_block": _V(_EVENT, "i4", "first slipping block along the chain"),
    "last_block": _V(_EVENT, "i4", "last slipping block along the chain"),
    "blocks": _V(_EVENT, "i4", "number of slipping blocks"),
    "moment": _V(_EVENT, "f8", "moment: sum of the slips of all blocks"),
    "magnitude": _V(_EVENT, "f8", "magnitude: natural logarithm of the modulus of the moment"),
    "largest_slip": _V(_EVENT, "f8", "largest slip of a block"),
    "peak_velocity": _V(_EVENT, "f8", "highest slip speed of a block"),
    "stress_drop": _V(_EVENT, "f8", "stress drop: decrease of the spring force, mean over the slipping blocks"),
    "energy_released": _V(
        _EVENT, "f8", "dissipated energy: work of the springs on the blocks, which friction and dashpots dissipate"
    ),
    "energy_damped": _V(_EVENT, "f8", "energy dissipated by dashpots: at slipping blocks"),
    "interval": _V(
        _EVENT,
        "f8",
        "interval since the previous event: time tau since the start of the last event in which the "
        "epicentre slipped, NaN if there is none",
    ),
}
#: With profiles, the slips of all events in the order of the events, as a contiguous ragged array.
PROFILE_VARIABLES = {
    "slip_block": _V(("slip",), "i4", "block that slips"),
    "slip_distance": _V(("slip",), "f8", "slip of the block in the event"),
    "slip_onset": _V(
        ("slip",), "f8", "onset of slip: slip time from the first start of the event to the first start of the block"
    ),
}


def catalogue_dataset(
    events: SlipEvents, model: Model, begin: float, end: float, attributes: dict[str, Any]
) -> xarray.Dataset:
    """Return a catalogue as an xarray Dataset.

    begin, end : begin and end of the catalogue on the loading clock
    attributes : further global attributes: initial state, loading, solver, history
    """
    import xarray

    extra = {"a": recorded_a(model.law), "v": model.v, "slip_block": events.slip_block, "slip_distance": events.slip}
    extra["end_time"] = events.final.time
    variables = {**CATALOGUE_VARIABLES, **(PROFILE_VARIABLES if len(events.slip) else {})}
    values = {name: extra[name] if name in extra else getattr(events, name) for name in variables}
    data = xarray_variables(variables, values)
    if len(events.slip):
        data["blocks"][2]["sample_dimension"] = "slip"
    title = f"Slip events of a Burridge-Knopoff chain of {model.blocks} blocks, {model.law.name} friction law"
    contents = (
        "One row for each event, a set of slips of neighbouring blocks that overlap in time. Blocks are numbered "
        "from 1."
    )
    about = {
        **model_attributes(model),
        "contact": model.contact,
        "blocks": model.blocks,
        "begin_time": begin,
        "end_time": end,
        **attributes,
    }
    coordinates = [name for name, item in variables.items() if item.coordinate]
    head = global_attributes(title, about, module=__name__, contents=contents)
    return xarray.Dataset(data, attrs=head).set_coords(coordinates)


def catalogue_of_run(
    model: Model, initial: InitialState, settings: CatalogueSettings, start: str, solver: str, step: float
) -> xarray.Dataset:
    """Run a model from an initial state and return the catalogue of its slip events as a Dataset.

    start, solver, step : see `Settings`
    """
    ran = {"loading": settings.loading, "solver": solver}
    begin, end = settings.transient, settings.end
    at = model.begin(initial, start, settings.loading)
    events = record_events(model, at, end, begin=begin, profiles=settings.profiles, step=step, **ran)
    about: dict[str, Any] = {"initial": initial.name, "start": start, **ran, "history": "snakemake"}
    if SOLVERS[solver].has_fixed_step:
        about["step"] = step
    return catalogue_dataset(events, model, begin, end, about)


def digest(data: xarray.Dataset) -> str:
    """Return why the catalogue of one run is empty, or that its run did not complete; empty if neither is so."""
    if ended := early_end(data["status"].item(), data["end_time"].item()):
        return f"{ended}; there are no rates and no slope"
    return "" if data.sizes["event"] else f"no slip event: {NO_EVENT}"
