"""One rule for every argument that is a sequence, in all public functions and classes: which values are one."""

import array
import collections
import inspect
import re

import numpy as np
import pandas as pd
import pytest
import xarray as xr

import burridge_knopoff
from burridge_knopoff import (
    Chain,
    ChainState,
    InitialState,
    Model,
    SearchSettings,
    basin_map,
    continue_attractors,
    edge_state,
    find_attractors,
    fit_slope,
    follow,
    follow_bifurcation,
    hopf_bifurcations,
    label_states,
    locate_bifurcations,
    record_events,
    simulate,
    sweep,
)
from burridge_knopoff.basins.settings import BasinSettings
from tests.library.test_wrong_types import CALLS, DROPPING, MODEL, QUICK, REST
from tests.refused import refused

POSITION, VELOCITY = [-0.9, -1.1, -0.95], [0.1, 0.11, 0.12]
STATES = [POSITION, VELOCITY]
SEARCH = {"samples": 0, "transient": 100, "window": 100, "time_limit": 200}
MAGNITUDES = np.random.default_rng(1).exponential(1.0, 50).tolist()
EVENTS = record_events(DROPPING, REST, 60.0)
EVENT_VALUES = np.linspace(0.5, 2.0, len(EVENTS.time)).tolist()
ENDS = [0.0864, 0.0866]


def initial_of(**options):
    return simulate(Model("linearized", a=0.08), **options, **QUICK).initial


def end_from(position, velocity):
    return simulate(MODEL, initial=ChainState(position, velocity, [False] * 3), **QUICK).final.vector()


