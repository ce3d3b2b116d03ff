"""Any model with one-sided contact, integrated piece by piece with SciPy."""

import numpy as np
from scipy.integrate import solve_ivp


def scipy_events(model, start, end, rtol=1e-12, atol=1e-14):
    """Return the events from an instant, (time, block from 1, 0 stop | 1 start), and the state at the end."""
    blocks, v = model.blocks, model.v
    threshold, matrix, law = model.chain.thresholds, model.chain.stiffness, model.law
    sliding = threshold * float(law(v))
    events, clock, state = [], 0.0, start.vector().copy()
    slips = ~start.stuck
    since = np.full(blocks, -1.0)

    def rate(_, y):
        force = sliding - matrix @ y[:blocks]
        speed = np.maximum(y[blocks:], 0.0)
        return np.concatenate([y[blocks:] - v, np.where(slips, force - threshold * law(speed), 0.0)])

    def gap(i):
        def value(t, y):
            if not slips[i]:
                return threshold[i] - sliding[i] + matrix[i] @ y[:blocks]
            # A block that has just started has speed 0, and rounding may make it negative.
            return max(y[blocks + i], 1e-300) if t - since[i] < 1e-3 else y[blocks + i]

        value.terminal, value.direction = True, -1
        return value

    while True:
        gaps = [gap(i) for i in range(blocks)]
        piece = solve_ivp(rate, (clock, end), state, "DOP853", events=gaps, rtol=rtol, atol=atol, max_step=0.02)
        clock, state = piece.t[-1], piece.y[:, -1]
        if piece.status == 0:
            return events, state
        i = next(k for k, times in enumerate(piece.t_events) if len(times))
        slips[i] = not slips[i]
        since[i] = clock if slips[i] else -1.0
        state[blocks + i] = 0.0
        events.append((clock, i + 1, int(slips[i])))
