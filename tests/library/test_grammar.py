"""One grammar for all public functions: a model or a law and a, a state in any form, parameters by name."""

import inspect
import warnings

import numpy as np
import pytest
import xarray

import burridge_knopoff
from burridge_knopoff import (
    Chain,
    FormulaLaw,
    InitialState,
    Law,
    Model,
    MotionKind,
    MotionSettings,
    basin_map,
    block_frequencies,
    continue_attractors,
    edge_state,
    find_attractors,
    label_states,
    law_of,
    limit_cycle,
    record_events,
    simulate,
    sweep,
    synchronized_orbit,
)
from burridge_knopoff.model.model import ChainState
from tests.library.test_wrong_types import CALLS
from tests.refused import refused

ROUGH = {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}
SHORT = {"transient": 0.0, "window": 30.0, "batches": 2}
#: Functions of one model, by the name of the argument that is a model or a law.
OF_MODEL = {
    name: key
    for name in burridge_knopoff.__all__
    if inspect.isfunction(function := getattr(burridge_knopoff, name))
    for key in ("model", "law")
    if key in inspect.signature(function).parameters
}
MODEL = Model(Chain(3, coupling=1.3), law_of("stribeck", 0.1, {"sigma": 0.1}), v=0.12, contact="symmetric")
#: The same model, said in other ways: law, a, and arguments by name.
WAYS = {
    "law and a": ("stribeck", 0.1, {"chain": Chain(3, coupling=1.3), "sigma": 0.1}),
    "law with its own a": (MODEL.law, None, {"chain": Chain(3), "coupling": 1.3}),
    "law at another a": (MODEL.law.at(0.3), 0.1, {"blocks": 3, "coupling": 1.3}),
    "as in a config": ({"law": "stribeck", "sigma": 0.3}, 0.1, {"coupling": 1.3, "sigma": 0.1}),
    "formula": (MODEL.law, 0.1, {"coupling": 1.0, "coupling[1]": 1.3, "coupling[2]": 1.3, "eta": 0.2}),
}


def test_the_functions_of_a_model_are_known():
    assert len(OF_MODEL) >= 15
    assert {"simulate", "sweep", "limit_cycle", "label_states", "record_events", "edge_state"} <= OF_MODEL.keys()


@pytest.mark.parametrize("way", WAYS)
def test_a_model_is_the_same_in_every_way(way):
    law, a, options = WAYS[way]
    run = simulate(law, a, "plus", v=0.12, contact="symmetric", **options, **SHORT)
    assert run.model.chain.different_key(MODEL.chain) is None
    assert (run.model.law.formula, run.model.law.parameters) == (MODEL.law.formula, MODEL.law.parameters)
    assert (run.model.a, run.model.v, run.model.contact) == (0.1, 0.12, "symmetric")
    assert np.array_equal(run.velocity, simulate(MODEL, initial="plus", **SHORT).velocity)


SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("basin_map", "edge_state")]


@pytest.mark.parametrize("name", [*sorted(OF_MODEL.keys() - {"basin_map", "edge_state"}), *SLOW])
def test_every_function_of_a_model_takes_a_law_and_a(name):
    arguments = dict(CALLS[name])
    given = arguments.pop(OF_MODEL[name])
    base = given if isinstance(given, Model) else Model(Chain(3), law_of(given, 0.08))
    # A list of a stays.
    grid = {"a": values} if isinstance(values := arguments.get("a"), list) else {}
    arguments = {key: value for key, value in arguments.items() if key not in ("a", "chain", "v")} | grid
    function = getattr(burridge_knopoff, name)
    others = {"chain": base.chain, "v": base.v, "contact": base.contact}
    results = [
        function(base, **arguments),
        function(model=base, **arguments),
        function(base.law.name, **{"a": base.a, **others, **arguments}),
        function(base.law, **others, **arguments),
    ]
    for result in results[1:]:
        assert said(result) == said(results[0])


