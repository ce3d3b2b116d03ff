"""Runs over laws, initial states and parameters, on several cores."""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Callable, Collection, Iterable, Mapping, Sequence
from dataclasses import dataclass, replace
from itertools import chain as chained
from itertools import product
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from burridge_knopoff.dataset.columns import common_attributes, over_grid
from burridge_knopoff.dataset.point import POINT_VARIABLES, point_attributes, point_values, run_coordinates
from burridge_knopoff.dataset.variables import PERIOD, Variable, flag
from burridge_knopoff.laws import Law
from burridge_knopoff.library.keyword_settings import divide, settings_of, show_settings
from burridge_knopoff.library.progress import Progress, progress_bar
from burridge_knopoff.library.run import motion_of
from burridge_knopoff.library.state_forms import (
    Initial,
    final_state,
    has_several_names,
    named_states,
    warn_of_run,
)
from burridge_knopoff.messages import format_value, full_key, refusal, suggestion
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.parameters import (
    format_parameter_names,
    parameter_key,
    parse_indexed_name,
    plain_name,
    remarks_on_states,
)
from burridge_knopoff.motion.kind import MotionKind
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.running.cores import chosen_cores
from burridge_knopoff.running.runner import LOCKSTEP_RUNS, check_state, run_together
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import prepare
from burridge_knopoff.running.threads import map_in_threads
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.values import each_instance_of, elements, instance_of, is_sequence

if TYPE_CHECKING:
    import xarray

_T = TypeVar("_T")

#: Dimensions of the same size in every run, and the variables of a point over no others.
_COMMON_DIMENSIONS = {"batch", "block", "exponent", "level"}
_COMMON = {name: item for name, item in POINT_VARIABLES.items() if set(item.dimensions) <= _COMMON_DIMENSIONS}
_MOTION = {
    "kind": Variable(
        (), "i1", "kind of motion", flag("i1", MotionKind) | {"comment": "the kind that the run alone shows"}
    ),
    "period": Variable((), "f8", *PERIOD),
}
# Variables and dimensions of the result, which no parameter of a law can be.
_RESERVED = {*_COMMON, *_COMMON_DIMENSIONS, *_MOTION, "law", "initial"} - {"a", "v"}
_ARGUMENTS = {*fields_of(Settings), "model", "initial", "settings", "motion", "cores", "progress"}
_COORDINATES = {
    "law": Variable((), "O", "friction law"),
    "initial": Variable((), "O", "initial state"),
    "a": POINT_VARIABLES["a"],
    "v": POINT_VARIABLES["v"],
}


@dataclass(frozen=True, eq=False)
class _Point:
    """A point of the grid: the coordinates that vary, the model, and the state at which its run begins."""

    place: Mapping[str, Any]
    model: Model
    state: InitialState | ChainState


