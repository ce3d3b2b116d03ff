"""Networks of springs, and blocks of unequal mass and friction, and their perturbations against finite differences."""

from pathlib import Path

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
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
    model = Model(law, a=0.2, chain=chain)
    start = rest(model, 3)
    perturbations = carry(model, start, 6.0, directions(start))[0].perturbations
    expected = differences(model, start, 6.0, 1e-4)
    assert expected is not None
    free = directions(start).any(axis=0)
    assert np.allclose(perturbations[:, free], expected[0][:, free], rtol=0.0, atol=1e-6 * np.abs(perturbations).max())


@pytest.mark.parametrize("sides", [(6, 1), (1, 6), (3, 3), (5, 5)])
def test_a_grid_with_two_couplings_moves_as_the_network_of_a_file(tmp_path, sides):
    """To the bit in a single row or column, in which the neighbours of the network have the same order."""
    (nx, ny), path = sides, tmp_path / "springs.txt"
    along_rows = [(x + nx * y, x + 1 + nx * y) for y in range(ny) for x in range(nx - 1)]
    along_columns = [(x + nx * y, x + nx * (y + 1)) for y in range(ny - 1) for x in range(nx)]
    lines = [f"{i + 1} {k + 1} 3.0 0.0" for i, k in along_rows] + [f"{i + 1} {k + 1} 0.7 0.2" for i, k in along_columns]
    path.write_text("\n".join(lines))
    grid = Chain(grid=sides, coupling=(3.0, 0.7), damping=(0.0, 0.2), pulling=1.0)
    results = []
    for chain in (grid, Chain(springs=str(path), pulling=1.0)):
        assert np.array_equal(chain.stiffness, grid.stiffness)
        model = Model("nonlinear", a=0.2, chain=chain)
        runner = Runner(model, keep_events=True)
        runner.begin(rest(model))
        assert runner.run(8.0) == Status.COMPLETED
        results.append((np.stack(runner.events()), runner.final().vector()))
    (events, state), (other_events, other_state) = results
    assert (events[2] == 1).any()
    assert np.array_equal(events[1:], other_events[1:])
    rounding = 0.0 if 1 in sides else 1e-11
    assert np.allclose(events[0], other_events[0], rtol=0.0, atol=rounding)
    assert np.allclose(state, other_state, rtol=0.0, atol=rounding)
