"""Growth of perturbations by slip events: Lyapunov exponents and multipliers per event."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from burridge_knopoff.catalogue.events import MOST_EVENTS, TIMES
from burridge_knopoff.kernel._core import Catalogue, Exponents
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Whole
from burridge_knopoff.running.derivative import missing_derivative
from burridge_knopoff.running.runner import Runner, check_state
from burridge_knopoff.running.status import Status, early_end
from burridge_knopoff.values import instance_of

# A block at its threshold, at the start of an event, counts as stuck: relative rounding error of forces.
THRESHOLD_TOLERANCE = 1e-9

#: Number of batches for the errors of exponents.
BATCHES = 16


@dataclass(frozen=True)
class EventExponents:
    """Lyapunov exponents of the map from one slip event to the next, in descending order.

    exponent, error : growth of the logarithm of perturbations per event, and its standard error from batches, shape
        (count,); −∞ for perturbations that events remove, NaN without an event or if the run did not complete
    events : number of events in the average
    status, end_time : how the run ended, and τ then

    >>> from burridge_knopoff import InitialState, Model, event_exponents
    >>> model = Model("carlson_langer", a=2.0, coupling=2, v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.5, -0.95, -0.7), 0.0), "tested")
    >>> found = event_exponents(model, start, 100.0, count=3)
    >>> found.status.name, found.exponent.shape, float(found.exponent[2])
    ('COMPLETED', (3,), -inf)
    """

    exponent: np.ndarray
    error: np.ndarray
    events: int
    status: Status
    end_time: float

    def __repr__(self) -> str:
        values = (f"{value:.6g} +- {error:.1g}" for value, error in zip(self.exponent, self.error, strict=True))
        ended = early_end(self.status, self.end_time)
        return f"<EventExponents {ended or ', '.join(values)}, {self.events} events>"


def event_exponents(
    model: Model,
    state: ChainState,
    end: float,
    *,
    begin: float | None = None,
    count: int = 1,
    loading: str = "quasistatic",
) -> EventExponents:
    """Return the largest Lyapunov exponents per slip event, between two times of the loading clock.

    model, state, end, begin, loading : see `record_events`. `begin` is by default the time of `state`; perturbations
        start halfway between the two times and first align with the directions of fastest growth
    count : number of exponents

    Under a steady driver the events are those between the first and the last time at which all blocks stick. The growth
    of perturbations between two such times does not depend on units, since all velocities are 0. In a chain that never
    rests the boundaries of batches lie within slips.

    Under quasi-static loading N blocks have at most N − 1 finite exponents: the state at the start of an event has N
    positions, one of which is fixed by the threshold, and those of blocks that creep by the others.

    Raises ValueError, one line, as `record_events` does, for more exponents than perturbations, and where perturbations
    have no linear growth. This is so if several blocks start together under quasi-static loading, as from a
    mirror-symmetric or uniform state, and if blocks that a dashpot joins stop or start at one instant.

    Reference: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30.

    >>> from burridge_knopoff import Chain, InitialState, Model, event_exponents
    >>> chain = Chain(2, coupling=3.5, pulling=1, threshold=(1.0, 2.25))
    >>> model = Model("carlson_langer", a=0.0, sigma=0.2, chain=chain, v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.5, -0.95), 0.0), "tested")
    >>> found = event_exponents(model, start, 500.0, begin=50.0)
    >>> bool(found.exponent[0] > 5 * found.error[0] > 0)
    True
    """
    instance_of(model, Model, "model")
    instance_of(state, ChainState, "state")
    check_state(model, state)
    end, begin = TIMES.form(end, "end"), TIMES.form(state.time if begin is None else begin, "begin")
    count = Whole(1, 2 * model.blocks).form(count, "count")
    if begin < state.time:
        raise refusal("begin", begin, f"a time not before the start ({state.time:g})")
    if end <= begin:
        raise refusal("end", end, f"a time after begin ({begin:g})")
    edges = np.linspace(begin, end, BATCHES + 1)
    rests = _rest_times(model, state, edges) if loading == "steady" else edges[:0]
    edges = rests if len(rests) > 1 else edges
    catalogue = Catalogue(model.blocks, edges[0], False, MOST_EVENTS)
    exponents = Exponents(model.blocks, count, 0.5 * (state.time + begin), edges, at_rest=True)
    runner = Runner(model, exponents=exponents, catalogue=catalogue, loading=loading, groups=False)
    runner.begin(state)
    status = runner.run(edges[-1])
    _check_derivative(runner)
    time, growth = catalogue.take()["time"], exponents.results()["growth"]
    # A single time of rest bounds no event.
    events, batches = len(time) if len(rests) != 1 else 0, len(growth)
    # The growth in a batch that has not ended is unknown.
    if events == 0 or status != Status.COMPLETED:
        return EventExponents(np.full(count, math.nan), np.full(count, math.nan), events, status, runner.clock)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = growth.sum(axis=0) / events
        scatter = growth - mean * np.histogram(time, edges)[0][:, None]
        error = np.sqrt(np.divide(batches, batches - 1) * np.sum(scatter**2, axis=0)) / events
    order = np.argsort(-mean, kind="stable")
    error = np.where(np.isneginf(mean), 0.0, error)
    return EventExponents(mean[order], error[order], events, status, runner.clock)


def _check_derivative(runner: Runner) -> None:
    if reason := missing_derivative(runner):
        raise ValueError(f"state: {reason}, expected a state from which perturbations grow linearly")


def _rest_times(model: Model, start: ChainState, edges: np.ndarray) -> np.ndarray:
    """Return the middle of the time of rest nearest to each edge, between the first and the last edge.

    At rest all blocks stick. The result is empty if this never happens, or if the run fails.
    """
    # A catalogue lacks the slips of the start and the events that have not ended.
    runner = Runner(model, keep_events=True, events_from=math.inf, groups=False)
    runner.begin(start)
    if runner.run(edges[-1]) != Status.COMPLETED:
        return edges[:0]
    log = runner.log.earlier_events
    time = np.concatenate([[start.time], log.times(), edges[-1:]])
    more_stuck = np.where(log.values()[:, 1] == 0, 1, -1)
    resting = np.cumsum(np.append(np.count_nonzero(start.stuck), more_stuck)) == model.blocks
    begins, ends = np.maximum(time[:-1], edges[0]), time[1:]
    middle = (0.5 * (begins + ends))[resting & (begins < ends)]
    return np.unique(middle[np.abs(middle - edges[:, None]).argmin(axis=1)]) if len(middle) else middle


def event_multipliers(model: Model, state: ChainState, end: float, *, loading: str = "quasistatic") -> np.ndarray:
    """Return the multipliers of the events between two times of rest, complex, shape (blocks,).

    model, state, end : a state in which all blocks stick, none beyond its threshold, and τ of another such state; for
        the multipliers of periodic motion, one period later
    loading : see `record_events`

    The multipliers are the eigenvalues of the linear map of displacements of the blocks by the events, in descending
    order of modulus. Under quasi-static loading one of them is 0, since the threshold fixes one displacement.

    Raises ValueError, one line, as `record_events` does, if a block slips at the start or at the end, if perturbations
    overflow, and where they have no linear growth, as `event_exponents` does.

    >>> from burridge_knopoff import InitialState, Model, event_multipliers
    >>> model = Model("carlson_langer", a=0.0, sigma=0.2, blocks=1, pulling=1, v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.8,), 0.0), "tested")
    >>> event_multipliers(model, start, 0.5).tolist()
    [0j]
    """
    instance_of(model, Model, "model")
    instance_of(state, ChainState, "state")
    end = TIMES.form(end, "end")
    if end <= state.time:
        raise refusal("end", end, f"a time after the start ({state.time:g})")
    blocks = model.blocks
    perturbations = np.vstack([np.eye(blocks), np.zeros((blocks, blocks))])
    runner = Runner(model, perturbations=perturbations, loading=loading, groups=False)
    runner.begin(state)
    # Stuck blocks bear the dashpots to the driver, which moves under steady loading only.
    driver = model.v if loading == "steady" else 0.0
    force = model.chain.force(state.position + model.sliding_offset) + model.chain.driver_damping * driver
    pulled = np.abs(force) if model.contact == "symmetric" else force
    if not state.stuck.all() or (pulled > model.chain.thresholds * (1.0 + THRESHOLD_TOLERANCE)).any():
        raise refusal("state", state, "a state in which all blocks stick, none beyond its threshold")
    if ended := early_end(runner.run(end), runner.clock):
        raise refusal("end", end, f"an earlier time: {ended}")
    if not runner.state().stuck.all():
        raise refusal("end", end, "a time at which all blocks stick")
    _check_derivative(runner)
    product = runner.perturbations[:blocks]
    if not np.isfinite(product).all():
        raise refusal("end", end, "a time before perturbations overflow")
    values = np.linalg.eigvals(product).astype(complex)
    return values[np.argsort(-np.abs(values), kind="stable")]