@show_settings(Settings)
def sweep(
    model: Model | Sequence[Model],
    initial: Initial | Sequence[Initial] = "minus",
    settings: Settings | None = None,
    *,
    motion: MotionSettings | None = MOTION,
    cores: int | None = None,
    progress: Progress = False,
    **by_name: Any,
) -> xarray.Dataset:
    """Run a simulation at each point of a grid over laws, initial states and any parameters of a model.

    model : with the values of the parameters that do not vary; or a list of models that differ in their laws
    initial : a state in any form that `simulate` takes, or several by name: a list of states, in which numbers have a
        name, or `{"s": {"position": …, "velocity": …}, …}`
    by_name : parameters, each one number or a sequence: of the law such as a, v, of the chain such as coupling, or of
        one block or spring such as `mass[3]`, which takes precedence; and settings of the run by name
    motion : thresholds of the kinds of motion, for v = 0.1; None leaves out `kind` and `period`, which take up to a
        fifth of the time of a run of default length
    settings : see `simulate`
    cores : number of simultaneous runs, by default the number of cores; results do not depend on it
    progress : True for a bar, in a terminal or a notebook, if rich or tqdm is installed; "always" for one in a pipe too

    Each list is a dimension of the Dataset: law, initial, then the parameters in the order given; that of `mass[3]` is
    `mass_3`. A parameter with one value goes to the laws that have it. The variables are those of a point
    (docs/variables.md) with one value per run, batch, block, exponent or level of J, among them `mean_distance`,
    `mean_distance_error`, `lyapunov_exponent` and `status`, which is 0 for a completed run; and the `kind` of motion in
    the window with its `period` (see `MotionKind` and `decode_flags`). The series of a run are left out, since
    `simulate` returns them: the variables over `sample`, `earlier_event`, `event`, `crossing` and `trajectory_time`.
    The states `minus` and `plus` follow v; other numbers are the same at every point, and so are those of every state
    if springs, masses or thresholds vary: the attribute `remark` then says so. Raises ValueError, one line, for a wrong
    argument; an error at one point names it.

    >>> from burridge_knopoff import Model, sweep
    >>> model = Model("nonlinear")
    >>> runs = sweep(model, a=[0.02, 0.05, 0.3], transient=1000, window=500, batches=2)
    >>> runs.mean_distance.dims, runs.lyapunov_exponent.shape
    (('a',), (3, 3))
    >>> (runs.mean_distance < 1e-6).values.tolist()
    [True, True, False]
    >>> runs = sweep([Model("linearized"), model], ["minus", "plus"], a=0.08, v=[0.05, 0.1])
    >>> runs.kind.dims, runs.kind.sel(v=0.1).values.tolist()
    (('law', 'initial', 'v'), [[0, 1], [0, 2]])
    """
    several = is_sequence(model)
    models = each_instance_of(model, Model, "model") if several else [instance_of(model, Model, "model")]
    if not models:
        raise ValueError("model: got no model, expected at least one")
    for number, other in enumerate(models[1:], 1):
        models[0].check_same(replace(other, law=models[0].law), f"model[{number}]")
    named, parameters = divide(by_name, Settings)
    chosen = settings_of(Settings, settings, named)
    if motion is not None:
        instance_of(motion, MotionSettings, "motion")
    cores = chosen_cores(cores)
    states = named_states(initial)
    laws = [item.law.name for item in models]
    axes: dict[str, list[Any]] = {}
    if several:
        axes["law"] = _different(laws, "law", ': Model({NAME: {"law": …}}) gives a law a name')
    grids = []
    for item in models:
        place = {"law": item.law.name} if len(models) > 1 else {}
        own = _values_for(item, parameters, models)
        grids.append(_call_at(place, parameter_grid, item, own, _ARGUMENTS, _RESERVED))
    if has_several_names(initial):
        axes["initial"] = [*states]
    axes |= grids[0][1]
    points = [point for grid in grids for point in _points(*grid, states, axes, chosen)]
    costly = max(points, key=lambda point: point.model.chain.highest_rate)
    warn_of_run(costly.model, costly.state, chosen)
    size = min(LOCKSTEP_RUNS, -(-len(points) // cores))

    with progress_bar(progress, len(points), "sweep") as advance:

        def run_from(first: int) -> list[tuple[dict[str, Any], dict[str, Any]]]:
            together = points[first : first + size]
            runs = _run_together(together, chosen, motion)
            advance(len(together))
            return runs

        runs = map_in_threads(cores, run_from, range(0, len(points), size))
    dataset = _dataset(
        axes, [base.law for base, *_ in grids], points[0], next(iter(states)), [*chained.from_iterable(runs)]
    )
    if remark := "; ".join(_remarks(states, axes)):
        dataset.attrs["remark"] = remark
    return dataset


def _different(values: list[_T], name: str, hint: str = "") -> list[_T]:
    """Return values of an axis; raises ValueError, one line, if one of them occurs twice."""
    value, count = Counter(values).most_common(1)[0]
    if count > 1:
        raise ValueError(f"{name}: got {format_value(value)} twice, expected each once{hint}")
    return values


def _values_for(model: Model, parameters: Mapping[str, Any], models: Sequence[Model]) -> dict[str, Any]:
    """Return the parameters of one of several models, without those with one value that only other laws have."""
    elsewhere = {name for other in models for name in other.law.names} - {*model.law.names}
    return {name: value for name, value in parameters.items() if name not in elsewhere or is_sequence(value)}


def parameter_grid(
    model: Model, parameters: Mapping[str, Any], settings: Iterable[str], reserved: Collection[str]
) -> tuple[Model, dict[str, list[float]], dict[str, float]]:
    """Return the model with all single-valued parameters, the values of those given as sequences, and values to keep.

    The latter are of one block or spring, such as `mass[3]`, and take precedence over those of a sequence for all.

    settings : names of the arguments of the call that are no parameters
    reserved : names of the result that no parameter with several values can have

    Raises ValueError, one line, for a wrong argument, and for a value that occurs twice.
    """
    for name in model.law.names:
        if name in settings:
            raise ValueError(f"{name}: got a parameter of the law with the name of an argument, expected another name")
    for name in parameters:
        if not model.has_parameter(name):
            allowed = [format_parameter_names(model.parameter_names), *sorted(settings)]
            hint = suggestion(name, [*model.parameter_names, *settings])
            raise ValueError(
                f"{full_key('', name)}: not a setting or a parameter, expected {' | '.join(allowed)}{hint}"
            )
    axes: dict[str, list[Any]] = {
        name: values for name, value in parameters.items() if (values := elements(value)) is not None
    }
    for name, values in axes.items():
        if name in reserved:
            raise ValueError(f"{name}: got the name of a variable of the result, expected another name of a parameter")
        if any(map(is_sequence, values)):
            raise refusal(full_key("", name), parameters[name], "one number or a sequence of numbers")
        if not values:
            raise ValueError(f"{full_key('', name)}: got no value, expected at least one")
    first = {name: axes[name][0] if name in axes else value for name, value in parameters.items()}
    single = {name: first.pop(name) for name in parameters if parse_indexed_name(name) and parameter_key(name) in axes}
    base = model.at(**first) if first else model
    kept = {name: base.at(**{name: value}).parameter(name) for name, value in single.items() if name not in axes}
    for name, values in axes.items():
        axes[name] = _different([base.at(**{name: value}).parameter(name) for value in values], name)
    return base, axes, kept


def _points(
    base: Model,
    grid: Mapping[str, list[float]],
    kept: Mapping[str, float],
    states: Mapping[str, Any],
    axes: Iterable[str],
    settings: Settings,
) -> list[_Point]:
    """Return the points of one law; raises ValueError, with the place of the point, if a run cannot begin there."""
    points = []
    for (name, state), values in product(states.items(), product(*grid.values())):
        at = dict(zip(grid, values, strict=True))
        place = {key: {"law": base.law.name, "initial": name, **at}[key] for key in axes}
        model = _call_at(place, base.at, **at, **kept)
        _call_at(place, settings.check_chain, model.chain)
        begun = _call_at(place, final_state, model, state)[0] if isinstance(state, Trajectory) else state
        if isinstance(begun, ChainState):
            _call_at(place, check_state, model, begun)
        else:
            _call_at(place, model.begin, begun, settings.start)
        points.append(_Point(place, model, begun))
    return points


def _run_together(
    points: Sequence[_Point], settings: Settings, motion: MotionSettings | None
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Return the common variables and the attributes of the runs at some points."""
    jobs = [_call_at(point.place, prepare, point.model, point.state, settings) for point in points]
    ends = run_together([job.runner for job in jobs])
    runs = []
    for point, job, end in zip(points, jobs, ends, strict=True):
        run = job.result(_call_at(point.place, job.runner.status_of, end))
        values = point_values(run)
        common = {name: values[name] for name in _COMMON}
        if motion is not None:
            outcome = motion_of(run, motion)
            common |= {"kind": outcome.kind, "period": outcome.period}
        runs.append((common, point_attributes(run)))
    return runs


def _dataset(
    axes: Mapping[str, list[Any]],
    laws: Sequence[Law],
    point: _Point,
    state: str,
    runs: Sequence[tuple[Mapping[str, Any], Mapping[str, Any]]],
) -> xarray.Dataset:
    """Return the runs as a Dataset over the axes, with the attributes that are the same for all of them.

    laws : a parameter in which they differ is a coordinate over law, NaN for a law without it
    point, state : the first point, and the name of its state, for the coordinates that do not vary
    """
    import xarray

    plain = {name: plain_name(name) for name in axes}
    single = {"law": point.model.law.name, "initial": state, "v": point.model.v}
    coordinates = {name for name in single if name not in axes}
    data: dict[str, Any] = {name: ((), single[name], _COORDINATES[name].all_attributes()) for name in coordinates}
    for name in {name for law in laws for name in law.names} - axes.keys() - _RESERVED:
        numbers = [law.parameters.get(name, math.nan) for law in laws]
        item = _COORDINATES.get(name, Variable((), "f8", f"parameter {name} of the law"))
        if len(set(numbers)) > 1:
            data[name] = "law", numbers, item.all_attributes()
        elif name == "a":
            data[name] = (), numbers[0], item.all_attributes()
    coordinates |= data.keys()
    rows, attributes = zip(*runs, strict=True)
    first = rows[0]
    variables = {name: item for name, item in {**_COMMON, **_MOTION}.items() if name in first}
    for name in [name for name, item in variables.items() if item.coordinate or name in _COORDINATES]:
        item = variables.pop(name)
        # Batches of runs that begin at different times are only numbered.
        if name not in _COORDINATES and all(np.array_equal(row[name], first[name]) for row in rows):
            coordinates.add(name)
            data[name] = item.dimensions, np.asarray(first[name], item.dtype), item.all_attributes()
    sizes = {
        key: n
        for name, item in variables.items()
        for key, n in zip(item.dimensions, np.shape(first[name]), strict=True)
    }
    grid = {plain[name]: len(values) for name, values in axes.items()}
    chosen = ({name: row[name] for name in variables} for row in rows)
    values = over_grid(variables, grid, zip(np.ndindex(*grid.values()), chosen, strict=True), **sizes)
    for name, item in variables.items():
        data[name] = (*grid, *item.dimensions), values[name], item.all_attributes()
    for name, along in axes.items():
        item = _COORDINATES.get(name, Variable((), "f8", f"parameter {name} of the model"))
        data[plain[name]] = plain[name], along, item.all_attributes()
    common = common_attributes(attributes)
    if axes:
        common["summary"] = f"Runs over {', '.join(axes)}."
    for name, (item, value) in run_coordinates(attributes[0]).items():
        if name not in data and not common.keys().isdisjoint((f"law_{name}", f"chain_{name}")):
            coordinates.add(name)
            data[name] = (), value, item.all_attributes()
    return xarray.Dataset(data, attrs=common).set_coords(coordinates)


def _remarks(states: Mapping[str, Any], axes: Iterable[str]) -> list[str]:
    """Return a line for the states whose numbers are the same while something varies that scales the motion."""
    varied = [name for name in axes if name not in ("law", "initial")]
    remarks = remarks_on_states([state for state in states.values() if isinstance(state, InitialState)], varied)
    motions = [name for name, state in states.items() if not isinstance(state, InitialState)]
    if motions and varied:
        remarks.append(
            f"initial: {', '.join(motions)}: the same positions relative to the driver and velocities at every point"
        )
    return remarks


def _call_at(point: Mapping[str, Any], function: Callable[..., _T], *arguments: Any, **by_name: Any) -> _T:
    """Call a function; an error names the point of the grid."""
    try:
        return function(*arguments, **by_name)
    except (ValueError, MemoryError) as error:
        place = ", ".join(f"{name} = {value!r}" for name, value in point.items())
        raise type(error)(f"{place}: {error}" if place else str(error)) from error
