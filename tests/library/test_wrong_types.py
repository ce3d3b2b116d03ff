"""Every public call refuses a value of a wrong type in one line that names the argument."""

import inspect
import math
import re

import numpy as np
import pytest
import xarray

import burridge_knopoff
from burridge_knopoff import (
    ContinuationSettings,
    EdgeSettings,
    FormulaLaw,
    InitialState,
    Model,
    MotionSettings,
    OrbitError,
    PhysicalUnits,
    SearchSettings,
    Symmetry,
    find_attractors,
    follow,
    hopf_bifurcations,
    limit_cycle,
    locate_bifurcations,
    mode_amplitudes,
    record_events,
    simulate,
    synchronized_orbit,
)
from tests.refused import refused

MODEL = Model("linearized", a=0.0865)
STATE = MODEL.begin(InitialState("own", (-0.9, -1.1, -0.9), (0.1, 0.1, 0.1)))
DROPPING = Model("carlson_langer", a=1.0, blocks=2)
WEAKENING = Model(FormulaLaw("1 - a*u + b*u**3", a=0.5, b=0.3), blocks=1, v=0.7)
REST = DROPPING.begin(InitialState("rest", (-0.5, -0.6), (0.0, 0.0)), "tested")
QUICK = {"transient": 0, "window": 1, "batches": 2}
EDGE_MODEL = Model("linearized", a=0.08)
EDGE_ATTRACTORS = find_attractors(EDGE_MODEL, starts=["plus"], samples=12, transient=500, window=500)[0]
SEARCH = SearchSettings(samples=1, fraction_width=0.49, transient=100, window=100, time_limit=200)
WRONG = (
    object(),
    {1, 2},
    b"minus",
    1j,
    np.array(["x"]),
    lambda: None,
    "no such thing",
    [[]],
    {"x": object()},
    -1.5,
    None,
)


def correct_calls():
    """Return arguments that each public function takes, by its name."""
    orbit = limit_cycle(MODEL, synchronized_orbit(MODEL).reference)
    branch = follow(orbit, (0.0864, 0.0871), parameter="a")
    (bifurcation,) = locate_bifurcations(branch)
    return {
        "basin_map": {"model": EDGE_MODEL, "initial": "minus", "pixels": 1, "samples": 1},
        "limit_cycle": {"model": MODEL, "state": STATE, "settling": 1000.0},
        "edge_state": {
            "model": EDGE_MODEL,
            "state_a": EDGE_ATTRACTORS[0].motion.state(),
            "state_b": EDGE_ATTRACTORS[1].motion.state(),
            "attractors": EDGE_ATTRACTORS,
            "settings": EdgeSettings(duration=3000, samples=20),
            "time_limit": 20_000,
        },
        "event_exponents": {"model": DROPPING, "state": REST, "end": 90.0, "begin": 10.0, "count": 1},
        "event_multipliers": {"model": DROPPING, "state": REST, "end": 10.3},
        "find_attractors": {"model": EDGE_MODEL, "settings": SEARCH, "starts": ["plus"]},
        "continue_attractors": {
            "model": EDGE_MODEL,
            "coupling": [1.0],
            "settings": SEARCH,
            "refine": 1.0,
            "starts": ["plus"],
            "cores": 1,
        },
        "find_periodic_orbit": {
            "model": MODEL,
            "guess": orbit.reference,
            "return_time": orbit.return_time,
            "symmetry": Symmetry.ASYMMETRIC,
        },
        "block_frequencies": {"model": MODEL, "state": STATE, "duration": 10.0},
        "fit_slope": {"magnitude": np.linspace(0.0, 1.0, 20), "low": 0.0, "high": 1.0},
        "follow": {"orbit": orbit, "interval": (0.0864, 0.0866), "settings": ContinuationSettings(), "parameter": "a"},
        "follow_bifurcation": {
            "bifurcation": bifurcation,
            "parameters": ("a", "v"),
            "interval": (0.0999, 0.1001),
            "settings": ContinuationSettings(first_step=1e-3, largest_step=1e-2),
        },
        "hopf_bifurcations": {"model": MODEL, "interval": (0.0, 0.2), "parameter": "pulling_damping"},
        "label_states": {"model": MODEL, "attractors": [], "position": np.ones((1, 3)), "velocity": np.ones((1, 3))},
        "law_of": {"law": "linearized", "a": 0.08},
        "locate_bifurcations": {"branch": branch},
        "mode_amplitudes": {"model": MODEL, "state": STATE, "duration": 10.0},
        "multipliers": {"orbit": orbit},
        "open_study": {"results": "results/nothing"},
        "plot": {"result": branch, "axes": None},
        "record_events": {
            "model": DROPPING,
            "state": REST,
            "end": 9.0,
            "begin": 0.0,
            "profiles": False,
            "loading": "steady",
            "solver": "series",
            "step": 0.1,
        },
        "simulate": {
            "model": EDGE_MODEL,
            "initial": "minus",
            "settings": None,
            **QUICK,
        },
        "decode_flags": {"flags": xarray.DataArray([0], attrs={"flag_values": [0], "flag_meanings": "stop"})},
        "sweep": {
            "model": EDGE_MODEL,
            "initial": "minus",
            "settings": None,
            "a": [0.08],
            "v": [0.1],
            **QUICK,
        },
        "synchronized_orbit": {"model": MODEL},
        "transverse_exponent": {"model": MODEL, "state": STATE, "alignment": 10.0, "window": 50.0},
    }


