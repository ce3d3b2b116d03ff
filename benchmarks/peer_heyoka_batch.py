"""Many trajectories of the chain of three blocks with heyoka.py in batch mode: one in each lane of a vector."""

from __future__ import annotations

import heyoka
import numpy as np
from peer_heyoka import COOLDOWN, START_MARGIN

from burridge_knopoff import Chain


class HeyokaBatch:
    """A compiled integrator for one friction law and one a; each call of `run` is an ensemble of trajectories."""

    def __init__(self, law: str, a: float, v: float) -> None:
        self.lanes = heyoka.recommended_simd_size()
        self.sliding_friction = 1.0 - a * v if law == "linearized" else 1.0 / (1.0 + a * v)
        self.offset = Chain(3).sliding_offset(self.sliding_friction)
        position = heyoka.make_vars("x1", "x2", "x3")
        velocity = heyoka.make_vars("w1", "w2", "w3")
        force = self._forces(*position)
        slip = [heyoka.par[i] for i in range(3)]
        friction = [1.0 - a * speed if law == "linearized" else 1.0 / (1.0 + a * speed) for speed in velocity]
        equations = [(position[i], velocity[i] - v) for i in range(3)]
        equations += [(velocity[i], slip[i] * (force[i] - friction[i])) for i in range(3)]
        self.events = 0
        self.integrator = heyoka.taylor_adaptive_batch(
            equations,
            np.zeros((6, self.lanes)),
            pars=np.ones((3, self.lanes)),
            t_events=[
                heyoka.t_event_batch(
                    slip[i] * velocity[i] + (1.0 - slip[i]) * (1.0 - force[i]),
                    callback=self._callback(i),
                    direction=heyoka.event_direction.negative,
                    cooldown=COOLDOWN,
                )
                for i in range(3)
            ],
            fast_math=True,
        )
        self.state, self.slip = self.integrator.state, self.integrator.pars

    def _forces(self, x1, x2, x3):
        base = self.sliding_friction
        return base - 2.0 * x1 + x2, base - 4.0 * x2 + x1 + x3, base - 2.0 * x3 + x2

    def _callback(self, block: int):
        def handle(integrator, sign, lane) -> bool:
            state, slip = self.state, self.slip
            force = self._forces(*state[:3, lane].tolist())
            if slip[block, lane]:
                if force[block] > 1.0 - START_MARGIN:
                    return True
                slip[block, lane] = 0.0
                state[3 + block, lane] = 0.0
            else:
                slip[block, lane] = 1.0
            self.events += 1
            for other in range(3):
                # As in the scalar peer: another block at the same instant.
                if other == block:
                    continue
                if slip[other, lane]:
                    if state[3 + other, lane] <= 0.0 and force[other] < 1.0 - START_MARGIN:
                        slip[other, lane] = 0.0
                        state[3 + other, lane] = 0.0
                        self.events += 1
                elif force[other] >= 1.0:
                    slip[other, lane] = 1.0
                    self.events += 1
            return True

        return handle

    def run(self, position: np.ndarray, velocity: np.ndarray, end: float) -> tuple[np.ndarray, int]:
        """Run from states (n, 3) relative to uniform sliding; return the last positions and the number of events.

        n must be a multiple of the lanes.

        Raises RuntimeError if a trajectory does not come to its end.
        """
        self.events = 0
        final = np.empty_like(position)
        for first in range(0, len(position), self.lanes):
            some = slice(first, first + self.lanes)
            self.integrator.set_time(0.0)
            for lane in range(self.lanes):
                self.integrator.reset_cooldowns(lane)
            self.state[:3] = position[some].T
            self.state[3:6] = velocity[some].T
            self.slip[:] = 1.0
            self.integrator.propagate_until(end)
            outcomes = {result[0] for result in self.integrator.propagate_res}
            if outcomes != {heyoka.taylor_outcome.time_limit}:
                raise RuntimeError(f"heyoka stopped: {outcomes}")
            final[some] = self.state[:3].T
        return final, self.events
