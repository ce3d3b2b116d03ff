"""One grammar for all public functions: a model, then states in any form or values that vary, then settings by name."""

import inspect
import warnings
from dataclasses import replace

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
    continue_attractors,
    edge_state,
    find_attractors,
    follow,
    hopf_bifurcations,
    label_states,
    law_of,
    limit_cycle,
    record_events,
    simulate,
    sweep,
    synchronized_orbit,
)
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.model import ChainState
from tests.library.test_wrong_types import CALLS
from tests.refused import refused

ROUGH = {"random": "uniform", "low": -1.0, "high": -0.9, "seed": 1}
SHORT = {"transient": 0.0, "window": 30.0, "batches": 2}
#: Functions of a model.
OF_MODEL = {
    name
    for name in burridge_knopoff.__all__
    if inspect.isfunction(function := getattr(burridge_knopoff, name))
    and "model" in inspect.signature(function).parameters
}
MODEL = Model("stribeck", a=0.1, sigma=0.1, coupling=1.3, v=0.12, contact="symmetric")
BOTH = [Model("stribeck"), Model("linearized")]
SLOW = [pytest.param(name, marks=pytest.mark.slow) for name in ("basin_map", "edge_state")]


def test_the_functions_of_a_model_take_it_first():
    """But for `follow`, which takes an orbit in its place. None takes a number of the model."""
    assert len(OF_MODEL) >= 15
    for name in OF_MODEL:
        names = [*inspect.signature(getattr(burridge_knopoff, name)).parameters]
        assert names[0] == "model"
        assert not {"a", "v", "contact", "chain", "law", *fields_of(Chain)} & {*names}


@pytest.mark.parametrize(
    "model",
    [
        Model(MODEL.law, chain=Chain(3, coupling=1.3), v=0.12, contact="symmetric"),
        Model(MODEL.law.at(a=0.3), a=0.1, coupling=1.3, v=0.12, contact="symmetric"),
        Model({"law": "stribeck", "a": 0.1}, sigma=0.1, coupling=(1.3, 1.3), v=0.12, contact="symmetric"),
        Model({"stribeck": {"sigma": 0.1}}, a=0.1, **{"coupling[1]": 1.3, "coupling[2]": 1.3}).at(v=0.12),
        Model("stribeck", sigma=0.1, coupling=1.3, v=0.12, contact="symmetric").at(a=0.1),
    ],
)
def test_a_model_is_the_same_in_every_way(model):
    model = replace(model, contact="symmetric")
    assert model.law == MODEL.law
    MODEL.check_same(model, "model")
    run = simulate(model, "plus", **SHORT)
    assert np.array_equal(run.velocity, simulate(MODEL, "plus", **SHORT).velocity)


@pytest.mark.parametrize("name", [*sorted(OF_MODEL - {"basin_map", "edge_state"}), *SLOW])
def test_what_is_left_open_is_missing(name):
    """But for the functions that supply it: `sweep`, `continue_attractors` and others."""
    arguments = dict(CALLS[name])
    model = arguments.pop("model")
    for left in (
        Model("stribeck", chain=model.chain),
        Model({"formula": "1 - a*u + b*u**2"}, b=0.1, chain=model.chain),
    ):
        if "a" in arguments:
            arguments.pop("a")
        with refused("a: missing"):
            getattr(burridge_knopoff, name)(left, **arguments)


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
    run = simulate(Model("linearized", a=0.08), "plus", transient=0, window=200)
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
    run = simulate(Model("nonlinear", a=0.1), "plus", **SHORT)
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
        same = simulate(run.model.at(a=0.1), run, **SHORT)
    assert np.array_equal(same.velocity, simulate(run.model, run.final, **SHORT).velocity)
    with refused("initial"):
        simulate(Model(run.model.law, blocks=4), run, **SHORT)


def test_a_stuck_block_starts_if_its_force_is_above_its_new_threshold():
    run = simulate(Model("linearized", a=0.1), "plus", transient=0, window=40)
    begins = np.flatnonzero(run.event_kind == 1)[-1]
    stuck = simulate(Model("linearized", a=0.1), "plus", transient=0, window=float(run.event_time[begins]) - 0.01)
    block = int(run.event_block[begins]) - 1
    assert stuck.final.stuck[block]
    with pytest.warns(UserWarning, match="stuck blocks"):
        weaker = simulate(stuck.model.at(threshold=0.5), stuck, transient=0, window=0.5, events="all", batches=2)
    first = np.flatnonzero(weaker.event_block == block + 1)[0]
    assert (weaker.event_kind[first], weaker.event_time[first]) == (1, pytest.approx(stuck.end_time, abs=1e-9))


