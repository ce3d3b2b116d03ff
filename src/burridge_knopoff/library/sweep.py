"""Runs over one or several parameters, on several cores."""

from __future__ import annotations

from collections import Counter
from collections.abc import Callable, Mapping, Sequence
from itertools import chain as chained
from itertools import product
from typing import TYPE_CHECKING, Any, TypeVar

import numpy as np

from burridge_knopoff.dataset.point import POINT_VARIABLES, point_attributes, point_values
from burridge_knopoff.dataset.variables import Variable
from burridge_knopoff.laws import Law
from burridge_knopoff.library.coercion import GivenLaw, Initial, given_model, given_state, warn_of_cost
from burridge_knopoff.library.keyword_settings import settings_of, show_settings
from burridge_knopoff.messages import format_value, full_key, refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import (
    format_parameter_names,
    parse_indexed_name,
    plain_name,
    remarks_on_states,
)
from burridge_knopoff.model.ranges import Whole
from burridge_knopoff.running.cores import available_cores
from burridge_knopoff.running.runner import LOCKSTEP_RUNS, run_together
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import prepare
from burridge_knopoff.running.threads import map_in_threads
from burridge_knopoff.values import elements, is_sequence

if TYPE_CHECKING:
    import xarray

_T = TypeVar("_T")

#: Dimensions of the same size in every run, and the variables of a point over no others.
_COMMON_DIMENSIONS = {"batch", "block", "exponent", "level"}
_COMMON = {name: item for name, item in POINT_VARIABLES.items() if set(item.dimensions) <= _COMMON_DIMENSIONS}


