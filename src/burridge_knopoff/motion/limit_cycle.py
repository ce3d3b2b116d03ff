"""The periodic orbit on which a motion has settled, found from its close returns to a state or to its mirror image.

The returns are taken at the stops of a block or, if no block stops, at the maxima of the velocity of a block that
moves.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.uniform_sliding import eigenvalues
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.set_distance import distance
from burridge_knopoff.periodic_orbits.floquet import unstable_count
from burridge_knopoff.periodic_orbits.flow import OrbitError, flow
from burridge_knopoff.periodic_orbits.minimal_orbit import minimal_form
from burridge_knopoff.periodic_orbits.periodic import PeriodicOrbit, find_periodic_orbit
from burridge_knopoff.periodic_orbits.return_map import mirror_order
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.periodic_orbits.without_stops import distance_from_sliding, missing_isolation, velocity_maxima
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.settings import DURATION, TIME
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import instance_of

#: Distances, for v = 0.1 in the chain's own units, within which the motion must return to a state for Newton's method
#: to start there; they are tried in this order.
CLOSENESS = (1e-9, 1e-7, 1e-5, 1e-4, 1e-3)

#: Time, in the chain's own unit, in which a return is sought: longer orbits, such as those of some locked tori, are not
#: found. The final distance of the motion from the orbit may exceed the distance of the return by the second number.
WINDOW = 8000.0
MAX_RELATIVE_DISTANCE = 30.0

# Fraction of the window in which an attracting orbit without stops is sought first: its maxima are many.
PART = 1.0 / 64.0

# A mirror-image return takes half of a period. A stop of the mirror block earlier than this fraction of the time to the
# next stop of the block is not such a return: the two blocks stop almost together.
MIN_MIRROR_TIME = 0.1


def limit_cycle(model: Model, state: ChainState, settling: float = 0.0, window: float | None = None) -> PeriodicOrbit:
    """Return the periodic orbit with the shortest period on which a settled motion lies.

    model, state : a state of the motion
    settling, window : times, in units of 1/ω, for the motion to settle first, and within which it must return. The
        default window is 8000, multiplied by the time unit of the chain (`Chain.own_units`)

    Returns are taken at the stops of one block, or at the maxima of its velocity, in the following window, if no block
    stops in the second half of the first one.

    The motion lies on an attracting orbit if it approaches the orbit within the window. It lies on an unstable orbit,
    such as synchrony from equal states, only if it never leaves it, since chaotic motion passes near many unstable
    orbits.

    Raises OrbitError if the motion does not return within the window or lies on no isolated periodic orbit, as if it
    settles on uniform sliding, or if orbits without stops have any amplitude (under a law that is linear in speed). It
    gives the times, the closest return of a state (distances are for v = 0.1 in the chain's own units), and whether the
    motion approaches the orbit found there.
    Raises ValueError for a time or a state that is not allowed.

    >>> from burridge_knopoff import Model, limit_cycle, simulate
    >>> model = Model("linearized", a=0.08)
    >>> run = simulate(model, initial="plus", transient=0, window=10)
    >>> orbit = limit_cycle(model, model.begin(run.initial), settling=1000.0)
    >>> round(orbit.period, 4), orbit.symmetry.name, orbit.stop_counts
    (157.2451, 'SYMMETRIC', (20, 54, 20))
    """
    instance_of(model, Model, "model")
    window = WINDOW * model.chain.own_units.time if window is None else TIME.form(window, "window")
    return orbit_of_motion(model, state, DURATION.form(settling, "settling"), window)


def orbit_of_motion(model: Model, state: ChainState, settling: float, window: float) -> PeriodicOrbit:
    """Return the same as `limit_cycle`, without limits on the times."""
    runner = Runner(model, keep_events=True, events_from=settling)
    runner.begin(state, 0.0)
    if runner.run(settling + window) != Status.COMPLETED:
        raise OrbitError(f"{model.place}: the run ends at τ = {runner.clock!r}, before {settling + window!r}")
    times, values = runner.log.events.times(), runner.log.events.values()
    orbit = orbit_of_events(model, times, values, _is_on_orbit)
    section = "stops"
    if orbit is None and not (times > settling + 0.5 * window).any():
        section = "velocity maxima"
        orbit = _orbit_without_stops(model, runner.state(), window)
        if orbit is None:
            times, values = velocity_maxima(model, runner.state(), 0.0, window)
    if orbit is None:
        tried = f"from the {section} within {window:g}, after {settling:g} to settle"
        raise OrbitError(f"{model.place}: no periodic orbit found {tried}: {_failure(model, times, values)}")
    return orbit


def _failure(model: Model, times: np.ndarray, values: np.ndarray) -> str:
    """Return in words why a motion lies on no periodic orbit; times, values : see `orbit_of_events`."""
    _, returns = _returns(model, times, values)
    if not returns:
        return "no block reaches them twice"
    closest, time = min((reached, time) for time, _, reached in returns)
    words = f"the closest return is at a distance of {closest:.1e} after {time:.6g}"
    if closest > CLOSENESS[-1]:
        return f"{words}, more than {CLOSENESS[-1]:g}"
    for start, time, symmetry, _ in _close_returns(model, times, values):
        try:
            orbit = find_periodic_orbit(model, start, time, symmetry)
        except OrbitError:
            continue
        kind = "unstable" if unstable_count(orbit) else "stable"
        first, last = _cycle_distances(orbit, values)
        words += f"; the distance from the {kind} orbit of period {orbit.period:.6g} there goes from"
        return f"{words} {first:.1e} to {last:.1e}"
    return f"{words}, and Newton's method finds no orbit there"


def _orbit_without_stops(model: Model, state: ChainState, window: float) -> PeriodicOrbit | None:
    """Return the same as `orbit_of_events` for a motion without stops, within a window that begins at a state.

    Raises OrbitError, with the reason, if the motion slides uniformly or is neutral.
    """
    if np.abs(distance_from_sliding(model, state)).max() <= CLOSENESS[0]:
        words = "the motion settles on uniform sliding"
        if eigenvalues(model).real.max() > 0.0:
            words = "the state is uniform sliding, which is unstable: start from a displaced state"
        raise OrbitError(f"{model.place}: no periodic orbit found: {words}")
    for part, accepted in ((PART * window, _is_on_stable_orbit), (window, _is_on_orbit)):
        times, values = velocity_maxima(model, state, 0.0, part)
        if (orbit := orbit_of_events(model, times, values, accepted)) is not None:
            return orbit
        closest = next(_close_returns(model, times, values), None)
        if closest is not None and (reason := missing_isolation(model, *closest[:2])):
            raise OrbitError(f"{model.place}: no isolated periodic orbit found: {reason}")
    return None


def orbit_of_events(
    model: Model,
    times: np.ndarray,
    values: np.ndarray,
    accepted: Callable[[PeriodicOrbit, float, float, float], bool],
) -> PeriodicOrbit | None:
    """Return the shortest periodic orbit on which a motion lies, from its events as the kernel stores them, or None.

    times, values : also the `velocity_maxima` of a motion without stops
    accepted : takes an orbit, the distances of the first and the last cycle of the motion from the orbit, and the
        distance of the return, all for v = 0.1 in the chain's own units; returns whether the motion lies on the orbit
    """
    for start, time, symmetry, size in _close_returns(model, times, values):
        try:
            orbit = find_periodic_orbit(model, start, time, symmetry)
        except OrbitError:
            continue
        if accepted(orbit, *_cycle_distances(orbit, values), size):
            return minimal_form(orbit, CLOSENESS[0])
    return None


def _close_returns(
    model: Model, times: np.ndarray, values: np.ndarray
) -> Iterator[tuple[ChainState, float, Symmetry, float]]:
    """Yield a state, the time of its return, the symmetry and the distance: closest returns first, then shortest.

    times, values : see `orbit_of_events`
    """
    state, returns = _returns(model, times, values)
    for size in CLOSENESS:
        for time, symmetry, reached in returns:
            if reached <= size:
                yield state_of(state), time, symmetry, size
                break


def _returns(
    model: Model, times: np.ndarray, values: np.ndarray
) -> tuple[np.ndarray, list[tuple[float, Symmetry, float]]]:
    """Return a state on the section and the time, symmetry and distance of each return to it, in order of time.

    times, values : see `orbit_of_events`
    """
    stops = values[:, 1] == 0
    if not stops.any():
        return np.empty(0), []
    block = int(values[stops, 0].min())
    other = model.blocks + 1 - block
    section_stops = np.flatnonzero(stops & (values[:, 0] == block))
    state, begun = values[section_stops[0], 2:], times[section_stops[0]]

    def distances(states: np.ndarray) -> np.ndarray:
        return np.abs((states - state) / model.state_scale).max(axis=1)

    kind = Symmetry.ASYMMETRIC
    returned, mirrored = section_stops[1:], np.empty(0, dtype=int)
    order = mirror_order(model.blocks)
    if model.chain.is_mirror_symmetric:
        if distances(state[None, order])[0] <= CLOSENESS[0]:
            kind = Symmetry.SYNCHRONIZED
        else:
            soonest = begun + MIN_MIRROR_TIME * (times[section_stops[1:2]] - begun).sum()
            mirrored = np.flatnonzero(stops & (values[:, 0] == other) & (times > soonest))
    found: list[tuple[float, Symmetry, float]] = []
    for places, symmetry, states in (
        (returned, kind, values[returned, 2:]),
        (mirrored, Symmetry.SYMMETRIC, values[mirrored, 2:][:, order]),
    ):
        later = (times[places] - begun).tolist()
        found += [(time, symmetry, at) for time, at in zip(later, distances(states).tolist(), strict=True)]
    return state, sorted(found, key=lambda item: item[0])


def _is_on_stable_orbit(orbit: PeriodicOrbit, first: float, last: float, size: float) -> bool:
    """Return whether a motion approaches an orbit that attracts."""
    return unstable_count(orbit) == 0 and _is_on_orbit(orbit, first, last, size)


def _is_on_orbit(orbit: PeriodicOrbit, first: float, last: float, size: float) -> bool:
    """Return whether a motion stays on an orbit, or approaches it if the orbit attracts."""
    return last <= (
        CLOSENESS[0] if unstable_count(orbit) != 0 else max(CLOSENESS[0], min(first, MAX_RELATIVE_DISTANCE * size))
    )


def _cycle_distances(orbit: PeriodicOrbit, values: np.ndarray) -> tuple[float, float]:
    """Return the distances of the first and the last cycle of a motion from an orbit, by the events of the motion."""
    if any(orbit.stop_counts):
        around = flow(orbit.model, orbit.reference, orbit.period).log.events.values()
        block = int(np.flatnonzero(orbit.stop_counts)[0]) + 1
    else:
        # In one period rounding may hide a maximum at the reference.
        around = velocity_maxima(orbit.model, orbit.reference, 0.0, 1.5 * orbit.period)[1]
        block = int(around[:, 0].min())
    orbit_states, motion_states = (_states_on_section(rows, block) for rows in (around, values))
    if not len(motion_states):
        return np.inf, np.inf
    first, last = (
        distance(cycle / orbit.model.state_scale, orbit_states / orbit.model.state_scale, share=1.0)
        for cycle in (motion_states[: len(orbit_states)], motion_states[-len(orbit_states) :])
    )
    return first, last


def _states_on_section(values: np.ndarray, block: int) -> np.ndarray:
    """Return the states at the stops, or the velocity maxima, of one block, from 1, shape (n, 2 blocks)."""
    return values[(values[:, 0] == block) & (values[:, 1] == 0), 2:]
