"""How slip events let perturbations grow: Lyapunov exponents and multipliers per event."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.catalogue.events import MOST_EVENTS, TIMES
from burridge_knopoff.kernel._core import Catalogue, Exponents
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.ranges import Whole
from burridge_knopoff.running.runner import Runner
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import instance_of, refusal

#: Batches for the errors of exponents.
BATCHES = 16


@dataclass(frozen=True)
class EventExponents:
    """Lyapunov exponents of the map from one slip event to the next, in descending order.

    exponent, error : growth of the logarithm of perturbations per event, and its standard error from batches, shape
        (count,); −∞ for perturbations that events take away
    events : number of events over which it was taken
    status : how the run ended

    >>> from burridge_knopoff import Chain, InitialState, Model, event_exponents, law_of
    >>> model = Model(Chain(3, coupling=2), law_of("carlson_langer", 2.0), v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.5, -0.95, -0.7), 0.0), "tested")
    >>> found = event_exponents(model, start, 100.0, count=3)
    >>> found.status.name, found.exponent.shape, float(found.exponent[2])
    ('COMPLETED', (3,), -inf)
    """

    exponent: np.ndarray
    error: np.ndarray
    events: int
    status: Status


def event_exponents(
    model: Model,
    start: ChainState,
    end: float,
    *,
    begin: float | None = None,
    count: int = 1,
    loading: str = "quasistatic",
) -> EventExponents:
    """Return the largest Lyapunov exponents per slip event, between two times of the loading clock.

    model, start, end, begin, loading : see `record_events`; perturbations start halfway between start and begin, by
        default the same time, and turn into the growing directions first
    count : how many exponents

    Under quasi-static loading N blocks have N − 1 finite exponents: the state at the start of an event has N positions,
    of which the threshold fixes one.

    Raises ValueError, one line, as `record_events` does, and for more exponents than perturbations.

    Reference: G. Benettin, L. Galgani, A. Giorgilli and J.-M. Strelcyn, Meccanica 15 (1980) 9-30.

    >>> from burridge_knopoff import Chain, InitialState, Model, event_exponents, law_of
    >>> chain = Chain(2, coupling=3.5, pulling=1, threshold=(1.0, 2.25))
    >>> model = Model(chain, law_of("carlson_langer", 0.0, {"sigma": 0.2}), v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.5, -0.95), 0.0), "tested")
    >>> found = event_exponents(model, start, 500.0, begin=50.0)
    >>> bool(found.exponent[0] > 5 * found.error[0] > 0)
    True
    """
    instance_of(model, Model, "model")
    instance_of(start, ChainState, "start")
    end, begin = TIMES.form(end, "end"), TIMES.form(start.time if begin is None else begin, "begin")
    count = Whole(1, 2 * model.blocks).form(count, "count")
    if begin < start.time:
        raise refusal("begin", begin, f"a time not before the start ({start.time:g})")
    if end <= begin:
        raise refusal("end", end, f"a time after begin ({begin:g})")
    catalogue = Catalogue(model.blocks, begin, False, MOST_EVENTS)
    early = 0.5 * (start.time + begin)
    exponents = Exponents(model.blocks, count, early, np.linspace(begin, end, BATCHES + 1))
    runner = Runner(model, exponents=exponents, catalogue=catalogue, loading=loading, groups=False)
    runner.begin(start)
    status = runner.run(end)
    time, growth = catalogue.take()["time"], exponents.results()["growth"]
    events = len(time)
    with np.errstate(divide="ignore", invalid="ignore"):
        mean = growth.sum(axis=0) / events
        share = np.histogram(time, np.linspace(begin, end, BATCHES + 1))[0] / events
        scatter = growth - mean * (share * events)[:, None]
        error = np.sqrt(BATCHES / (BATCHES - 1) * np.sum(scatter**2, axis=0)) / events
    order = np.argsort(-mean, kind="stable")
    return EventExponents(mean[order], np.where(np.isfinite(mean), error, 0.0)[order], events, status)


def event_multipliers(model: Model, start: ChainState, end: float, *, loading: str = "quasistatic") -> np.ndarray:
    """Return the multipliers of the events between two moments of rest, in descending order of size, shape (blocks,).

    model, start, end : a state in which all blocks stick, and τ of another such moment; for the multipliers of a
        periodic motion, a period later
    loading : see `record_events`

    They are eigenvalues of what the events make of displacements of the blocks. Under quasi-static loading one of them
    is 0, as the threshold fixes one displacement.

    Raises ValueError, one line, as `record_events` does, if a block slips at the start or at the end, and if
    perturbations overflow on the way.

    >>> from burridge_knopoff import Chain, InitialState, Model, event_multipliers, law_of
    >>> model = Model(Chain(1, pulling=1), law_of("carlson_langer", 0.0, {"sigma": 0.2}), v=1.0)
    >>> start = model.begin(InitialState("rest", (-0.8,), 0.0), "tested")
    >>> event_multipliers(model, start, 0.5).tolist()
    [0.0]
    """
    instance_of(model, Model, "model")
    instance_of(start, ChainState, "start")
    end = TIMES.form(end, "end")
    blocks = model.blocks
    perturbations = np.vstack([np.eye(blocks), np.zeros((blocks, blocks))])
    runner = Runner(model, perturbations=perturbations, loading=loading, groups=False)
    runner.begin(start)
    if not start.stuck.all():
        raise refusal("start", start, "a state in which all blocks stick")
    status = runner.run(end)
    if status != Status.COMPLETED or not runner.state().stuck.all():
        raise refusal("end", end, "a time at which all blocks stick")
    product = runner.perturbations[:blocks]
    if not np.isfinite(product).all():
        raise refusal("end", end, "a time before perturbations overflow")
    values = np.linalg.eigvals(product)
    return values[np.argsort(-np.abs(values), kind="stable")]
