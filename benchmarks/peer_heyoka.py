"""The chain of three blocks with heyoka.py, an integrator of ODEs by Taylor series compiled just in time.

What makes it fast:

- one integrator for all phases of motion; which blocks move is a set of parameters, changed in place;
- one terminal event for each block, the speed of a moving and the missing force of a stuck one; with two events a
  block, the run takes about 20 % longer;
- one call for the whole run: callbacks let the integration continue, and the samples come from the dense output inside
  heyoka; continuous output, with J integrated afterwards by Gauss quadrature, is slower than J as one more ODE;
- callbacks work on plain floats and on views of the integrator's memory made once.
"""

from __future__ import annotations

import heyoka
import numpy as np
from peer_run import PeerRun

from burridge_knopoff import Chain, InitialState

# A block that has just started has U' = 0 and U'' = 0 up to rounding, and must not stop again at once. Slips last
# about a time unit and the shortest sticks are 1e-3, so this hides no event.
COOLDOWN = 1e-6
# Blocks start at spring force 1 and stop well below it: that tells a stop from a start that has just been handled.
START_MARGIN = 1e-9
# Keeps the Taylor series of J finite where blocks 1 and 3 move in exact synchrony, J = 0.
DISTANCE_FLOOR = 1e-30


class HeyokaPeer:
    """A compiled integrator for one friction law and one a; each call of `run` is one trajectory."""

    def __init__(self, law: str, a: float, v: float) -> None:
        self.v = v
        self.sliding_friction = 1.0 - a * v if law == "linearized" else 1.0 / (1.0 + a * v)
        self.offset = Chain(3).sliding_offset(self.sliding_friction)
        position = heyoka.make_vars("x1", "x2", "x3")
        velocity = heyoka.make_vars("w1", "w2", "w3")
        force = self._forces(*position)
        slip = [heyoka.par[i] for i in range(3)]
        friction = [1.0 - a * speed if law == "linearized" else 1.0 / (1.0 + a * speed) for speed in velocity]
        equations = [(position[i], velocity[i] - v) for i in range(3)]
        equations += [(velocity[i], slip[i] * (force[i] - friction[i])) for i in range(3)]
        apart = (velocity[2] - velocity[0]) ** 2 + (position[2] - position[0]) ** 2
        equations.append((heyoka.make_vars("j"), heyoka.sqrt(apart + DISTANCE_FLOOR)))
        self.events: list[tuple[float, int, int]] = []
        self.event_state: list[bytes] = []
        self.crossing: list[tuple[float, float, int]] = []
        self.crossing_begin = 0.0
        self.integrator = heyoka.taylor_adaptive(
            equations,
            [0.0] * 7,
            pars=[1.0] * 3,
            t_events=[
                heyoka.t_event(
                    slip[i] * velocity[i] + (1.0 - slip[i]) * (1.0 - force[i]),
                    callback=self._event_callback(i),
                    direction=heyoka.event_direction.negative,
                    cooldown=COOLDOWN,
                )
                for i in range(3)
            ],
            nt_events=[heyoka.nt_event(position[0] + position[1] + position[2], self._crossing_callback())],
            fast_math=True,
            slp_vectorize=True,
        )
        # Views of the integrator's memory: fetching them again in each of 12,000 callbacks is measurably slower.
        self.state = self.integrator.state
        self.slip = self.integrator.pars
        self.dense = self.integrator.d_output

    def _forces(self, x1, x2, x3):
        """Return the spring forces; numbers or expressions."""
        base = self.sliding_friction
        return base - 2.0 * x1 + x2, base - 4.0 * x2 + x1 + x3, base - 2.0 * x3 + x2

    def _event_callback(self, block: int):
        others = [other for other in range(3) if other != block]

        # A function, not a method: heyoka copies callbacks, and with a method all of this object.
        def handle(integrator, sign) -> bool:
            state, slip, forces = self.state, self.slip, self._forces
            values = state.tolist()
            force = forces(values[0], values[1], values[2])
            if slip[block]:
                if force[block] > 1.0 - START_MARGIN:
                    return True  # Started by hand with the other end block: the stop is rounding.
                slip[block] = 0.0
                state[3 + block] = 0.0
                changed = [(block, 0)]
            else:
                slip[block] = 1.0
                changed = [(block, 1)]
            # heyoka handles the first event of a step. Another one at the same instant can lie before the next step,
            # by rounding, and would never be seen.
            for other in others:
                if slip[other]:
                    if values[3 + other] <= 0.0 and force[other] < 1.0 - START_MARGIN:
                        slip[other] = 0.0
                        state[3 + other] = 0.0
                        changed.append((other, 0))
                elif force[other] >= 1.0:
                    slip[other] = 1.0
                    changed.append((other, 1))
            time = integrator.time
            content = state.tobytes()
            for item, kind in changed:
                self.events.append((time, item, kind))
                self.event_state.append(content)
            return True

        return handle

    def _crossing_callback(self):
        def handle(integrator, time, sign) -> None:
            if time >= self.crossing_begin:
                integrator.update_d_output(time)
                dense = self.dense
                self.crossing.append((time, dense[3] + dense[4] + dense[5] - 3.0 * self.v, sign))

        return handle

    def run(self, initial: InitialState, transient: float, window: float, sampling: float = 5.0) -> PeerRun:
        """Run one trajectory with all observables."""
        end = transient + window
        samples = sampling * np.arange(int(end / sampling + 1e-9) + 1)
        fine = end - 0.05 * np.arange(600, -1, -1)
        grid = np.union1d(np.append(samples, transient), fine)
        for kept in (self.events, self.event_state, self.crossing):
            kept.clear()
        self.crossing_begin = transient
        self.integrator.time = 0.0
        self.integrator.reset_cooldowns()
        self.state[:3] = np.array(initial.position) - self.offset
        self.state[3:6] = initial.velocity
        self.state[6] = 0.0
        self.slip[:] = 1.0
        outcome, *_, output = self.integrator.propagate_grid(grid)
        if outcome != heyoka.taylor_outcome.time_limit:
            raise RuntimeError(f"heyoka stopped: {outcome}")
        events = np.array(self.events)
        sampled = output[np.searchsorted(grid, samples)]
        return PeerRun(
            event_time=events[:, 0],
            event_block=events[:, 1].astype(int) + 1,
            event_kind=events[:, 2].astype(int),
            event_state=np.frombuffer(b"".join(self.event_state)).reshape(-1, 7)[:, :6],
            mean_distance=float(output[-1, 6] - output[np.searchsorted(grid, transient), 6]) / window,
            distance=np.hypot(sampled[:, 5] - sampled[:, 3], sampled[:, 2] - sampled[:, 0]),
            crossing=np.array(self.crossing),
            trajectory=output[np.searchsorted(grid, fine), :6],
        )