CALLS = correct_calls()


def test_every_public_function_is_tried():
    public = {name for name in burridge_knopoff.__all__ if inspect.isfunction(getattr(burridge_knopoff, name))}
    assert public == set(CALLS)


def test_a_wrong_type_is_refused_in_one_line():
    """But where it is allowed: None where there is a default, a number or a text where one is taken."""
    lenient = []
    for name, arguments in CALLS.items():
        call = getattr(burridge_knopoff, name)
        for argument in arguments:
            count = 0
            for wrong in WRONG:
                try:
                    call(**{**arguments, argument: wrong})
                except (ValueError, FileNotFoundError) as error:
                    text = str(error)
                    count += "\n" not in text and len(text) < 400
            if count < len(WRONG) - 3:
                lenient.append((name, argument))
    assert lenient == []


#: Methods with numbers that are settings, and arguments that they take.
METHODS = {
    "Catalogue.slope": lambda: (record_events(DROPPING, REST, 200.0), {"low": -9.0, "high": 9.0}),
    "HopfBifurcation.orbit": lambda: (hopf_bifurcations(WEAKENING, (0.7, 0.8), parameter="v")[0], {"amplitude": 0.02}),
    "InitialState.coordinates": lambda: (InitialState("own", -0.9, 0.1), {"blocks": 3}),
    "MotionSettings.scaled_by": lambda: (MotionSettings(), {"share": 0.5}),
    "MotionSettings.scaled_to_velocity": lambda: (MotionSettings(), {"v": 0.05}),
    "Model.at": lambda: (MODEL, {"v": 0.2}),
    "ModeAmplitudes.line": lambda: (mode_amplitudes(MODEL, STATE), {"frequency": 0.1}),
    "ModeAmplitudes.line_shares": lambda: (mode_amplitudes(MODEL, STATE), {"frequency": 0.1}),
    "Law.at": lambda: (MODEL.law, {}),
    "FormulaLaw.at": lambda: (FormulaLaw("1 - c*a*u", a=0.1, c=0.5), {"c": 0.4}),
    "PeriodicOrbit.events_of": lambda: (CALLS["follow"]["orbit"], {"block": 1}),
    "PeriodicOrbit.start": lambda: (CALLS["follow"]["orbit"], {"block": 1}),
    "PeriodicOrbit.stick_time": lambda: (CALLS["follow"]["orbit"], {"block": 1}),
    "PhysicalUnits.v": lambda: (PhysicalUnits(0.5, 200.0, 2.0), {"speed": 0.02}),
    "PhysicalUnits.speed": lambda: (PhysicalUnits(0.5, 200.0, 2.0), {"v": 0.1}),
    "PhysicalUnits.a": lambda: (PhysicalUnits(0.5, 200.0, 2.0), {"friction_slope": -0.8}),
    "PhysicalUnits.friction_slope": lambda: (PhysicalUnits(0.5, 200.0, 2.0), {"a": 0.1}),
    "Run.catalogue": lambda: (simulate(DROPPING, initial=REST, **QUICK), {"window": 5.0, "transient": 1.0}),
}
#: Functions of a physical quantity.
FORMULAS = {
    "Chain.damping_force",
    "Chain.sliding_offset",
    "Law.least_friction",
    "FormulaLaw.least_friction",
    "Law.steepest_slope",
    "FormulaLaw.steepest_slope",
    "Model.least_friction",
    "Model.check_directions",
    "SteadyMotion.amplitude",
}
TYPES = ("float", "int", "bool", "Any")
INTERVALS = [("basin_map", name) for name in ("first_position", "last_position", "first_velocity")]
INTERVALS += [(name, "interval") for name in ("follow", "follow_bifurcation", "hopf_bifurcations")]


