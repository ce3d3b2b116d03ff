"""The results of a peer's run, and how far they agree with those of this package."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

# Beyond, chaos or the growth of rounding errors could make two correct solvers differ.
HORIZON = 100.0


@dataclass
class PeerRun:
    """The observables of one run; events are (time, block from 1, 1 start | 0 stop) with the state of all blocks."""

    event_time: np.ndarray
    event_block: np.ndarray
    event_kind: np.ndarray
    mean_distance: float
    event_state: np.ndarray = field(repr=False)
    distance: np.ndarray = field(repr=False)
    crossing: np.ndarray = field(repr=False)
    trajectory: np.ndarray = field(repr=False)


def event_time_difference(run: PeerRun, ours) -> str:
    """Return the largest difference of event times up to the horizon, or what is wrong with the events.

    Events are compared block by block, since events that are simultaneous to rounding may come in either order.
    """
    difference = 0.0
    for block in (1, 2, 3):
        early = [
            (times[chosen], kinds[chosen])
            for times, blocks, kinds in (
                (run.event_time, run.event_block, run.event_kind),
                (ours.event_time, ours.event_block, ours.event_kind),
            )
            for chosen in [(blocks == block) & (times < HORIZON)]
        ]
        (peer_time, peer_kind), (our_time, our_kind) = early
        if len(peer_time) != len(our_time) or (peer_kind != our_kind).any():
            return "other events"
        if len(our_time):
            difference = max(difference, float(np.abs(peer_time - our_time).max()))
    return f"{difference:.0e}"