def said(result):
    """Return all numbers of a result as a text."""
    if isinstance(result, tuple | list):
        return [said(item) for item in result]
    if isinstance(result, xarray.Dataset):
        return [(name, item.values.tolist().__repr__()) for name, item in sorted(result.variables.items())]
    if isinstance(result, np.ndarray | float):
        return np.asarray(result).tolist().__repr__()
    return repr(result)


#: Functions of states: {name: arguments that are a state}
STATES = {
    name: [key for key in ("state", "guess", "state_a", "state_b") if key in CALLS[name]]
    for name in OF_MODEL
    if {"state", "guess", "state_a"} & CALLS[name].keys()
}


@pytest.mark.parametrize("name", [*sorted(STATES.keys() - {"edge_state"}), SLOW[1]])
def test_a_run_stands_for_its_final_state(name):
    function, arguments = getattr(burridge_knopoff, name), CALLS[name]
    model = arguments["model"]
    begun = {key: arguments[key] for key in STATES[name]}
    # Long after the clock of the arguments, a run that changes nothing: it ends where it begins.
    runs = {key: simulate(model, state, transient=0.0, window=1e-3, batches=2) for key, state in begun.items()}
    if name == "event_multipliers":
        runs = {key: simulate(model, state, transient=0.0, window=0.3, batches=2) for key, state in begun.items()}
    ends = {key: run.final for key, run in runs.items()}
    assert said(function(**{**arguments, **runs})) == said(function(**{**arguments, **ends}))


@pytest.mark.parametrize("name", ["limit_cycle", "transverse_exponent", "block_frequencies", "mode_amplitudes"])
def test_an_initial_state_begins_as_in_a_model(name):
    function, arguments = getattr(burridge_knopoff, name), dict(CALLS[name])
    model = arguments["model"]
    own = InitialState("own", (-0.9, -1.1, -0.95), (0.0, 0.1, 0.1))
    forms = ["plus", own, {"position": [-0.9, -1.1, -0.95], "velocity": [0.0, 0.1, 0.1]}, (own.position, own.velocity)]
    for form, state in zip(forms, ["plus", own, own, own], strict=True):
        for start in ("moving", "tested"):
            begun = model.begin(burridge_knopoff.simulate(model, state, **SHORT).initial, start)
            texts = [said(function(**{**arguments, "state": value, "start": start})) for value in (form, begun)]
            assert texts[0] == texts[1]


def test_runs_where_initial_states_are_taken():
    run = simulate("linearized", 0.08, "plus", transient=0, window=200)
    options = {"samples": 12, "transient": 500, "window": 500}
    attractors, labels = find_attractors(run.model, starts=["plus", run, run.final], **options)
    assert (labels[-3:] == labels[-3]).all()
    assert label_states(run.model, attractors, [[0.989, -0.993, -0.991]], [[0.099, 0.1012, 0.1023]])[0] == labels[-3]
    over_v = sweep(run.model, initial=["minus", run], transient=0, window=50)
    again = simulate(run.model, run, transient=0, window=50)
    assert over_v.mean_distance.sel(initial="continued").item() == again.mean_distance
    basins, _ = basin_map(run.model, run, pixels=2, **options)
    position = run.final.position + run.model.sliding_offset
    expected, _ = basin_map(run.model, (position, run.final.velocity), pixels=2, **options)
    assert np.array_equal(basins.branch, expected.branch)


