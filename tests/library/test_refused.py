"""Calls that the library refuses in one line, and runs that leave the range of their law."""

import numpy as np
import pytest
import xarray as xr

from burridge_knopoff import (
    Chain,
    ChainState,
    FormulaLaw,
    InitialState,
    Law,
    Model,
    SearchSettings,
    find_attractors,
    label_states,
    law_of,
    limit_cycle,
    open_study,
    simulate,
    sweep,
    synchronized_orbit,
)
from burridge_knopoff.kernel._core import Ensemble
from burridge_knopoff.running.ensemble import new_ensemble
from tests.refused import refused

MODEL = Model("linearized", a=0.08)
STATE = MODEL.begin(InitialState("own", (-0.9, -1.1, -0.9), (0.1, 0.1, 0.1)))
POSITION, VELOCITY = np.full((4, 3), -1.0), np.full((4, 3), 0.1)


@pytest.fixture(scope="module")
def attractors():
    return find_attractors(MODEL, SearchSettings(samples=12, transient=500, window=500))[0]


@pytest.mark.parametrize(
    ("given", "place"),
    [
        ({"velocity": VELOCITY[:1]}, "velocity"),
        ({"velocity": VELOCITY[:3]}, "velocity"),
        ({"position": -1.0, "velocity": 0.1}, "velocity"),
        ({"position": POSITION[:, :2], "velocity": VELOCITY[:, :2]}, "velocity"),
        ({"position": POSITION * np.nan}, "velocity"),
        ({"velocity": -VELOCITY}, "velocity"),
        ({"start": "stuck"}, "start: 'stuck'"),
        ({"position": POSITION + 1j}, "position"),
        ({"position": [[1.0], [1.0, 2.0]]}, "position"),
        ({"position": np.ma.array(POSITION, mask=POSITION < 0.0)}, "velocity"),
        ({"model": "linearized"}, "model"),
        ({"attractors": ([], np.zeros(3))}, "attractors[0]: []"),
    ],
)
def test_states_that_cannot_be_labelled(attractors, given, place):
    states = {"model": MODEL, "attractors": attractors, "position": POSITION, "velocity": VELOCITY, **given}
    with refused(place):
        label_states(**states)


@pytest.mark.parametrize(
    ("call", "place"),
    [
        (lambda: limit_cycle(Model(MODEL.law, blocks=4), STATE), "state"),
        (lambda: limit_cycle(MODEL, ChainState(np.zeros(3), np.zeros(2), np.zeros(3, bool)), 10.0), "state"),
        (lambda: simulate(Model("linearized", a=0.08), np.zeros((3, 2))), "initial"),
        (
            lambda: simulate(Model("linearized", a=0.08), np.ma.array([[-1, -1], [0.1, 0.1]], mask=[[0, 1], [0, 0]])),
            "initial.position",
        ),
        (lambda: simulate(Model({"law": ["linearized"]}, a=0.08)), "law"),
        (lambda: simulate(Model({"formula": 1.0}, a=0.08)), "formula"),
        (lambda: sweep(Model("linearized"), a=np.ma.array([0.05, 0.08], mask=[0, 1])), "a"),
        (lambda: synchronized_orbit(Model(MODEL.law, threshold=[1, 2, 3])), "chain"),
        (lambda: Chain(3, coupling=xr.DataArray([0.08])), "chain.coupling"),
    ],
)
def test_calls_without_an_answer_are_refused(call, place):
    with refused(place):
        call()


def test_the_kernel_refuses_arrays_of_wrong_shape():
    kernel: Ensemble = new_ensemble(MODEL)
    with refused("stuck", "(1, 3)"):
        kernel.run(POSITION, VELOCITY[:1], np.zeros((4, 3), np.intc), [1.0])


def test_a_law_as_in_a_config():
    for law, same in (
        ({"formula": "1 - c*a*u", "c": 0.5}, FormulaLaw("1 - c*a*u", a=0.1, c=0.5)),
        ({"law": "stribeck", "eta": 0.02}, law_of("stribeck", a=0.1, eta=0.02)),
    ):
        assert simulate(Model(law, a=0.1), transient=0, window=5).model.law == same


@pytest.mark.parametrize("missing", ["formula", "text"])
def test_an_incomplete_custom_law_is_refused(missing):
    words = {"formula": "1 - a*u", "text": "Φ = 1 − aU′"}
    kind = type("Own", (Law,), {key: value for key, value in words.items() if key != missing})
    with refused(f"test_refused.{missing}"):
        kind(a=0.1)
    unused = type("Own", (Law,), {**words, "defaults": {"c": 0.5}})
    with refused("test_refused.c"):
        unused(a=0.1)


def test_a_run_ends_at_the_limit_of_its_law():
    """A block released far ahead of the others reaches the speed at which the root has no value."""
    model = Model(FormulaLaw("sqrt(1 - 0.05*u)"))
    far = InitialState("far", (-100.0, -30.0, 20.0), (0.1, 0.1, 0.1))
    assert simulate(model, initial=far, transient=0, window=50).status == "diverged"
    at = model.begin(far)
    arrays = (np.tile(values, (3, 1)) for values in (at.position, at.velocity, at.stuck.astype(np.intc)))
    assert (new_ensemble(model).run(*arrays, [50.0])["end"] < 50.0).all()


@pytest.mark.parametrize(
    "call",
    [
        lambda: simulate(Model("linearized", a=0.1), "minus", **{"foo\nbar": 1}),
        lambda: find_attractors(Model("linearized", a=0.1), **{"foo\nbar": 1}),
        lambda: sweep(Model("linearized"), a=0.1, **{"foo\nbar": [1.0]}),
        lambda: sweep(Model("linearized"), a=0.1, **{"foo\nbar": []}),
    ],
)
def test_names_of_settings_are_shown_in_a_line(call):
    with refused("'foo\\nbar'"):
        call()


@pytest.mark.parametrize("content", [None, "{}", "nonsense"])
def test_names_of_folders_are_shown_in_a_line(tmp_path, content):
    folder = tmp_path / "a\nb"
    if content is not None:
        folder.mkdir()
        (folder / "study.json").write_text(content)
    with refused("a\\nb" if content is None else "a\\nb/study.json"):
        open_study(folder)


def test_a_search_without_initial_states_is_refused():
    for call in (
        lambda: find_attractors(Model("linearized", a=0.1), samples=0),
        lambda: find_attractors(MODEL, SearchSettings(samples=0)),
    ):
        with refused("samples: 0"):
            call()
