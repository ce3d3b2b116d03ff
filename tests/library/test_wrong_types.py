"""Every public call refuses a value of a wrong type in one line that names the argument."""

import inspect

import numpy as np
import pytest
import xarray

import burridge_knopoff
from burridge_knopoff import (
    Chain,
    ContinuationSettings,
    EdgeSettings,
    InitialState,
    Model,
    SearchSettings,
    Symmetry,
    find_attractors,
    follow,
    law_of,
    limit_cycle,
    locate_bifurcations,
    simulate,
    synchronized_orbit,
)

MODEL = Model(Chain(3), law_of("linearized", 0.0865))
STATE = MODEL.begin(InitialState("own", (-0.9, -1.1, -0.9), (0.1, 0.1, 0.1)))
DROPPING = Model(Chain(2), law_of("carlson_langer", 1.0))
REST = DROPPING.begin(InitialState("rest", (-0.5, -0.6), (0.0, 0.0)), "tested")
QUICK = {"transient": 0, "window": 1, "batches": 2}
EDGE_MODEL = Model(Chain(3), law_of("linearized", 0.08))
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
    branch = follow(orbit, (0.0864, 0.0871))
    (bifurcation,) = locate_bifurcations(branch)
    return {
        "basin_map": {"law": "linearized", "a": 0.08, "initial": "minus", "pixels": 1, "samples": 1},
        "limit_cycle": {"model": MODEL, "state": STATE, "settling": 1000.0},
        "edge_state": {
            "model": EDGE_MODEL,
            "state_a": EDGE_ATTRACTORS[0].motion.state(),
            "state_b": EDGE_ATTRACTORS[1].motion.state(),
            "attractors": EDGE_ATTRACTORS,
            "settings": EdgeSettings(duration=3000, samples=20),
            "time_limit": 20_000,
        },
        "event_exponents": {"model": DROPPING, "start": REST, "end": 90.0, "begin": 10.0, "count": 1},
        "event_multipliers": {"model": DROPPING, "start": REST, "end": 10.3},
        "find_attractors": {"law": "linearized", "a": 0.08, "settings": SEARCH, "starts": ["plus"]},
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
        "label_states": {"model": MODEL, "attractors": [], "position": np.ones((1, 3)), "velocity": np.ones((1, 3))},
        "law_of": {"name": "linearized", "a": 0.08, "description": {}},
        "locate_bifurcations": {"branch": branch},
        "mode_amplitudes": {"model": MODEL, "state": STATE, "duration": 10.0},
        "multipliers": {"orbit": orbit},
        "open_study": {"results": "results/nothing"},
        "record_events": {
            "model": DROPPING,
            "start": REST,
            "end": 9.0,
            "begin": 0.0,
            "profiles": False,
            "loading": "steady",
            "solver": "series",
            "step": 0.1,
        },
        "simulate": {
            "law": "linearized",
            "a": 0.08,
            "initial": "minus",
            "settings": None,
            "chain": None,
            "v": 0.1,
            **QUICK,
        },
        "decode_flags": {"flags": xarray.DataArray([0], attrs={"flag_values": [0], "flag_meanings": "stop"})},
        "sweep": {
            "law": "linearized",
            "a": [0.08],
            "initial": "minus",
            "settings": None,
            "chain": None,
            "v": [0.1],
            **QUICK,
        },
        "synchronized_orbit": {"model": MODEL},
        "transverse_exponent": {"model": MODEL, "state": STATE, "alignment": 10.0, "window": 10.0},
    }


CALLS = correct_calls()


def test_every_public_function_is_tried():
    public = {name for name in burridge_knopoff.__all__ if inspect.isfunction(getattr(burridge_knopoff, name))}
    assert public == set(CALLS)


@pytest.mark.parametrize(("name", "argument"), [(name, key) for name, given in CALLS.items() for key in given])
def test_a_wrong_type_is_refused_in_one_line(name, argument):
    call = getattr(burridge_knopoff, name)
    refused = 0
    for wrong in WRONG:
        try:
            call(**{**CALLS[name], argument: wrong})
        except (ValueError, FileNotFoundError) as error:
            text = str(error)
            assert "\n" not in text, text
            assert len(text) < 400, text
            refused += 1
    # The others are allowed: None where there is a default, a number or a text where one is taken.
    assert refused >= len(WRONG) - 3


@pytest.mark.parametrize("kind", ["Chain", "Model", "InitialState", "Settings", "SearchSettings", "MotionSettings"])
def test_help_shows_plain_types(kind):
    shown = inspect.getdoc(getattr(burridge_knopoff, kind)) + str(inspect.signature(getattr(burridge_knopoff, kind)))
    assert "Annotated" not in shown
    assert ": " in str(inspect.signature(getattr(burridge_knopoff, kind)))


def test_results_print_in_a_line_or_two():
    orbit = CALLS["follow"]["orbit"]
    branch = CALLS["locate_bifurcations"]["branch"]
    run = simulate("linearized", 0.08, "plus", **QUICK)
    attractors, _ = burridge_knopoff.find_attractors("linearized", 0.08, SEARCH)
    for result in (run, run.final, MODEL, orbit, branch[0], burridge_knopoff.multipliers(orbit), *attractors):
        assert "\n" not in repr(result)
        assert len(repr(result)) <= 240, repr(result)
