"""Networks of springs, and blocks of unequal mass and friction, and their perturbations against finite differences."""

from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model, law_of
from tests.flows import carry, differences, directions

NETWORK = str(Path(__file__).with_name("damped_network.txt"))

CHAINS = [
    Chain(grid=(3, 2), pulling=1.0),
    Chain(grid=(2, 3), coupling=2.0, pulling=0.5, mass=[1.0, 2.0, 0.5, 1.0, 3.0, 1.5]),
    Chain(5, mass=[1.0, 2.0, 0.5, 1.0, 3.0]),
    Chain(4, ends="ring", mass=[0.5, 1.0, 2.0, 1.0]),
    Chain(1, mass=2.0),
    Chain(grid=(3, 2), pulling=1.0, damping=0.3),
    Chain(4, ends="ring", damping=(0.1, 0, 0.5, 1), pulling_damping=(0, 0.2, 0, 0.1), mass=(0.5, 1.0, 2.0, 1.0)),
    Chain(springs=NETWORK, pulling=1.0, pulling_damping=0.1),
    Chain(1, pulling_damping=0.4),
    Chain(5, weakening=(1.0, -0.3, 0.0, 1.5, 0.5)),
    Chain(grid=(3, 2), pulling=1.0, damping=0.3, weakening=(1.0, -0.3, 0.5, 0.0, 1.0, -0.1)),
]


def rest(model, seed=2):
    generator = np.random.default_rng(seed)
    position = generator.uniform(-1.2, -0.9, model.blocks) - model.sliding_offset
    return ChainState(position, np.zeros(model.blocks), np.ones(model.blocks, dtype=bool))


@pytest.mark.parametrize("chain", CHAINS)
def test_perturbations_against_differences(law, chain):
    model = Model(chain, law_of(law, 0.2))
    start = rest(model, 3)
    perturbations = carry(model, start, 6.0, directions(start))[0].perturbations
    expected = differences(model, start, 6.0, 1e-4)
    assert expected is not None
    free = directions(start).any(axis=0)
    assert np.allclose(perturbations[:, free], expected[0][:, free], rtol=0.0, atol=1e-6 * np.abs(perturbations).max())