@show_settings(Settings)
def sweep(
    law: Model | GivenLaw,
    a: float | Sequence[float] | np.ndarray | None = None,
    initial: Initial = "minus",
    settings: Settings | None = None,
    *,
    chain: Chain | None = None,
    contact: str | None = None,
    cores: int | None = None,
    **by_name: Any,
) -> xarray.Dataset:
    """Run a simulation at each of several a, or at each point of a grid over any parameters of the model.

    law : a `Model` with its own chain, contact and values of all parameters; or a law in any form that `simulate` takes
    a : friction parameters, shape (n,), or one number; by default that of a `Model` or a `Law`
    by_name : other parameters, v, those of the chain such as coupling, or of one block or spring such as `mass[3]`, and
        the parameters of the law such as sigma, each one number or a sequence; and settings of the run by name
    initial, settings, chain, contact : see `simulate`
    cores : number of simultaneous runs, by default the number of cores; results do not depend on it

    Each parameter given as a sequence is a dimension of the Dataset: first a, then the others in the order given; that
    of `mass[3]` is `mass_3`. The variables are those of a point file (docs/data.md) with one value per run, batch,
    block, exponent or level of J, among them `mean_distance`, `mean_distance_error`, `lyapunov_exponent` and `status`,
    which is 0 for a completed run. The series of a run are left out, since `simulate` returns them: the variables over
    `sample`, `earlier_event`, `event`, `crossing` and `trajectory_time`. The states `minus` and `plus` follow v; other
    numbers are the same at every point, and so are those of every state if springs, masses or thresholds vary: the
    attribute `remark` then says so. Raises ValueError, one line, for a wrong argument; an error at one point names it.

    >>> from burridge_knopoff import sweep
    >>> runs = sweep("nonlinear", [0.02, 0.05, 0.3], transient=1000, window=500, batches=2)
    >>> runs.mean_distance.dims, runs.lyapunov_exponent.shape
    (('a',), (3, 3))
    >>> (runs.mean_distance < 1e-6).values.tolist()
    [True, True, False]
    >>> runs = sweep("linearized", 0.08, "plus", v=[0.05, 0.1], coupling=[0.9, 1.0, 1.1], transient=1000, window=500)
    >>> runs.mean_distance.dims, runs.mean_distance.shape
    (('v', 'coupling'), (2, 3))
    """
    state = given_state(initial)
    names = fields_of(Settings)
    chosen = settings_of(Settings, settings, {name: value for name, value in by_name.items() if name in names})
    cores = available_cores() if cores is None else Whole(1, 1024).form(cores, "cores")
    parameters = {
        name: value for name, value in (("a", a), *by_name.items()) if name not in names and value is not None
    }
    base, axes = _grid(law, parameters, state.blocks, chain, contact)
    points = [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]
    models = _checked_models(base, points, state, chosen)
    warn_of_cost(max(models, key=lambda model: model.chain.highest_rate), state, chosen)
    size = min(LOCKSTEP_RUNS, -(-len(points) // cores))

    def run_from(first: int) -> list[tuple[dict[str, Any], dict[str, Any]]]:
        return _run_together(points[first : first + size], models[first : first + size], state, chosen)

    runs = map_in_threads(cores, run_from, range(0, len(points), size))
    dataset = _dataset(axes, [*chained.from_iterable(runs)])
    if remark := "; ".join(remarks_on_states([state], axes)):
        dataset.attrs["remark"] = remark
    return dataset


def _checked_models(
    base: Model, points: Sequence[Mapping[str, float]], state: InitialState, settings: Settings
) -> list[Model]:
    """Return the model at each point; raises ValueError if a run cannot begin there."""
    models = [_call_at(point, base.at, **point) for point in points]
    for point, model in zip(points, models, strict=True):
        settings.check_chain(model.chain)
        _call_at(point if len(point) > 1 else {}, model.begin, state, settings.start)
    return models


def _run_together(
    points: Sequence[Mapping[str, float]], models: Sequence[Model], state: InitialState, settings: Settings
) -> list[tuple[dict[str, Any], dict[str, Any]]]:
    """Return the common variables and the attributes of the runs at some points."""
    jobs = [_call_at(point, prepare, model, state, settings) for point, model in zip(points, models, strict=True)]
    ends = run_together([job.runner for job in jobs])
    runs = []
    for point, job, end in zip(points, jobs, ends, strict=True):
        run = job.result(_call_at(point, job.runner.status_of, end))
        values = point_values(run)
        runs.append(({name: values[name] for name in _COMMON}, point_attributes(run)))
    return runs


def _dataset(
    axes: Mapping[str, list[float]], runs: Sequence[tuple[Mapping[str, Any], Mapping[str, Any]]]
) -> xarray.Dataset:
    """Return the runs as a Dataset over the axes, with the attributes that are the same for all of them."""
    import xarray

    shape = [len(values) for values in axes.values()]
    plain = {name: plain_name(name) for name in axes}
    data: dict[str, Any] = {}
    for name, item in _COMMON.items():
        if item.coordinate:
            data[name] = item.dimensions, np.asarray(runs[0][0][name], item.dtype), item.all_attributes()
        else:
            array = np.array([values[name] for values, _ in runs], item.dtype)
            dimensions = *plain.values(), *item.dimensions
            data[name] = dimensions, array.reshape((*shape, *array.shape[1:])), item.all_attributes()
    for name, values in axes.items():
        item = _COMMON.get(name, Variable((), "f8", f"parameter {name} of the model"))
        data[plain[name]] = plain[name], values, item.all_attributes()
    first, *others = (attributes for _, attributes in runs)
    common = {key: value for key, value in first.items() if all(other.get(key) == value for other in others)}
    return xarray.Dataset(data, attrs=common).set_coords({name for name, item in _COMMON.items() if item.coordinate})


def _grid(
    law: Model | GivenLaw, parameters: Mapping[str, Any], blocks: int | None, chain: Chain | None, contact: str | None
) -> tuple[Model, dict[str, list[float]]]:
    """Return the model with all single-valued parameters, and the values of those given as sequences."""
    axes: dict[str, list[Any]] = {
        name: values for name, value in parameters.items() if (values := elements(value)) is not None
    }
    for name, values in axes.items():
        if any(map(is_sequence, values)):
            raise refusal(full_key("", name), parameters[name], "one number or a sequence of numbers")
        if not values:
            raise ValueError(f"{full_key('', name)}: got no value, expected at least one")
    single = {name: value for name, value in parameters.items() if name not in axes}
    if isinstance(law, Model):
        base = given_model(law, None, blocks, chain, None, contact)
    else:
        first = axes["a"][0] if "a" in axes else single.get("a", law.a if isinstance(law, Law) else None)
        base = given_model(law, first, blocks, chain, None, contact)
    for name in parameters:
        if name not in base.parameter_names and parse_indexed_name(name) is None:
            names = " | ".join([format_parameter_names(base.parameter_names), *sorted(fields_of(Settings))])
            raise ValueError(f"{full_key('', name)}: not a setting or a parameter, expected {names}")
    base = base.at(**single)
    for name, values in axes.items():
        axes[name] = [base.at(**{name: value}).parameter(name) for value in values]
        value, count = Counter(axes[name]).most_common(1)[0]
        if count > 1:
            raise ValueError(f"{name}: got {format_value(value)} twice, expected each value once")
    return base, axes


def _call_at(point: Mapping[str, float], function: Callable[..., _T], *arguments: Any, **by_name: Any) -> _T:
    """Call a function; an error names the point of the grid."""
    try:
        return function(*arguments, **by_name)
    except (ValueError, MemoryError) as error:
        place = ", ".join(f"{name} = {value!r}" for name, value in point.items())
        raise type(error)(f"{place}: {error}" if place else str(error)) from error