@pytest.mark.parametrize(("change", "key"), [({"a": 0.2}, "a"), ({"v": 0.2}, "v"), ({"mass": 2.0}, "chain.mass")])
def test_a_run_of_another_model_keeps_its_positions_relative_to_the_driver(change, key):
    """Where U − vτ is the same, the spring forces are: under the new model, blocks begin with the old accelerations."""
    run = simulate("nonlinear", 0.1, "plus", **SHORT)
    other = run.model.at(**change)
    with pytest.warns(UserWarning, match=rf"^initial\.{key}: got .*positions relative to the driver"):
        later = simulate(other, run, **SHORT, trajectory=30.0)
    final = run.final
    assert later.begin_time == final.time
    assert np.allclose(later.position[0], run.position[-1], atol=1e-12, rtol=0)
    x = final.position + run.model.sliding_offset - other.sliding_offset
    kept = simulate(other, ChainState(x, final.velocity, final.stuck, final.time), **SHORT)
    assert np.array_equal(later.velocity, kept.velocity)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        same = simulate(run.model.at(0.1), run, **SHORT)
    assert np.array_equal(same.velocity, simulate(run.model, run.final, **SHORT).velocity)
    with refused("initial"):
        simulate(Model(Chain(4), run.model.law), run, **SHORT)


def test_a_stuck_block_starts_if_its_force_is_above_its_new_threshold():
    run = simulate("linearized", 0.1, "plus", transient=0, window=40)
    begins = np.flatnonzero(run.event_kind == 1)[-1]
    stuck = simulate("linearized", 0.1, "plus", transient=0, window=float(run.event_time[begins]) - 0.01)
    block = int(run.event_block[begins]) - 1
    assert stuck.final.stuck[block]
    with pytest.warns(UserWarning, match="stuck blocks"):
        weaker = simulate(stuck.model.at(threshold=0.5), stuck, transient=0, window=0.5, events="all", batches=2)
    first = np.flatnonzero(weaker.event_block == block + 1)[0]
    assert (weaker.event_kind[first], weaker.event_time[first]) == (1, pytest.approx(stuck.end_time, abs=1e-9))


def test_the_name_of_a_setting_is_no_parameter_of_a_law():
    """Either could be meant."""
    law = {"formula": "1 - window*a*u", "window": 0.5}
    own = FormulaLaw(0.1, "1 - samples*a*u", samples=0.5)
    assert simulate(law, 0.1, transient=0.0, batches=2).settings.window == 7000.0
    with refused("window"):
        simulate(law, 0.1, **SHORT)
    with refused("window"):
        sweep(["linearized", law], 0.1, **SHORT)
    with refused("window"):
        limit_cycle(law, 0.1, "plus", window=100.0)
    with refused("samples"):
        find_attractors(own, samples=3)
    with refused("samples"):
        basin_map(Model(Chain(3), own), samples=3)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: simulate("stribeck", 0.1, sigm=0.05), ("sigm", "did you mean sigma")),
        (lambda: simulate("linearized", 0.1, sigma=0.05), ("sigma", "not a setting or a parameter")),
        (lambda: simulate(law_of("linearized", 0.1), sigma=0.05), ("sigma", "not a setting or a parameter")),
        (lambda: simulate("linearized", 0.1, blocks=4, chain=Chain(4)), ("blocks", "together with a chain")),
        (lambda: simulate("linearized", 0.1, {"position": -0.9, "velocity": 0.1}, blocks=0), ("chain.blocks: 0",)),
        (lambda: simulate("linearized", 0.1, InitialState("rough", ROUGH, 0.0)), ("blocks", "missing")),
        (lambda: record_events(MODEL, start=MODEL.begin(InitialState("own", -0.9, 0.1)), end=9.0), ("start", "state")),
        (lambda: limit_cycle("linearized", 0.1, "pluss"), ("state: 'pluss'", "did you mean plus")),
        (lambda: find_attractors("linearized", 0.1, starts=["plus", "other"]), ("starts[1]: 'other'",)),
        (lambda: synchronized_orbit("linearized"), ("a", "without a Model or a Law")),
        (lambda: limit_cycle(simulate(MODEL, initial="plus", **SHORT)), ("law", "formula")),
        (lambda: simulate("linearized", 0.1, mass=[1.0, 1.0, 1.2]), ("mass", "chain=Chain(…, mass=…)")),
        (lambda: simulate("linearized", 0.1, ends="ring"), ("ends: 'ring'", "chain=Chain(…, ends=…)")),
        (lambda: edge_state("linearized", 0.1, "minus", "plus", [], duration=-1.0), ("duration: -1.0",)),
        (lambda: sweep(["stribeck", "linearized"], 0.1, sigma=[0.1, 0.2]), ("law = 'linearized': sigma",)),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_in_one_line(call, words):
    with refused(*words):
        call()