#: {argument: a list of numbers that it takes, and what comes of them}
NUMBERS = {
    "Chain.coupling": ([1.0, 1.5], lambda x: Chain(3, coupling=x).coupling),
    "Chain.pulling": ([1.0, 0.0, 2.0], lambda x: Chain(3, pulling=x).pulling),
    "Chain.threshold": ([1.0, 1.1, 1.2], lambda x: Chain(3, threshold=x).threshold),
    "Chain.mass": ([1.0, 1.1, 1.2], lambda x: Chain(3, mass=x).mass),
    "Chain.weakening": ([1.0, -0.5, 0.0], lambda x: Chain(3, weakening=x).weakening),
    "Chain.grid": ([2, 3], lambda x: Chain(grid=x).grid),
    "Chain.damping": ([0.0, 0.5], lambda x: Chain(3, damping=x).damping),
    "Chain.pulling_damping": ([0.0, 0.5, 0.1], lambda x: Chain(3, pulling_damping=x).pulling_damping),
    "Chain.force.position": (POSITION, MODEL.chain.force),
    "Chain.damping_force.velocity": (VELOCITY, lambda x: Chain(3, damping=0.1).damping_force(x, 0.1)),
    "Law.__call__.speed": (VELOCITY, MODEL.law),
    "Law.slope.speed": (VELOCITY, MODEL.law.slope),
    "FormulaLaw.__call__.speed": (VELOCITY, burridge_knopoff.FormulaLaw("1 - a*u", a=0.1)),
    "FormulaLaw.slope.speed": (VELOCITY, burridge_knopoff.FormulaLaw("1 - a*u", a=0.1).slope),
    "InitialState.position": (POSITION, lambda x: InitialState("own", x, 0.1).position),
    "InitialState.velocity": (VELOCITY, lambda x: InitialState("own", -0.9, x).velocity),
    "ChainState.position": ([0.0, 0.1, 0.2], lambda x: end_from(x, VELOCITY)),
    "ChainState.velocity": (VELOCITY, lambda x: end_from(POSITION, x)),
    "SearchSettings.position": ([-1.0, 1.0], lambda x: SearchSettings(position=x).position),
    "SearchSettings.velocity": ([0.0, 0.2], lambda x: SearchSettings(velocity=x).velocity),
    "simulate.initial": (STATES, lambda x: initial_of(initial=x).position),
    "simulate.initial[0]": (POSITION, lambda x: initial_of(initial=(x, VELOCITY)).position),
    "simulate.initial.velocity": (VELOCITY, lambda x: initial_of(initial={"position": -0.9, "velocity": x}).velocity),
    "sweep.a": ([0.05, 0.08], lambda x: sweep(Model("linearized"), a=x, **QUICK).mean_distance),
    "sweep.v": ([0.05, 0.08], lambda x: sweep(Model("linearized"), a=0.08, v=x, **QUICK).mean_distance),
    "sweep.initial": (STATES, lambda x: sweep(Model("linearized"), x, a=0.08, **QUICK).mean_distance),
    "BasinSettings.first_position": ([-1.0, 1.0], lambda x: BasinSettings(first_position=x).first_position),
    "BasinSettings.first_velocity": ([0.0, 1.0], lambda x: BasinSettings(first_velocity=x).first_velocity),
    "BasinSettings.last_position": ([-1.0, 1.0], lambda x: BasinSettings(last_position=x).last_position),
    "label_states.position": (STATES, lambda x: label_states(MODEL, [], x, [VELOCITY] * 2)),
    "label_states.velocity": (STATES[1:] * 2, lambda x: label_states(MODEL, [], [POSITION] * 2, x)),
    "fit_slope.magnitude": (MAGNITUDES, lambda x: fit_slope(x, 0.0).b),
    "fit_slope.time": (MAGNITUDES, lambda x: fit_slope(MAGNITUDES, 0.0, time=x).b),
    "Catalogue.mean.values": (EVENT_VALUES, lambda x: EVENTS.mean(x)),
    "Catalogue.mean.weights": (EVENT_VALUES, lambda x: EVENTS.mean(EVENT_VALUES, x)),
    "Catalogue.rate.chosen": ([value > 1.0 for value in EVENT_VALUES], lambda x: EVENTS.rate(x)),
    "continue_attractors.a": (
        [0.08, 0.09],
        lambda x: continue_attractors(Model("linearized"), a=x, **SEARCH, fraction_width=0.5, cores=1).mean_distance,
    ),
    "follow.initial": (
        STATES,
        lambda x: [p.value for p in follow(Model("linearized", a=0.08), [0.0799, 0.0801], initial=x, parameter="a")],
    ),
    "follow.interval": (ENDS, lambda x: [len(follow(CALLS["follow"]["orbit"], x, parameter="a"))]),
    "hopf_bifurcations.interval": (ENDS, lambda x: [len(hopf_bifurcations(MODEL, x, parameter="a"))]),
}
#: {argument: a list of other things that it takes, and what comes of them}
THINGS = {
    "find_attractors.starts": (
        ["minus", "plus"],
        lambda x: find_attractors(Model("linearized", a=0.08), starts=x, **SEARCH)[1],
    ),
    "sweep.model": (
        [Model("linearized"), Model("nonlinear")],
        lambda x: sweep(x, a=0.08, **QUICK).mean_distance,
    ),
    "label_states.attractors": (
        CALLS["edge_state"]["attractors"],
        lambda x: label_states(CALLS["edge_state"]["model"], x, [POSITION], [VELOCITY])[0],
    ),
    "continue_attractors.starts": (
        ["minus", "plus"],
        lambda x: (
            continue_attractors(
                Model("linearized"), a=[0.08], starts=x, **SEARCH, fraction_width=0.5, cores=1
            ).mean_distance
        ),
    ),
    "locate_bifurcations.branch": (CALLS["locate_bifurcations"]["branch"], lambda x: len([*locate_bifurcations(x)])),
}
#: Those that are slow, or need more of their value: only the refusal is tried.
REFUSALS = {
    "sweep.law": lambda x: sweep(x, a=0.08, **QUICK),
    "basin_map.initial": lambda x: basin_map(Model("linearized", a=0.08), x),
    "basin_map.first_position": lambda x: basin_map(Model("linearized", a=0.08), first_position=x),
    "basin_map.first_velocity": lambda x: basin_map(Model("linearized", a=0.08), first_velocity=x),
    "basin_map.last_position": lambda x: basin_map(Model("linearized", a=0.08), last_position=x),
    "edge_state.attractors": lambda x: edge_state(**{**CALLS["edge_state"], "attractors": x}),
    "follow_bifurcation.interval": lambda x: follow_bifurcation(CALLS["follow_bifurcation"]["bifurcation"], interval=x),
    "follow_bifurcation.parameters": lambda x: follow_bifurcation(CALLS["follow_bifurcation"]["bifurcation"], x),
}
#: Parameters of a model and masks are booleans or single numbers as well; these are formulas for arrays.
FORMULAS = {"Model.stuck_blocks.position", "Model.stuck_blocks.velocity", "Model.check_directions.velocity"}
FORMULAS |= {"Model.friction.speed", "Model.friction_slope.speed", "Chain.sliding_offset.friction"}
FORMULAS |= {"SteadyMotion.replace_returns.returns", "SteadyMotion.replace_returns.mirror_returns"}


