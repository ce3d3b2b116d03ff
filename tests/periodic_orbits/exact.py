"""A synchronized orbit in the 40-digit reference, starting at a time at which every block slips."""

from burridge_knopoff.periodic_orbits.flow import flow
from tests.reference import reference_run

# This step can be added to doubles of order 1 without rounding, and 40 digits resolve it.
SHIFT = 2.0**-40


def slipping_state(orbit):
    """Return (U, U') of the orbit a quarter of its slip after the start of blocks 1 and 3: all blocks slip there."""
    time, kind = orbit.events_of(0)
    slip = orbit.period - orbit.stick_time(0)
    state = flow(orbit.model, orbit.reference, float(time[kind == 1][0]) + 0.25 * slip).state()
    assert not state.stuck.any()
    assert state.velocity.min() > 0.01
    return (state.position + orbit.model.sliding_offset).tolist(), state.velocity.tolist()


def after_a_period(orbit, position, velocity, a=None):
    """Return the reference run over a period of the orbit; U is relative to the driver at both ends."""
    law = orbit.model.law
    a = law.parameters["a"] if a is None else a
    return reference_run(law.name, a, position, velocity, v=orbit.model.v, end=orbit.period)


def exact_transverse_multiplier(orbit):
    """Return the transverse multiplier: the trace of the period map of (U_1 − U_3, U_1' − U_3'), of rank one."""
    total = 0.0
    for speeds in (False, True):
        ends = []
        for shift in (SHIFT, -SHIFT):
            state = slipping_state(orbit)
            state[speeds][0] += shift
            state[speeds][2] -= shift
            run = after_a_period(orbit, *state)
            end = run.velocity if speeds else run.position
            ends.append(end[0] - end[2])
        total += float((ends[0] - ends[1]) / (4 * SHIFT))
    return total
