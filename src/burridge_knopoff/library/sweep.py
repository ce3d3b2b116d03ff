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
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import (
    format_parameter_names,
    parameter_names,
    parameter_value,
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
_COMMON_DIMENSIONS = {"batch", "exponent", "level"}
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
    exponent or level of J, among them `mean_distance`, `mean_distance_error`, `lyapunov_exponent` and `status`, which
    is 0 for a completed run. The states `minus` and `plus` follow v; other numbers are the same at every point, and so
    are those of every state if springs, masses or thresholds vary: the attribute `remark` then says so. Raises
    ValueError, one line, for a wrong argument; an error at one point names it.

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
    if cores is not None:
        cores = Whole(1, 1024).form(cores, "cores")
    parameters = {
        name: value for name, value in (("a", a), *by_name.items()) if name not in names and value is not None
    }
    base, axes = _grid(law, parameters, state.blocks, chain, contact)
    points = [dict(zip(axes, values, strict=True)) for values in product(*axes.values())]
    models = [_call_at(point, base.at, **point) for point in points]
    for point, model in zip(points, models, strict=True):
        chosen.check_chain(model.chain)
        _call_at(point if len(axes) > 1 else {}, model.begin, state, chosen.start)
    warn_of_cost(max(models, key=lambda model: model.chain.highest_rate), state, chosen)

    def some(first: int) -> list[tuple[dict[str, Any], dict[str, Any]]]:
        part = range(first, min(first + size, len(points)))
        jobs = [_call_at(points[k], prepare, models[k], state, chosen) for k in part]
        how = run_together([job.runner for job in jobs])
        statuses = [_call_at(points[k], job.runner.status_of, end) for k, job, end in zip(part, jobs, how, strict=True)]
        runs = [job.result(status) for job, status in zip(jobs, statuses, strict=True)]
        return [(_common_values(point_values(run)), point_attributes(run)) for run in runs]

    cores = cores or available_cores()
    size = min(LOCKSTEP_RUNS, -(-len(points) // cores))
    results = list(chained.from_iterable(map_in_threads(cores, some, range(0, len(points), size))))
    import xarray

    shape = [len(values) for values in axes.values()]
    plain = {name: plain_name(name) for name in axes}
    data: dict[str, Any] = {}
    for name, item in _COMMON.items():
        if item.coordinate:
            data[name] = item.dimensions, np.asarray(results[0][0][name], item.dtype), item.all_attributes()
        else:
            array = np.array([numbers[name] for numbers, _ in results], item.dtype)
            dimensions = *plain.values(), *item.dimensions
            data[name] = dimensions, array.reshape((*shape, *array.shape[1:])), item.all_attributes()
    for name, values in axes.items():
        item = _COMMON.get(name, Variable((), "f8", f"parameter {name} of the model"))
        data[plain[name]] = plain[name], values, item.all_attributes()
    first, *other_attributes = (attributes for _, attributes in results)
    common = {key: value for key, value in first.items() if all(other.get(key) == value for other in other_attributes)}
    if remark := "; ".join(remarks_on_states([state], axes)):
        common["remark"] = remark
    return xarray.Dataset(data, attrs=common).set_coords({name for name, item in _COMMON.items() if item.coordinate})


def _common_values(values: Mapping[str, Any]) -> dict[str, Any]:
    return {name: values[name] for name in _COMMON}


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
        if name not in parameter_names(base) and parse_indexed_name(name) is None:
            names = " | ".join([format_parameter_names(base), *sorted(fields_of(Settings))])
            raise ValueError(f"{full_key('', name)}: not a setting or a parameter, expected {names}")
    base = base.at(**single)
    for name, values in axes.items():
        axes[name] = [parameter_value(base.at(**{name: value}), name) for value in values]
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
