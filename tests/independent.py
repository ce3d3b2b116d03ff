"""An independent double-precision method: SciPy's DOP853 from event to event, in the paper's own coordinates.

Absolute positions U, the equations as the paper writes them (Eq. 2), events from SciPy's dense output on a fine grid:
nothing is shared with the package. Good to about 1e-9 over a short horizon; a dip shorter than the grid is not seen.
"""

from __future__ import annotations

import numpy as np
from scipy.integrate import solve_ivp
from scipy.optimize import brentq

GRID = 400


def events(law, a, position, velocity, *, v=0.1, contact="one_sided", start="moving", end=20.0):
    """Return (times, blocks from 1, kinds 0 stop | 1 start) of all events up to `end`, and the final (U, U').

    law : linearized, nonlinear, or a function Φ of aU'
    """
    n = len(position)
    driving = np.full(n, 2.0)
    driving[0] = driving[-1] = 1.0

    def force(tau, u):
        pull = driving * (v * tau - u)
        pull[1:] += u[:-1] - u[1:]
        pull[:-1] += u[1:] - u[:-1]
        return pull

    def friction(speed):
        if callable(law):
            return law(a * speed)
        return 1.0 - a * speed if law == "linearized" else 1.0 / (1.0 + a * speed)

    u, w = np.array(position, float), np.array(velocity, float)
    slip = np.where(w < 0.0, -1, 1)
    if start == "tested":
        stuck = force(0.0, u) <= 1.0
        slip[stuck], w[stuck] = 0, 0.0
    found = []
    tau = 0.0
    fresh = {}
    while True:
        changed = True
        while changed:
            changed = False
            pull = force(tau, u)
            for i in range(n):
                if slip[i] != 0 and i not in fresh and slip[i] * w[i] <= 1e-13:
                    if slip[i] * (pull[i] - slip[i] * friction(abs(w[i]))) > 0 and slip[i] * w[i] > -1e-13:
                        continue
                    slip[i], w[i] = 0, 0.0
                    found.append((tau, i + 1, 0))
                    changed = True
                elif slip[i] == 0 and (pull[i] >= 1.0 - 1e-13 or (contact == "symmetric" and pull[i] <= -1.0 + 1e-13)):
                    slip[i] = 1 if pull[i] > 0 else -1
                    fresh[i] = tau
                    found.append((tau, i + 1, 1))
                    changed = True
        if tau >= end:
            break

        def slope(t, y, slip=slip):
            u, w = y[:n], y[n:]
            acceleration = np.where(slip == 0, 0.0, force(t, u) - slip * friction(slip * w))
            return np.concatenate([w, acceleration])

        stop = min(tau + 0.5, end)
        run = solve_ivp(
            slope, (tau, stop), np.concatenate([u, w]), "DOP853", rtol=1e-12, atol=1e-14, dense_output=True
        ).sol
        times = np.linspace(tau, stop, GRID + 1)
        states = run(times)
        first, which = stop, -1
        for i in range(n):
            if slip[i] != 0:
                functions = [lambda t, i=i, run=run: slip[i] * run(t)[n + i]]
                values = [slip[i] * states[n + i]]
            else:
                functions = [lambda t, i=i, run=run: 1.0 - force(t, run(t)[:n])[i]]
                values = [1.0 - np.array([force(t, states[:n, k])[i] for k, t in enumerate(times)])]
                if contact == "symmetric":
                    functions.append(lambda t, i=i, run=run: 1.0 + force(t, run(t)[:n])[i])
                    values.append(2.0 - values[0])
            for function, value in zip(functions, values, strict=True):
                # A block that has just started leaves 0 like t^2; its noise there is no stop.
                skip = 3 if i in fresh and fresh[i] == tau else 1
                below = np.nonzero(value[skip:] < 0.0)[0]
                if len(below):
                    k = below[0] + skip
                    t = times[k] if value[k - 1] <= 0 else brentq(function, times[k - 1], times[k], xtol=1e-14)
                    if t < first:
                        first, which = t, i
        tau = first
        state = run(tau)
        u, w = state[:n].copy(), state[n:].copy()
        w[slip == 0] = 0.0
        fresh = {i: t for i, t in fresh.items() if tau - t < 1e-6 and i != which}
        if which >= 0:
            if slip[which] != 0:
                slip[which], w[which] = 0, 0.0
                found.append((tau, which + 1, 0))
            else:
                slip[which] = 1 if force(tau, u)[which] > 0 else -1
                w[which] = 0.0
                fresh[which] = tau
                found.append((tau, which + 1, 1))
    time, block, kind = (np.array(column) for column in zip(*found, strict=True)) if found else (np.array([]),) * 3
    return (time, block, kind), (u, w)
