"""Fronts of slip: their speed under Coulomb friction, from the onsets of slip in a catalogue."""

import numpy as np
import pytest

from burridge_knopoff import Chain, ChainState, Model
from burridge_knopoff.catalogue.events import record_events


@pytest.mark.parametrize("loading", ["steady", "quasistatic"])
@pytest.mark.parametrize("stress", [0.6, 0.8, 0.9])
def test_steady_fronts_under_coulomb_friction(stress, loading):
    """D. S. Amundsen et al., Phys. Rev. E 92 (2015) 032406: 1/√(1 − τ̄²) in units of the speed of sound."""
    blocks, coupling, sigma = 250, 4.0, 0.25
    # No block between the ends has a spring to the driver.
    row = Chain(blocks, coupling=coupling, pulling=[1.0] + [0.0] * (blocks - 2) + [1.0])
    model = Model("carlson_langer", a=0.0, sigma=sigma, chain=row, v=1e-4)
    force = np.full(blocks, 1.0 - sigma + sigma * stress)
    force[0] = 1.0 - 1e-9
    position = -np.linalg.solve(row.stiffness, force) - model.sliding_offset
    start = ChainState(position, np.zeros(blocks), np.ones(blocks, dtype=bool))
    # Under steady loading the last block stops much later than all have started.
    events = record_events(model, start, 20_000.0, profiles=True, loading=loading)
    assert (events.blocks[0], events.epicentre[0]) == (blocks, 1)
    onset = events.slip_onset[:blocks]
    assert (np.diff(onset) > 0.0).all()
    speed = 100.0 / (onset[200] - onset[100]) / np.sqrt(coupling)
    assert speed == pytest.approx(1.0 / np.sqrt(1.0 - stress**2), rel=1e-8)
