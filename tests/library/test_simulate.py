"""One run in one call: all forms of initial states, settings by name, and refused arguments."""

import inspect

import numpy as np
import pytest

from burridge_knopoff import (
    Chain,
    InitialState,
    Model,
    SearchSettings,
    Settings,
    basin_map,
    find_attractors,
    simulate,
    sweep,
)
from burridge_knopoff.model.fields import fields_of
from tests.refused import refused

POSITION, VELOCITY = [-0.9, -1.0, -0.8], [0.1, 0.0, 0.2]
SHORT = {"transient": 0.0, "window": 20.0}
MODEL = Model("linearized", a=0.08)


@pytest.mark.parametrize(
    "given",
    [
        {"position": POSITION, "velocity": VELOCITY},
        {"position": np.array(POSITION), "velocity": tuple(VELOCITY)},
        (POSITION, VELOCITY),
        (np.array(POSITION), np.array(VELOCITY)),
        np.array([POSITION, VELOCITY]),
    ],
)
def test_an_initial_state_in_plain_numbers(given):
    run = simulate(Model("nonlinear", a=0.1), given, **SHORT)
    expected = simulate(Model("nonlinear", a=0.1), InitialState("own", tuple(POSITION), tuple(VELOCITY)), **SHORT)
    assert run.initial == expected.initial
    assert run.event_time.tolist() == expected.event_time.tolist()


def test_an_initial_state_with_a_name():
    run = simulate(Model("nonlinear", a=0.1), {"name": "mine", "position": POSITION, "velocity": VELOCITY}, **SHORT)
    assert run.initial == InitialState("mine", tuple(POSITION), tuple(VELOCITY))


@pytest.mark.parametrize(
    ("given", "words"),
    [
        (POSITION, "initial"),
        (3, "initial: 3"),
        (np.array(1.0), "initial: array(1.)"),
        (("minus", "plus"), "initial"),
        ({"positon": POSITION, "velocity": VELOCITY}, "initial.positon"),
        ({"position": POSITION}, "initial.velocity"),
        ({"position": POSITION, "velocity": VELOCITY[:2]}, "velocity"),
        ((POSITION, [0.1, "x", 0.1]), "initial.velocity[1]: 'x'"),
        ((POSITION, [0.1, float("nan"), 0.1]), "initial.velocity[1]: nan"),
        ((POSITION, [0.1, -0.1, 0.1]), "velocity: -0.1"),
        ({"name": "plus", "position": POSITION, "velocity": VELOCITY}, "initial.name: 'plus'"),
        (InitialState("minus", tuple(POSITION), tuple(VELOCITY)), "initial.name: 'minus'"),
    ],
)
def test_a_bad_initial_state_is_refused_in_one_line(given, words):
    with refused(words):
        simulate(Model("linearized", a=0.08), given)


def test_settings_may_be_given_in_both_ways():
    settings = Settings(**SHORT, batches=3)
    ways = [
        simulate(MODEL, initial="plus", settings=settings),
        simulate(MODEL, initial="plus", **SHORT, batches=3),
        simulate(MODEL, initial="plus", settings=Settings(**SHORT), batches=3),
        simulate(Model("linearized", a=0.08), "plus", settings),
        simulate(Model("linearized", a=0.08), "plus", batches=3, **SHORT),
    ]
    assert {run.settings for run in ways} == {settings}
    assert len({run.mean_distance for run in ways}) == 1


@pytest.mark.parametrize(
    ("name", "options"),
    [("chain", {"chain": Chain(3)}), ("contact", {"contact": "one_sided"}), ("blocks", {"blocks": 3})],
)
def test_what_a_model_already_has_is_refused(name, options):
    """It would have no effect, even if it is what the model has."""
    with refused(name):
        simulate(MODEL, initial="plus", **options)


def test_other_objects_in_place_of_settings_are_refused():
    with refused("settings: 'plus'"):
        simulate(Model("linearized", a=0.08), "minus", "plus")


@pytest.mark.parametrize(
    ("function", "kind"),
    [(simulate, Settings), (sweep, Settings), (basin_map, SearchSettings), (find_attractors, SearchSettings)],
)
def test_names_that_notebooks_complete_are_those_of_the_settings(function, kind):
    parameters, fields = inspect.signature(function).parameters, fields_of(kind)
    assert set(fields) <= set(parameters)
    own = {"samples"} if function is basin_map else set()
    assert all(parameters[name].default == field.default for name, field in fields.items() if name not in own)