def test_no_parameter_takes_the_place_of_a_result():
    """A coordinate of the name of a variable would replace its numbers."""
    for name in ("period", "mean_distance", "status", "block", "batch", "law"):
        law = {"formula": f"1 - {name}*a*u", name: 0.5}
        if name != "law":
            assert sweep(law, [0.1, 0.2], **SHORT).mean_distance.dims == ("a",)
            with refused(name, "the name of a variable of the result"):
                sweep(law, 0.1, **{name: [0.5, 1.0]}, **SHORT)
    for name in ("kind", "branch", "number", "side", "attractor", "change"):
        with refused(name, "the name of a variable of the result"):
            continue_attractors({"formula": f"1 - {name}*a*u", name: 0.5}, 0.1, **{name: [0.5, 1.0]})


def test_runs_that_begin_at_different_times():
    """The times of their batches differ: they are in no coordinate."""
    run = simulate("linearized", 0.08, "plus", transient=0.0, window=40.0)
    runs = sweep("linearized", 0.08, [run, "minus", run.final], **SHORT)
    assert runs.initial.values.tolist() == ["continued", "minus", "continued_2"]
    assert runs.end_time.values.tolist() == [70.0, 30.0, 70.0]
    assert "batch" not in runs.variables
    assert runs.mean_distance.values[0] == runs.mean_distance.values[2]
    alone = sweep("linearized", 0.08, run, **SHORT)
    assert alone.batch.values.tolist() == [47.5, 62.5]
    assert np.array_equal(runs.batch_mean_distance[0], alone.batch_mean_distance)


def test_a_may_be_named_where_a_state_follows_the_law():
    expected = block_frequencies("linearized", 0.08, "plus", duration=200.0)
    assert said(block_frequencies("linearized", "plus", a=0.08, duration=200.0)) == said(expected)
    attractors = CALLS["edge_state"]["attractors"]
    position, velocity = [[-0.9, -1.0, -1.0]], [[0.1, 0.1, 0.1]]
    by_name = label_states("linearized", attractors, position, velocity, a=0.08)
    assert said(by_name) == said(label_states("linearized", 0.08, attractors, position, velocity))


def test_plain_rows_by_their_number_of_blocks():
    run = simulate("linearized", 0.1, {"position": -0.9, "velocity": 0.1}, blocks=5, **SHORT)
    assert run.model.chain == Chain(5)
    assert simulate("linearized", 0.1, blocks=3, **SHORT).model.chain == Chain(3)


def test_a_sweep_over_laws_and_states():
    own = InitialState("mine", (-0.9, -1.1, -0.95), (0.1, 0.1, 0.1))
    laws = ["linearized", {"law": "stribeck", "sigma": 0.1}, FormulaLaw(0.5, "1 - a*u + b*a*u**2", b=0.1, name="bent")]
    runs = sweep(laws, [0.05, 0.3], ["minus", own, "plus"], v=[0.1, 0.08], cores=2, **SHORT)
    assert runs.mean_distance.dims == ("law", "initial", "a", "v")
    assert runs.law.values.tolist() == ["linearized", "stribeck", "bent"]
    assert runs.initial.values.tolist() == ["minus", "mine", "plus"]
    for law, name in zip(laws, runs.law.values, strict=True):
        for state in ("minus", own, "plus"):
            for a, v in ((0.05, 0.08), (0.3, 0.1)):
                run = simulate(law, a, state, v=v, **SHORT)
                point = runs.sel(law=name, initial=getattr(state, "name", state), a=a, v=v)
                assert point.mean_distance.item() == run.mean_distance
                assert np.array_equal(point.lyapunov_exponent, run.lyapunov_exponent, equal_nan=True)
                assert (point.kind.item(), point.period.item()) == pytest.approx((run.kind, run.period), nan_ok=True)
    alone = sweep("linearized", [0.05, 0.3], "plus", **SHORT)
    assert (alone.law.item(), alone.initial.item(), alone.mean_distance.dims) == ("linearized", "plus", ("a",))
    assert sweep(["linearized"], 0.1, ["plus"], **SHORT).mean_distance.dims == ("law", "initial")
    assert sweep("linearized", 0.1, ([-0.9, -1.0], [0.1, 0.1]), **SHORT).mean_distance.dims == ()


