"""An attractor knows its model: functions that take attractors refuse those of another model."""

import pickle
from dataclasses import replace
from operator import attrgetter

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, edge_state, find_attractors, label_states, law_of
from burridge_knopoff.attractors.attractor import attractors_of
from burridge_knopoff.continuation.law_homotopy import follow_law
from burridge_knopoff.messages import format_value
from tests.motion.stand_in import stand_in
from tests.refused import refused

MODEL = Model("linearized", a=0.08)
#: Models that differ in one part.
OTHERS = {
    "a": MODEL.at(a=0.1),
    "law": replace(MODEL, law=law_of("nonlinear", a=0.08)),
    "v": replace(MODEL, v=0.2),
    "contact": replace(MODEL, contact="symmetric"),
    "chain.blocks": Model(MODEL.law, blocks=2),
    "chain.mass": MODEL.at(**{"mass[3]": 1.1}),
    "chain.threshold": MODEL.at(threshold=1.5),
    "chain.coupling": MODEL.at(coupling=1.5),
    "chain.damping": MODEL.at(damping=0.1),
    "chain.pulling": MODEL.at(pulling=1.0),
    "chain.pulling_damping": MODEL.at(pulling_damping=0.1),
    "chain.ends": Model(MODEL.law, ends="ring"),
    "chain.grid": Model(MODEL.law, grid=(3, 1)),
}
POSITION, VELOCITY = np.array([[-0.989, -0.993, -0.991], [0.989, -0.993, -0.991]]), np.full((2, 3), 0.1)


def label(model, attractors):
    return label_states(model, attractors, POSITION[:, : model.blocks], VELOCITY[:, : model.blocks])


def boundary(model, attractors):
    states = [model.begin(InitialState("own", [u] * model.blocks, [0.1] * model.blocks)) for u in (-0.9, -1.1)]
    return edge_state(model, *states, attractors, time_limit=100.0)


@pytest.mark.parametrize("call", [label, boundary])
@pytest.mark.parametrize("part", OTHERS)
def test_attractors_of_another_model_are_refused(part, call):
    models = MODEL, OTHERS[part]
    first, second = (
        format_value(model.parameter(part) if part == "a" else attrgetter(part)(model)) for model in models
    )
    mixed = [stand_in(model=model) for model in models]
    with refused(f"attractors[1].model.{part}: {second}", first):
        call(MODEL, mixed)
    with refused(f"attractors[0].model.{part}: {first}", second):
        call(OTHERS[part], mixed)


def test_a_chain_in_another_form_is_the_same():
    attractors, _ = find_attractors(MODEL, starts=["minus", "plus"], samples=0, transient=500, window=500)
    same = Chain(3, coupling=(1.0, 1.0), pulling=(1, 2, 1), mass=[1, 1, 1], threshold=1, damping=[0, 0])
    for model in (MODEL, Model("linearized", a=0.08, chain=same), MODEL.at(a=0.1).at(a=0.08)):
        assert label(model, attractors)[0].tolist() == [0, 1]
    copied = pickle.loads(pickle.dumps(attractors))
    assert [attractor.model for attractor in copied] == [MODEL] * 2
    assert attractors_of(MODEL, copied) == copied


def test_a_pickle_without_a_model_is_refused():
    attractor = stand_in()
    del vars(attractor)["model"]
    pickled = pickle.dumps(attractor)
    with refused("attractor", "model"):
        pickle.loads(pickled)


@pytest.mark.parametrize(
    ("part", "other"),
    [
        ("v", replace(MODEL, v=0.2)),
        ("chain.coupling", MODEL.at(coupling=2.0)),
        ("contact", replace(MODEL, contact="symmetric")),
    ],
)
def test_an_attractor_is_not_followed_to_another_chain(part, other):
    state = stand_in().motion.state()
    other = replace(other, law=law_of("nonlinear", a=0.08))
    with refused(f"second.{part}"):
        follow_law(MODEL, other, state, None)
