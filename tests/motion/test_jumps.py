"""The jumps at events, against difference quotients of the simulated velocity on either side of each event."""

from __future__ import annotations

import numpy as np
import pytest

from burridge_knopoff import Chain, InitialState, Model, Settings
from burridge_knopoff.motion.jumps import event_jumps
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.simulation import run

STOP, H = 0, 1e-4
CHAINS = {
    "paper": Chain(3),
    "one block": Chain(1),
    "damped": Chain(3, damping=0.2, pulling_damping=0.1),
    "uneven": Chain(4, mass=(1.0, 2.0, 0.7, 1.3), threshold=(1.0, 1.2, 0.9, 1.0)),
}


@pytest.mark.parametrize("contact", ["one_sided", "symmetric"])
@pytest.mark.parametrize("law", ["linearized", "nonlinear"])
@pytest.mark.parametrize("name", CHAINS)
def test_jumps_are_those_of_the_simulated_motion(name: str, law: str, contact: str) -> None:
    model = Model(law, a=0.2, chain=CHAINS[name], contact=contact)
    start = np.linspace(-1.0, 0.6, model.blocks)
    settings = Settings(transient=0.0, window=80.0, batches=2, trajectory=1.0, events="all")
    motion = run(model, InitialState("start", tuple(start), (0.1,) * model.blocks), settings)
    states = motion.event_position, motion.event_velocity
    stops, starts = event_jumps(model, *states, motion.event_block, motion.event_kind == STOP)
    if contact == "symmetric" and name != "one block":
        assert motion.event_velocity.min() < -1e-4

    def velocity(event: int, time: float) -> float:
        """Return U' of each block some time after an event."""
        at, block = motion.event_velocity[event], motion.event_block[event] - 1
        stuck = at == 0.0
        stuck[block] = motion.event_kind[event] == STOP
        position = motion.event_position[event] - model.sliding_offset
        return new_ensemble(model).run(position[None], at[None], stuck[None], [time])["velocity"][0, 0]

    blocks, times, is_stop = motion.event_block - 1, motion.event_time, motion.event_kind == STOP
    # Difference quotients need time between two events. Where the force exceeds its threshold, a block turns.
    force = model.chain.force(motion.event_position) + model.chain.damping_force(motion.event_velocity, model.v)
    turns = np.abs(force[np.arange(len(times)), blocks]) > 1.001 * model.chain.thresholds[blocks]
    turns &= contact == "symmetric"
    apart = (np.diff(times, prepend=-1.0) > 2.0 * H) & ~np.roll(turns, 1)
    lasting = np.diff(times, append=times[-1] + 1.0) > 2.0 * H
    before = [
        abs(velocity(k - 1, times[k] - times[k - 1] - H)[blocks[k]]) / H if apart[k] else np.nan
        for k in range(1, len(times))
        if is_stop[k] and not turns[k]
    ]
    after = [
        2.0 * abs(velocity(k, H)[blocks[k]]) / H**2 if lasting[k] else np.nan
        for k in range(len(times))
        if not is_stop[k] and not turns[k]
    ]
    assert np.isfinite(before).sum() > 5
    assert np.isfinite(after).sum() > 5
    for jumps, quotients in ((stops, before), (starts, after)):
        there = np.isfinite(quotients)
        assert jumps[there] == pytest.approx(np.array(quotients)[there], abs=3.0 * H)


def test_a_first_stop_has_no_known_direction() -> None:
    stops, starts = event_jumps(
        Model("linearized", a=0.1, blocks=1), *np.zeros((2, 1, 1)), np.array([1]), np.array([True])
    )
    assert len(stops) == len(starts) == 0
