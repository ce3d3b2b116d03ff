"""The chain of three blocks with SciPy: `solve_ivp` from event to event, restarted after each."""

from __future__ import annotations

import numpy as np
from peer_run import PeerRun
from scipy.integrate import solve_ivp

from burridge_knopoff import Chain, InitialState

RELATIVE_TOLERANCE = 1e-10
ABSOLUTE_TOLERANCE = 1e-12
# As in peer_heyoka: blocks start at spring force 1 and stop well below it.
START_MARGIN = 1e-9


class ScipyPeer:
    """One friction law and one a; each call of `run` is one trajectory."""

    def __init__(self, law: str, a: float, v: float) -> None:
        self.linearized = law == "linearized"
        self.a = a
        self.v = v
        self.sliding_friction = 1.0 - a * v if self.linearized else 1.0 / (1.0 + a * v)
        self.offset = Chain(3).sliding_offset(self.sliding_friction)
        self.slip = [True] * 3
        self.stop = [self._stop(i) for i in range(3)]
        self.start = [self._start(i) for i in range(3)]

    def _forces(self, state):
        base = self.sliding_friction
        x1, x2, x3 = state[0], state[1], state[2]
        return base - 2.0 * x1 + x2, base - 4.0 * x2 + x1 + x3, base - 2.0 * x3 + x2

    def _slope(self, time, state):
        # Plain floats: for seven numbers, NumPy arrays would be slower.
        x1, _, x3, w1, w2, w3, _ = state = state.tolist()
        force = self._forces(state)
        slope = [w1 - self.v, w2 - self.v, w3 - self.v, 0.0, 0.0, 0.0, ((w3 - w1) ** 2 + (x3 - x1) ** 2) ** 0.5]
        for i in range(3):
            if self.slip[i]:
                friction = 1.0 - self.a * state[3 + i] if self.linearized else 1.0 / (1.0 + self.a * state[3 + i])
                slope[3 + i] = force[i] - friction
        return slope

    def _stop(self, block: int):
        def speed(time, state):
            return state[3 + block]

        speed.terminal, speed.direction = True, -1
        return speed

    def _start(self, block: int):
        def gap(time, state):
            return self._forces(state)[block] - 1.0

        gap.terminal, gap.direction = True, 1
        return gap

    @staticmethod
    def _section(time, state):
        return state[0] + state[1] + state[2]

    def _change(self, state, block: int) -> list[tuple[int, int]]:
        """Stop or start this block, and the others that have reached their threshold at the same instant."""
        force = self._forces(state)
        changed = []
        for i in range(3):
            if self.slip[i]:
                if i == block or (state[3 + i] <= 0.0 and force[i] < 1.0 - START_MARGIN):
                    self.slip[i] = False
                    state[3 + i] = 0.0
                    changed.append((i, 0))
            elif i == block or force[i] >= 1.0:
                self.slip[i] = True
                changed.append((i, 1))
        return changed

    def run(self, initial: InitialState, transient: float, window: float, sampling: float = 5.0) -> PeerRun:
        """Run one trajectory with all observables."""
        end = transient + window
        samples = sampling * np.arange(int(end / sampling + 1e-9) + 1)
        fine = end - 0.05 * np.arange(600, -1, -1)
        grid = np.union1d(np.append(samples, transient), fine)
        output = []
        events, event_state, crossing = [], [], []
        self.slip[:] = [True] * 3
        state = np.concatenate([np.array(initial.position) - self.offset, initial.velocity, [0.0]])
        time = 0.0
        while time < end:
            active = [self.stop[i] if self.slip[i] else self.start[i] for i in range(3)]
            piece = solve_ivp(
                self._slope,
                (time, end),
                state,
                method="DOP853",
                events=[*active, self._section],
                t_eval=grid[len(output) :],
                rtol=RELATIVE_TOLERANCE,
                atol=ABSOLUTE_TOLERANCE,
            )
            if len(piece.t):
                output.extend(piece.y.T)
            for when, what in zip(piece.t_events[3], piece.y_events[3], strict=True):
                if when >= transient:
                    speed = what[3:6].sum() - 3.0 * self.v
                    crossing.append((when, speed, 1 if speed > 0.0 else -1))
            block = next((i for i in range(3) if len(piece.t_events[i])), None)
            if block is None:
                break
            time = float(piece.t_events[block][0])
            state = piece.y_events[block][0].copy()
            for item, kind in self._change(state, block):
                events.append((time, item, kind))
                event_state.append(state[:6])
        table = np.array(events)
        values = np.array(output)
        sampled = values[np.searchsorted(grid, samples)]
        return PeerRun(
            event_time=table[:, 0],
            event_block=table[:, 1].astype(int) + 1,
            event_kind=table[:, 2].astype(int),
            event_state=np.array(event_state),
            mean_distance=float(values[-1, 6] - values[np.searchsorted(grid, transient), 6]) / window,
            distance=np.hypot(sampled[:, 5] - sampled[:, 3], sampled[:, 2] - sampled[:, 0]),
            crossing=np.array(crossing),
            trajectory=values[np.searchsorted(grid, fine), :6],
        )