def table(rows):
    return pd.DataFrame(rows) if isinstance(rows[0], list) else pd.Series(rows)


ACCEPTED = {
    "tuple": tuple,
    "deque": collections.deque,
    "array of numpy": np.array,
    "masked array without a mask": np.ma.array,
    "array of xarray": xr.DataArray,
    "series or table of pandas": table,
    "index of pandas": lambda x: table(x) if isinstance(x[0], list) else pd.Index(x),
    "list of numbers of numpy": lambda x: list(np.array(x)),
    "array of objects": lambda x: [np.array(row, dtype=object).tolist() for row in x],
}
REFUSED = {
    "set": lambda x: set(map(str, x)) if isinstance(x[0], list) else set(x),
    "frozenset": lambda x: frozenset(map(str, x)),
    "keys": lambda x: dict.fromkeys(map(str, x)).keys(),
    "generator": lambda x: (item for item in x),
    "map": lambda x: map(abs, x),
    "text": lambda x: "0.1 0.2",
    "bytes": lambda x: bytes(range(len(x))),
    "Dataset": lambda x: xr.Dataset({"x": ("block", np.ones(len(x)))}),
    "dates": lambda x: np.zeros(len(x), "datetime64[ns]"),
    "durations": lambda x: pd.Series(np.zeros(len(x), "timedelta64[ns]")),
    "large set": lambda x: set(np.arange(1e4)),
    "large table of words": lambda x: pd.Series(["word"] * 10_000),
    "array of arrays of words": lambda x: xr.DataArray(np.full((10, 10, 10), "word")),
}


def sequences():
    """Yield the arguments of public functions, methods and classes of settings that are a sequence."""
    for name in burridge_knopoff.__all__:
        item = getattr(burridge_knopoff, name)
        if inspect.isfunction(item):
            yield from arguments(name, item)
        elif inspect.isclass(item):
            if name in ("Chain", "ChainState", "InitialState", "SearchSettings"):
                yield from arguments(name, item.__init__)
            for method, function in inspect.getmembers(item, inspect.isfunction):
                is_public = method == "__call__" or not method.startswith("_")
                if is_public and function.__module__.startswith("burridge_knopoff"):
                    yield from arguments(f"{name}.{method}", function)


def arguments(name, function):
    for parameter in inspect.signature(function).parameters.values():
        kind = str(parameter.annotation)
        if re.search(r"Sequence|ArrayLike|ndarray|tuple\[|Initial\b", kind) and "Callable" not in kind:
            yield f"{name}.{parameter.name}"


def test_every_argument_that_is_a_sequence_is_tried():
    # A mask of blocks takes anything that numpy takes as true or false.
    assert {*sequences()} - FORMULAS - {"ChainState.stuck"} <= NUMBERS.keys() | THINGS.keys() | REFUSALS.keys()


@pytest.mark.parametrize("argument", NUMBERS)
def test_what_is_a_sequence_of_numbers(argument):
    """Every kind gives what a list gives."""
    values, call = NUMBERS[argument]
    expected = np.asarray(call(values))
    for kind, convert in ACCEPTED.items():
        if kind != "array of objects" or isinstance(values[0], list):
            assert np.array_equal(np.asarray(call(convert(values))), expected, equal_nan=True), kind
    if isinstance(values[0], float):
        assert np.array_equal(np.asarray(call(array.array("d", values))), expected, equal_nan=True)


@pytest.mark.parametrize("argument", THINGS)
def test_what_is_a_sequence_of_things(argument):
    values, call = THINGS[argument]
    expected = call(values)
    of_objects = np.empty(len(values), dtype=object)
    of_objects[:] = values
    for other in (tuple(values), of_objects):
        assert np.array_equal(call(other), expected)


@pytest.mark.parametrize("argument", [*NUMBERS, *THINGS, *REFUSALS])
def test_what_is_none_is_refused_in_a_short_line(argument):
    """The line has no more than the beginning of the value."""
    values, call = {**NUMBERS, **THINGS}.get(argument, (ENDS, REFUSALS.get(argument)))
    for kind, convert in REFUSED.items():
        with pytest.raises(ValueError, match=r"^[^\n:]+: [^\n]+$") as caught:
            call(convert(values))
        assert len(str(caught.value)) < 280, kind


@pytest.mark.parametrize("value", [(i for i in ()), map(abs, ()), iter([1.0])])
def test_messages_have_no_addresses(value):
    with refused("position") as caught:
        InitialState("own", value, 0.1)
    assert "0x" not in str(caught.value)
