"""The parameters of a model by name: each changes the number of that name in the equations of motion."""

import numpy as np
import pytest

from burridge_knopoff import Chain, Model
from tests.refused import refused

MODEL = Model("stribeck", a=0.3, pulling=1.5, v=0.2)


def test_the_names_are_those_of_the_law_the_driver_and_the_chain():
    numbers = {"a": 0.3, "sigma": 0.05, "eta": 0.2, "v": 0.2, "coupling": 1.0, "damping": 0.0, "pulling": 1.5}
    numbers |= {"threshold": 1.0, "mass": 1.0, "pulling_damping": 0.0, "weakening": 1.0}
    assert MODEL.parameter_names == tuple(numbers)
    assert {name: MODEL.parameter(name) for name in numbers} == numbers


def test_a_model_with_changed_parameters_equals_one_built_from_them():
    numbers = {"a": 0.4, "sigma": 0.1, "eta": 0.3, "v": 0.1, "coupling": 2, "pulling": 0.5, "threshold": 1.5, "mass": 3}
    expected = Model("stribeck", a=0.4, sigma=0.1, eta=0.3, coupling=2.0, pulling=0.5, threshold=1.5, mass=3.0, v=0.1)
    assert MODEL.at(**numbers) == expected
    assert all(expected.parameter(name) == value for name, value in numbers.items())
    assert MODEL.at() == MODEL
    assert MODEL.at(a=0.4) == MODEL.at(a=0.4) == Model(MODEL.law.at(a=0.4), chain=MODEL.chain, v=0.2)
    # Cached properties of the chain are kept.
    assert MODEL.at(v=0.3).chain is MODEL.chain


RING = Model("nonlinear", a=0.1, blocks=4, ends="ring")
DRAWN = Model(MODEL.law, threshold="random=uniform,low=0.9,high=1.1,seed=1")


@pytest.mark.parametrize(
    ("model", "parameters", "chain"),
    [
        (MODEL, {"mass[3]": 1.2}, Chain(3, pulling=1.5, mass=(1.0, 1.0, 1.2))),
        (MODEL, {"pulling[1]": 0, "pulling[3]": 2}, Chain(3, pulling=(0.0, 1.5, 2.0))),
        (MODEL, {"coupling[1]": 0.5}, Chain(3, pulling=1.5, coupling=(0.5, 1.0))),
        (MODEL, {"threshold[2]": 1.1}, Chain(3, pulling=1.5, threshold=(1.0, 1.1, 1.0))),
        # A number for all blocks is applied first, whatever the order of the parameters.
        (MODEL, {"mass[2]": 3.0, "mass": 2.0}, Chain(3, pulling=1.5, mass=(2.0, 3.0, 2.0))),
        (Model(MODEL.law), {"pulling[3]": 0.7}, Chain(3, pulling=(1.0, 2.0, 0.7))),
        (Model(MODEL.law, blocks=2, mass=(1.0, 2.0)), {"mass[1]": 3.0}, Chain(2, mass=(3.0, 2.0))),
        # Spring i joins blocks i and i + 1, and the last one of a ring the last block to the first.
        (RING, {"coupling[4]": 2.0}, Chain(4, ends="ring", coupling=(1.0, 1.0, 1.0, 2.0))),
        (Model(MODEL.law, grid=(2, 2)), {"mass[4]": 2.0}, Chain(grid=(2, 2), mass=(1.0, 1.0, 1.0, 2.0))),
        # The springs of a grid have one number along rows and one along columns.
        (Model(MODEL.law, grid=(2, 3)), {"coupling[2]": 2.0}, Chain(grid=(2, 3), coupling=(1.0, 2.0))),
    ],
)
def test_the_parameter_of_one_block_or_spring(model, parameters, chain):
    changed = model.at(**parameters)
    assert changed == Model(model.law, chain=chain, v=model.v)
    for name, value in parameters.items():
        if name.endswith("]"):
            assert changed.parameter(name) == value


def test_the_last_spring_of_a_ring_joins_the_last_block_to_the_first():
    stiffness = RING.at(**{"coupling[4]": 2.0}).chain.stiffness
    assert stiffness[0, 3] == stiffness[3, 0] == -2.0
    assert stiffness[0, 1] == stiffness[2, 3] == -1.0


def test_the_random_numbers_of_the_other_blocks_are_kept():
    chain = DRAWN.at(**{"threshold[2]": 1.5}).chain
    assert chain.thresholds.tolist() == [DRAWN.chain.thresholds[0], 1.5, DRAWN.chain.thresholds[2]]
    assert DRAWN.at(**{"threshold[2]": DRAWN.parameter("threshold[2]")}).chain.is_equivalent_to(DRAWN.chain)


def test_the_contact_and_the_shape_of_the_chain_are_kept():
    model = Model("nonlinear", a=0.1, blocks=4, ends="ring", contact="symmetric").at(pulling=0.25)
    assert (model.contact, model.chain.ends, model.blocks) == ("symmetric", "ring", 4)
    assert np.diag(model.chain.stiffness).tolist() == [2.25] * 4


@pytest.mark.parametrize(
    ("model", "parameters", "words"),
    [
        (MODEL, {"drop": 0.1}, "drop"),
        (MODEL, {"mass[4]": 1.0}, "mass[4]"),
        (MODEL, {"mass[0]": 1.0}, "mass[0]"),
        (MODEL, {"coupling[3]": 1.0}, "coupling[3]"),
        (Model(MODEL.law, blocks=1), {"coupling[1]": 1.0}, "coupling[1]"),
        (Model(MODEL.law, grid=(2, 2)), {"coupling[3]": 1.0}, "coupling[3]: direction 3"),
        (Model(MODEL.law, blocks=2, springs={"distance": "1/r"}, pulling=1.0), {"coupling[1]": 1.0}, "coupling[1]"),
        (MODEL, {"mass[3]": 0.0}, "mass[3]: 0.0"),
        (MODEL, {"mass[3]": None}, "mass[3]: None"),
        (MODEL, {"mass[03]": 1.0}, "'mass[03]'"),
        (MODEL, {"v[1]": 1.0}, "'v[1]'"),
        (Model(MODEL.law, blocks=2, pulling=(1.0, 0.0)), {"pulling[1]": 0.0}, "chain.pulling: (0.0, 0.0)"),
        (MODEL, {"v": 0}, "v: 0"),
        (MODEL, {"v": True}, "v: True"),
        (MODEL, {"a": None}, "a: None"),
        (MODEL, {"mass": [1.0, 1.0, 1.0]}, "mass: [1.0, 1.0, 1.0]"),
        (MODEL, {"coupling": -1.0}, "chain.coupling: -1.0"),
        (Model(MODEL.law, blocks=2, mass=(1.0, 2.0)), {"mass": 1.0}, "mass: (1.0, 2.0)"),
        (
            Model(MODEL.law, blocks=2, threshold="random=uniform,low=0.9,high=1.1,seed=1"),
            {"threshold": 1.0},
            "threshold",
        ),
    ],
)
def test_unknown_parameters_are_refused(model, parameters, words):
    with refused(words):
        model.at(**parameters)


def test_a_parameter_given_as_a_word_is_refused():
    with refused("pulling: 'neighbours'"):
        Model(MODEL.law).parameter("pulling")
