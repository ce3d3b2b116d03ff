"""An independent method in double precision: SciPy's DOP853 from event to event, for any chain, law and contact.

Positions are relative to the driver, y_i = U_i − vt, which makes the paper's Eq. 2 y' = U' − v, U'' = F − dθΦ(wdU')
with d = ±1, the direction of slip, and the force F = −Ky − Cy' of springs and dashpots; masses divide U''. Stiffness K,
damping C, static friction θ, weakening w and Φ are given: nothing is shared with the package.
Event times are good to about 1e-9 over a short horizon; a dip shorter than SPACING is not seen.
"""

import numpy as np
from scipy.integrate import DOP853
from scipy.optimize import brentq

SPACING = 0.00125
LONGEST_STEP = 0.2
#: The velocity of a block that has just started grows from 0 like t²: noise within this time is not a stop.
FRESH = 2e-3
ROUNDING = 1e-13


def scipy_events(
    stiffness,
    threshold,
    friction,
    v,
    position,
    velocity,
    slip,
    end,
    *,
    contact="one_sided",
    mass=1.0,
    damping=0.0,
    weakening=1.0,
):
    """Return all events up to `end`, (time, block from 1, 0 stop | 1 start), and position and velocity there.

    friction : Φ of the speed; slip : of each block, 0 stuck, ±1 the direction of its slip
    """
    blocks = len(position)
    slip = np.array(slip)
    state = np.concatenate([position, np.where(slip == 0, 0.0, velocity)])
    started = np.full(blocks, -1.0)
    signs = (1.0, -1.0) if contact == "symmetric" else (1.0,)
    clock, events = 0.0, []
    damping, weakening = damping * np.ones((blocks, blocks)), weakening * np.ones(blocks)
    pull, at_rest = -np.hstack([stiffness, damping]).T, damping @ np.full(blocks, v)

    def force_at(y):
        return (y.T @ pull + at_rest).T

    def acceleration_at(y):
        resistance = slip * threshold * friction(weakening * np.maximum(slip * y[blocks:], 0.0))
        return (slip != 0) * (force_at(y) - resistance) / mass

    def rate(_, y):
        return np.concatenate([y[blocks:] - v, acceleration_at(y)])

    def gaps(time, y):
        """Return what is positive until the next event: the speed of a slipping block, or (signs, blocks, times)."""
        stuck = np.array([threshold[:, None] - sign * force_at(y) for sign in signs])
        speed = np.where(time - started[:, None] < FRESH, np.inf, slip[:, None] * y[blocks:])
        return np.where(slip[:, None] == 0, stuck, speed)

    def change(i, kind):
        slip[i], state[blocks + i] = kind, 0.0
        started[i] = clock if kind else -1.0
        events.append((clock, i + 1, int(kind != 0)))

    def starts(force, growth, i):
        """Return whether a stuck block starts: at its threshold only if the force grows."""
        return force > threshold[i] + ROUNDING or (force >= threshold[i] - ROUNDING and growth > 0.0)

    def settle():
        """Let all blocks that stop or start at this instant do so."""
        changed = True
        while changed:
            changed = False
            force, growth = force_at(state), -stiffness @ (state[blocks:] - v) - damping @ acceleration_at(state)
            for i in range(blocks):
                speed = slip[i] * state[blocks + i]
                if slip[i] and started[i] != clock and speed <= ROUNDING:
                    # A block that accelerates forward from rest continues.
                    if speed > -ROUNDING and slip[i] * force[i] > threshold[i] * friction(weakening[i] * abs(speed)):
                        continue
                    change(i, 0)
                elif not slip[i] and any(starts(sign * force[i], sign * growth[i], i) for sign in signs):
                    change(i, int(np.sign(force[i])))
                else:
                    continue
                changed = True

    while True:
        settle()
        if clock >= end:
            return events, state[:blocks], state[blocks:]
        solver = DOP853(rate, clock, state, end, rtol=1e-12, atol=1e-14, max_step=LONGEST_STEP)
        while solver.status == "running":
            solver.step()
            run = solver.dense_output()
            times = np.linspace(solver.t_old, solver.t, 2 + int((solver.t - solver.t_old) / SPACING))
            below = gaps(times, run(times)).min(axis=0) < 0.0
            below[:, 0] = False
            which, clock = -1, solver.t
            for i in np.flatnonzero(below.any(axis=1)):
                k = int(np.argmax(below[i]))
                gap = lambda t, i=i: gaps(t, run(t)[:, None])[:, i, 0].min()  # noqa: B023, E731
                before = gap(times[k - 1])
                time = times[k] if not 0.0 < before < np.inf else brentq(gap, times[k - 1], times[k], xtol=1e-14)
                if time < clock:
                    which, clock = i, time
            if which >= 0:
                break
        state = run(clock)
        if which >= 0:
            change(which, 0 if slip[which] else int(np.sign(force_at(state)[which])))


def friction_of(law):
    """Return Φ of the speed without the check of its argument, which would take half of the time."""
    return lambda speed: law.tape.run(speed)[0]


def model_events(model, start, end):
    """Return the events of a model from an instant, and (x, U') at the end; x is relative to uniform sliding."""
    offset = model.sliding_offset
    slip = np.where(start.stuck, 0, np.where(start.velocity < 0.0, -1, 1))
    matter = model.chain.stiffness, model.chain.thresholds, friction_of(model.law), model.v
    kind = {"contact": model.contact, "mass": model.chain.masses, "damping": model.chain.damping_matrix}
    kind["weakening"] = model.chain.weakenings
    events, position, velocity = scipy_events(*matter, start.position + offset, start.velocity, slip, end, **kind)
    return events, np.concatenate([position - offset, velocity])