@pytest.mark.parametrize(
    ("laws", "states", "words"),
    [
        ("linearized", [([-1.0] * 3, [0.1] * 3)] * 2, ("initial[0]", "a state with a name")),
        ("linearized", [[[-1.0] * 3, [0.1] * 3], [[-1.0] * 3, [0.1] * 3]], ("initial[0]", "a state with a name")),
        ("linearized", ["plus", ([-1.0] * 3, [0.1] * 3)], ("initial[1]", "a state with a name")),
        ("linearized", ["plus", "plus"], ("initial[1]", "twice")),
        ("linearized", [], ("initial", "no state")),
        (["linearized", "linearized"], "plus", ("law: 'linearized' twice",)),
        ([], "plus", ("law",)),
    ],
)
def test_lists_that_are_refused(laws, states, words):
    options = {"sigma": 0.1} if words[0] == "sigma" else {}
    with refused(*words):
        sweep(laws, [0.1, 0.2], states, **options, **SHORT)


KINDS = {
    ("linearized", 0.02, "minus"): (MotionKind.SYNCHRONIZED, 1e-3),
    ("linearized", 0.08, "plus"): (MotionKind.PERIODIC, 1e-3),
    ("linearized", 1.5, "plus"): (MotionKind.CHAOTIC, np.nan),
    ("linearized", 0.06, "plus"): (MotionKind.QUASIPERIODIC, np.nan),
}


@pytest.mark.parametrize(("law", "a", "initial"), KINDS)
def test_the_kind_of_motion_and_its_period(law, a, initial):
    """Where the motion is periodic, its period is that of the orbit that Newton's method finds."""
    kind, error = KINDS[law, a, initial]
    run = simulate(law, a, initial)
    assert run.kind == kind
    if np.isfinite(error):
        assert run.period == pytest.approx(limit_cycle(run.model, run).period, rel=1e-6)
    runs = sweep(law, [a], initial)
    assert (runs.kind.item(), runs.kind.attrs["flag_meanings"].split()[kind + 1]) == (kind, kind.name.lower())
    assert runs.period.item() == pytest.approx(run.period, nan_ok=True)
    assert not {"kind", "period"} & {*sweep(law, [a], initial, motion=None, **SHORT).variables}
    if kind == MotionKind.PERIODIC:
        shorter = MotionSettings(longest_period=100.0)
        assert run.motion(shorter).kind == sweep(law, [a], initial, motion=shorter).kind == MotionKind.QUASIPERIODIC


def test_a_law_is_a_subclass_of_law():
    assert isinstance(law_of("stribeck", 0.1, sigma=0.05), Law)
    assert law_of("stribeck", 0.1, sigma=0.05).parameters["sigma"] == 0.05
    assert law_of("mine", 0.1, formula="1 - b*a*u", b=0.5) == law_of("mine", 0.1, {"formula": "1 - b*a*u", "b": 0.5})
    with refused("sigma"):
        law_of("stribeck", 0.1, {"sigma": 0.05}, sigma=0.06)