def with_numbers(function, arguments):
    """Return the parameters of a function that are numbers, or true or false."""
    parameters = inspect.signature(function).parameters
    named = {name for name, item in parameters.items() if re.search(rf"\b({'|'.join(TYPES)})\b", str(item.annotation))}
    numbers = {name for name, value in arguments.items() if isinstance(value, int | float)}
    varying = {name for name, item in parameters.items() if item.kind == inspect.Parameter.VAR_KEYWORD}
    return sorted((named | numbers) - varying - {"initial", *(argument for _, argument in INTERVALS)})


def public_methods():
    for name in burridge_knopoff.__all__:
        kind = getattr(burridge_knopoff, name)
        for method, function in inspect.getmembers(kind, inspect.isfunction) if inspect.isclass(kind) else ():
            if not method.startswith("_") and function.__module__.startswith("burridge_knopoff"):
                yield f"{name}.{method}", function


def test_every_method_with_numbers_is_tried():
    numbered = {name for name, function in public_methods() if set(with_numbers(function, {})) - {"self"}}
    assert numbered - FORMULAS <= {*METHODS}


NUMBERS = [
    (name, key) for name, arguments in CALLS.items() for key in with_numbers(getattr(burridge_knopoff, name), arguments)
]
OF_METHODS = [
    (name, key)
    for name, function in public_methods()
    if name in METHODS
    for key in with_numbers(function, METHODS[name]()[1])
]


@pytest.mark.parametrize("value", [math.nan, math.inf, -math.inf, 0, -1, "x", None, True, 1j])
def test_a_number_that_is_none_is_refused(value):
    """Every public function refuses it in a line that names the argument; 0 and negative numbers may be allowed."""
    wrong = {
        f"{name}.{argument}": words
        for name, argument in [*NUMBERS, *OF_METHODS]
        if (words := answer(name, argument, value)) is not None
    }
    assert wrong == {}


def answer(name, argument, value):
    """Return what is wrong with the answer of a function to a value of one argument; None if it is right."""
    owner, arguments = METHODS[name]() if name in METHODS else (burridge_knopoff, CALLS[name])
    call = getattr(owner, name.rpartition(".")[2])
    parameter = inspect.signature(call).parameters.get(argument)
    truth = parameter is not None and str(parameter.annotation) in ("bool", "bool | None")
    default = parameter.default if parameter is not None else None
    try:
        call(**{**arguments, argument: value})
    except ValueError as error:
        message = str(error)
        is_named = value in (0, -1, default) or argument in message.partition(":")[0]
        is_allowed = not isinstance(error, OrbitError) or value in (0, -1)
        return None if is_named and is_allowed and "\n" not in message else message
    if truth or value is True:
        return None if truth == (value is True) or value == default else "accepted"
    # The range of a slope may be open.
    is_right = value == default or value in (0, -1) or (argument == "high" and value == math.inf)
    return None if is_right else "accepted"


@pytest.mark.parametrize(
    "ends", [(math.nan, 1.0), (0.0, math.nan), (2.0, 1.0), ("x", 1.0), (None, 1.0), (True, 2.0), (1.0,), 0.5]
)
def test_ends_that_are_no_interval_are_refused(ends):
    for name, argument in INTERVALS:
        with refused(argument):
            getattr(burridge_knopoff, name)(**{**CALLS[name], argument: ends})


@pytest.mark.parametrize("kind", ["Chain", "Model", "InitialState", "Settings", "SearchSettings", "MotionSettings"])
def test_help_shows_plain_types(kind):
    text = inspect.getdoc(getattr(burridge_knopoff, kind)) + str(inspect.signature(getattr(burridge_knopoff, kind)))
    assert "Annotated" not in text
    assert ": " in str(inspect.signature(getattr(burridge_knopoff, kind)))


def test_results_print_in_a_line_or_two():
    orbit = CALLS["follow"]["orbit"]
    branch = CALLS["locate_bifurcations"]["branch"]
    run = simulate(Model("linearized", a=0.08), "plus", **QUICK)
    attractors, _ = burridge_knopoff.find_attractors(EDGE_MODEL, SEARCH)
    for result in (run, run.final, MODEL, orbit, branch[0], burridge_knopoff.multipliers(orbit), *attractors):
        assert "\n" not in repr(result)
        assert len(repr(result)) <= 240, repr(result)