@pytest.mark.parametrize("name", ["v", "mass", "grid", "contact", "window", "chain", "initial"])
def test_the_name_of_a_part_of_the_model_or_of_a_setting_is_no_parameter_of_a_law(name):
    """Either could be meant."""
    for law in (FormulaLaw(f"1 - {name}*a*u", a=0.1), {"formula": f"1 - {name}*a*u", "a": 0.1, name: 0.5}):
        with refused(name, "another name"):
            Model(law)


@pytest.mark.parametrize(
    ("call", "words"),
    [
        (lambda: Model("stribeck", a=0.1, sigm=0.05), ("sigm", "did you mean sigma")),
        (lambda: Model("linearized", a=0.1, sigma=0.05), ("sigma", "not a parameter of this model")),
        (lambda: Model({"law": "stribeck", "a": 0.2}, a=0.1), ("a", "two values")),
        (lambda: Model("linearized", a=0.1, blocks=4, chain=Chain(4)), ("blocks", "beside a chain")),
        (lambda: Model("linearized", a=0.1, chain=Chain(4), **{"mass[1]": 2.0}), ("mass[1]", "beside a chain")),
        (lambda: Model(Chain(3), MODEL.law), ("Model", 'Model("linearized", a=0.08')),
        (lambda: Model("linearized", 0.1), ("Model", 'Model("linearized", a=0.08')),
        (lambda: Model("linearized", a=0.1, blocks=0), ("chain.blocks: 0",)),
        (lambda: MODEL.at(0.1), ("parameters: 0.1", "a=0.08")),
        (lambda: law_of("linearized", 0.1), ("parameters: 0.1", "a=0.08")),
        (lambda: FormulaLaw(0.1, "1 - a*u"), ("parameters: '1 - a*u'", "a=0.08")),
        (lambda: FormulaLaw("1 - a*u", 0.1), ("parameters: 0.1", "a=0.08")),
        (lambda: MODEL.law.at(0.1), ("parameters: 0.1", "a=0.08")),
        (lambda: MODEL.at(contact="symmetric"), ("contact", "Model(…, contact=…)")),
        (lambda: Model("linearized", a=0.1, block=5), ("block", "did you mean blocks")),
        (lambda: Model("linearized", a=0.1, **{"mass[0]": 2.0}), ("mass[0]", "1 to 3")),
        (lambda: Model("linearized", a=0.1, **{"coupling[3]": 2.0}), ("coupling[3]", "1 to 2")),
        (lambda: follow("linearized", 0.08, (0.07, 0.09), initial="plus"), ("orbit: 'linearized'", "Model")),
        (lambda: follow(MODEL, (0.07, 0.09), initial="plus"), ("parameter: missing",)),
        (lambda: hopf_bifurcations("linearized", 0.1, (0, 1)), ("model: 'linearized'", "Model")),
        (lambda: synchronized_orbit("linearized", 0.08), ("model: 'linearized'", "Model")),
        (lambda: label_states("linearized", 0.08, [], [], []), ("model: 'linearized'", "Model")),
        (lambda: simulate(MODEL, "plus", v=0.2), ("v", "Model(…, v=…)")),
        (lambda: limit_cycle(MODEL, "plus", coupling=1.2), ("coupling", "Model(…, coupling=…)")),
        (lambda: limit_cycle(MODEL, "plus", settlin=1.2), ("settlin", "did you mean settling")),
        (lambda: continue_attractors(MODEL, a=0.1), ("parameters: 0", "a=[0.08, 0.09]")),
        (lambda: sweep(Model({"formula": "1 - cores*u"}, cores=0.1)), ("cores", "another name")),
        (lambda: simulate("linearized", 0.08, "plus"), ("model: 'linearized'", 'Model("linearized", a=0.08)')),
        (lambda: sweep("linearized", [0.1, 0.2]), ("model: 'linearized'", 'Model("linearized", a=0.08)')),
        (lambda: simulate(MODEL, "plus", windw=5.0), ("windw", "did you mean window")),
        (lambda: sweep(MODEL, "plus", windw=5.0), ("windw", "did you mean window")),
        (lambda: record_events(MODEL, start=MODEL.begin(InitialState("own", -0.9, 0.1)), end=9.0), ("start", "state")),
        (lambda: limit_cycle(MODEL, "pluss"), ("state: 'pluss'", "did you mean plus")),
        (lambda: find_attractors(MODEL, starts=["plus", "other"]), ("starts[1]: 'other'",)),
        (lambda: edge_state(MODEL, "minus", "plus", [], duration=-1.0), ("duration: -1.0",)),
        (lambda: sweep(BOTH, a=0.1, sigma=[0.1, 0.2]), ("law = 'linearized': sigma",)),
        (lambda: sweep([Model("stribeck"), Model("linearized", v=0.2)], a=0.1), ("model[1].v: 0.2",)),
        (lambda: sweep(BOTH, a=0.1, c=1.0), ("c",)),
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
            assert sweep(Model(law), a=[0.1, 0.2], **SHORT).mean_distance.dims == ("a",)
            with refused(name, "the name of a variable of the result"):
                sweep(Model(law), a=0.1, **{name: [0.5, 1.0]}, **SHORT)
    for name in ("kind", "branch", "number", "side", "attractor", "change"):
        with refused(name, "the name of a variable of the result"):
            continue_attractors(Model({"formula": f"1 - {name}*a*u", name: 0.5}), a=0.1, **{name: [0.5, 1.0]})


def test_runs_that_begin_at_different_times():
    """The times of their batches differ: they are in no coordinate."""
    run = simulate(Model("linearized", a=0.08), "plus", transient=0.0, window=40.0)
    runs = sweep(Model("linearized"), [run, "minus", run.final], a=0.08, **SHORT)
    assert runs.initial.values.tolist() == ["continued", "minus", "continued_2"]
    assert runs.end_time.values.tolist() == [70.0, 30.0, 70.0]
    assert "batch" not in runs.variables
    assert runs.mean_distance.values[0] == runs.mean_distance.values[2]
    alone = sweep(Model("linearized"), run, a=0.08, **SHORT)
    assert alone.batch.values.tolist() == [47.5, 62.5]
    assert np.array_equal(runs.batch_mean_distance[0], alone.batch_mean_distance)


def test_a_parameter_with_one_value_goes_to_the_laws_that_have_it():
    models = [Model({"constant": {"formula": "1/(1 + u/10)"}}), Model("stribeck"), Model("linearized")]
    runs = sweep(models, a=0.1, sigma=0.02, **SHORT)
    assert runs.mean_distance.dims == ("law",)
    for model, numbers in zip(models, ({}, {"a": 0.1, "sigma": 0.02}, {"a": 0.1}), strict=True):
        run = simulate(model.at(**numbers), **SHORT)
        assert runs.mean_distance.sel(law=model.law.name).item() == run.mean_distance


def test_parameters_in_which_laws_differ_are_coordinates_over_the_law():
    models = [Model("stribeck", a=0.1, sigma=0.3), Model("linearized", a=0.2), Model({"own": {"formula": "1/(1 + u)"}})]
    runs = sweep(models, v=[0.1, 0.2], **SHORT)
    np.testing.assert_array_equal(runs["a"].sel(law=["stribeck", "linearized", "own"]), [0.1, 0.2, np.nan])
    np.testing.assert_array_equal(runs["sigma"], [0.3, np.nan, np.nan])
    assert sweep(models[1:2], **SHORT)["a"].shape == ()
    assert sweep([model.at(a=0.1) for model in models[:2]], **SHORT)["a"].item() == 0.1


def test_named_states_as_in_a_config():
    states = {"one": {"position": [-0.9, -1.1, -0.95], "velocity": 0.1}, "other": {"position": -0.9, "velocity": 0.1}}
    runs = sweep(MODEL, states, **SHORT)
    assert runs.initial.values.tolist() == ["one", "other"]
    for name, numbers in states.items():
        run = simulate(MODEL, {"name": name, **numbers}, **SHORT)
        assert runs.mean_distance.sel(initial=name).item() == run.mean_distance


def test_a_sweep_over_laws_and_states():
    own = InitialState("mine", (-0.9, -1.1, -0.95), (0.1, 0.1, 0.1))
    laws = [
        "linearized",
        {"law": "stribeck", "sigma": 0.1},
        FormulaLaw("1 - a*u + b*a*u**2", name="bent", a=0.5, b=0.1),
    ]
    runs = sweep([Model(law) for law in laws], ["minus", own, "plus"], a=[0.05, 0.3], v=[0.1, 0.08], cores=2, **SHORT)
    assert runs.mean_distance.dims == ("law", "initial", "a", "v")
    assert runs.law.values.tolist() == ["linearized", "stribeck", "bent"]
    assert runs.initial.values.tolist() == ["minus", "mine", "plus"]
    for law, name in zip(laws, runs.law.values, strict=True):
        for state in ("minus", own, "plus"):
            for a, v in ((0.05, 0.08), (0.3, 0.1)):
                run = simulate(Model(law, a=a, v=v), state, **SHORT)
                point = runs.sel(law=name, initial=getattr(state, "name", state), a=a, v=v)
                assert point.mean_distance.item() == run.mean_distance
                assert np.array_equal(point.lyapunov_exponent, run.lyapunov_exponent, equal_nan=True)
                assert (point.kind.item(), point.period.item()) == pytest.approx((run.kind, run.period), nan_ok=True)
    alone = sweep(Model("linearized"), "plus", a=[0.05, 0.3], **SHORT)
    assert (alone.law.item(), alone.initial.item(), alone.mean_distance.dims) == ("linearized", "plus", ("a",))
    assert sweep([Model("linearized")], ["plus"], a=0.1, **SHORT).mean_distance.dims == ("law", "initial")
    assert sweep(Model("linearized", blocks=2), ([-0.9, -1.0], [0.1, 0.1]), a=0.1, **SHORT).mean_distance.dims == ()


@pytest.mark.parametrize(
    ("models", "states", "words"),
    [
        (MODEL, [([-1.0] * 3, [0.1] * 3)] * 2, ("initial[0]", "a state with a name")),
        (MODEL, [[[-1.0] * 3, [0.1] * 3], [[-1.0] * 3, [0.1] * 3]], ("initial[0]", "a state with a name")),
        (MODEL, ["plus", ([-1.0] * 3, [0.1] * 3)], ("initial[1]", "a state with a name")),
        (MODEL, ["plus", "plus"], ("initial[1]", "twice")),
        (MODEL, [], ("initial", "no state")),
        ([MODEL, MODEL], "plus", ("law: 'stribeck' twice",)),
        ([], "plus", ("model",)),
    ],
)
def test_lists_that_are_refused(models, states, words):
    with refused(*words):
        sweep(models, states, a=[0.1, 0.2], **SHORT)


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
    run = simulate(Model(law, a=a), initial)
    assert run.kind == kind
    if np.isfinite(error):
        assert run.period == pytest.approx(limit_cycle(run.model, run).period, rel=1e-6)
    runs = sweep(Model(law), initial, a=[a])
    assert (runs.kind.item(), runs.kind.attrs["flag_meanings"].split()[kind + 1]) == (kind, kind.name.lower())
    assert runs.period.item() == pytest.approx(run.period, nan_ok=True)
    assert not {"kind", "period"} & {*sweep(Model(law), initial, a=[a], motion=None, **SHORT).variables}
    if kind == MotionKind.PERIODIC:
        shorter = MotionSettings(longest_period=100.0)
        assert (
            run.motion(shorter).kind
            == sweep(Model(law), initial, a=[a], motion=shorter).kind
            == MotionKind.QUASIPERIODIC
        )


def test_a_law_is_a_subclass_of_law():
    assert isinstance(law_of("stribeck", a=0.1, sigma=0.05), Law)
    assert law_of("stribeck", a=0.1, sigma=0.05).parameters["sigma"] == 0.05
    assert law_of({"mine": {"formula": "1 - b*a*u"}}, a=0.1, b=0.5) == law_of(
        {"mine": {"formula": "1 - b*a*u", "b": 0.5}}, a=0.1
    )
    with refused("sigma"):
        law_of({"law": "stribeck", "sigma": 0.06}, a=0.1, sigma=0.05)
