"""The one way to move a model: a solver that begins at an instant, runs on, and says how that ended."""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from burridge_knopoff.kernel.event_driven import EventDriven
from burridge_knopoff.kernel.events import EventLog
from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.kernel.friction import Friction
from burridge_knopoff.kernel.observe import Observer
from burridge_knopoff.kernel.series import SERIES_ORDER
from burridge_knopoff.kernel.springs import Springs
from burridge_knopoff.kernel.state import State
from burridge_knopoff.kernel.time_stepping import TimeStepping
from burridge_knopoff.kernel.vector import WIDTH
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS, instance_of, refusal

NEVER = 1e300

RK4_ORDER = 3

# Real sequences stay far below: a block needs at least about a time unit for a slip.
EVENTS_PER_BLOCK_AND_UNIT = 1000
STEP_LIMIT = 10**10


class Runner:
    """A solver of one model.

    solver : series, map (closed form) or rk4
    step : of rk4
    events_from : time from which the states of events are kept; before it only time, block and kind
    keep_events : whether events are kept; else they are only counted
    stops_only : whether of these only the stops from `events_from` on are kept
    observer : what measures the run; without one nothing is measured
    exponents : perturbations from which Lyapunov exponents are computed
    perturbations : tangent vectors to carry along as they are, columns of shape (2 blocks, vectors)

    Raises ValueError if the model has no closed form and the solver needs one.
    """

    def __init__(
        self,
        model: Model,
        solver: str = "series",
        *,
        step: float = 1e-3,
        events_from: float = 0.0,
        keep_events: bool = False,
        stops_only: bool = False,
        observer: Observer | None = None,
        exponents: Exponents | None = None,
        perturbations: np.ndarray | None = None,
    ) -> None:
        instance_of(model, Model, "model")
        if solver == "map" and not model.has_closed_form:
            raise ValueError(
                "solver: got 'map', expected series | rk4: map needs a closed form, that of a friction law that is a "
                "straight line, not too steep, in a uniform chain with open ends"
            )
        self.model = model
        # What decides its steps: a run continues step by step only under the same.
        self.solver = model, solver, step if solver == "rk4" else None
        blocks = model.blocks
        order = RK4_ORDER if solver == "rk4" else SERIES_ORDER
        self.log = EventLog(blocks, events_from, keep_events, EVENTS_PER_BLOCK_AND_UNIT * blocks, stops_only)
        self.observer = observer if observer is not None else new_observer(model, [NEVER, NEVER], order=order)
        if exponents is None:
            count = 0 if perturbations is None else perturbations.shape[1]
            exponents = Exponents(blocks, count, NEVER, [NEVER, NEVER])
        self.exponents = exponents
        self.kernel: EventDriven | TimeStepping
        if solver == "rk4":
            self.kernel = TimeStepping(_state(model, order), self.log, self.observer, step)
        else:
            self.kernel = EventDriven(
                _state(model, order), self.log, self.observer, exponents, solver == "map", STEP_LIMIT
            )
            self.kernel.observing = observer is not None
        if perturbations is not None:
            self.carry(perturbations)

    def begin(self, at: ChainState) -> None:
        """Begin from an instant, at its time; raises ValueError if it is none of the model's blocks."""
        blocks = self.model.blocks
        if not isinstance(at, ChainState) or {np.shape(x) for x in (at.position, at.velocity, at.stuck)} != {(blocks,)}:
            raise refusal("state", at, f"an ChainState of {blocks} blocks")
        self.kernel.begin(at.position, at.velocity, at.stuck, at.time)
        if at.last_step is not None and at.last_step[0] == self.solver:
            self.kernel.resume(at.last_step[1], at.time)

    def final(self) -> ChainState:
        """Return the state at the end of a completed run, from which another one continues with the same steps."""
        at = replace(self.state(), time=self.clock)
        object.__setattr__(at, "last_step", (self.solver, self.kernel.mark()))
        return at

    def carry(self, perturbations: np.ndarray) -> None:
        """Carry the columns of a matrix (2 blocks, vectors) along from now on, never orthonormalised."""
        self.exponents.carry(perturbations)

    def run(self, until: float | None = None, halting_block: int = -1) -> Status:
        """Run on to a time, or to the end of the observer's window, and return how that ended.

        halting_block : a block at each of whose stops the run halts; it goes on from there with the next call

        Raises ValueError for either with `rk4`, which knows the observer's window only, and if it would keep more than
        MOST_NUMBERS of its events.
        """
        if isinstance(self.kernel, EventDriven):
            self.kernel.halting_block = halting_block
            self.kernel.end = self.observer.end if until is None else until
        elif until is not None or halting_block >= 0:
            raise ValueError("solver: got 'rk4', expected series | map for a run to a time or a stop")
        status = Status(self.kernel.run())
        for key, table, remedy in (
            ("events", self.log.earlier_events, "none, or a shorter transient or window"),
            ("events", self.log.events, "none, or a shorter event_window or window"),
            ("window", self.observer.crossings, "a shorter one"),
        ):
            if table.full:
                most = f"{MOST_NUMBERS:.0e} numbers to keep by τ = {self.clock:.6g}"
                raise ValueError(f"{key}: got more than {most}, expected {remedy}")
        return status

    def after(self, at: ChainState, time: float) -> ChainState | None:
        """Return the state that an instant comes to after a time, None if the run fails."""
        self.begin(at)
        return self.state() if self.run(time) == Status.COMPLETED else None

    def state(self) -> ChainState:
        """Return the present state."""
        position, velocity, slip = self.kernel.state.values()
        return ChainState(position, velocity, slip == 0)

    @property
    def clock(self) -> float:
        """The present time τ."""
        return self.kernel.clock

    @property
    def perturbations(self) -> np.ndarray:
        """The perturbations that are carried along, columns of shape (2 blocks, vectors)."""
        return self.exponents.tangent.matrix()

    def events(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return time, block (0 …) and kind (0 stop, 1 start) of the events that were kept."""
        values = self.log.events.values()
        return self.log.events.times(), values[:, 0].astype(int) - 1, values[:, 1].astype(int)


def new_observer(
    model: Model,
    edge: np.ndarray | list[float],
    distance_time: np.ndarray | list[float] = (),  # type: ignore[assignment]
    trajectory_time: np.ndarray | list[float] = (),  # type: ignore[assignment]
    order: int = SERIES_ORDER,
    section_only: bool = False,
    section: Section = SUM,
) -> Observer:
    """Return what measures a run of a model: J averaged over batches, J and states at given times; see `Observer`."""
    apart = float(model.sliding_offset[-1] - model.sliding_offset[0])
    return Observer(model.blocks, order, apart, edge, distance_time, trajectory_time, section_only, section.block)


def new_friction(model: Model, order: int) -> Friction:
    """Return the friction on the blocks of a model, for Taylor series of an order."""
    law, thresholds = model.law, model.chain.thresholds
    slopes = -float(law.slope(0.0)), float(thresholds.max()) * law.steepest
    columns = -(-model.blocks // WIDTH)
    return Friction(*law.tape.table, law.tape.value, law.tape.slope, law.is_linear, *slopes, columns, order)


def _state(model: Model, order: int) -> State:
    chain = model.chain
    springs = Springs(
        chain.diagonal, chain.before, chain.after, chain.thresholds, chain.thresholds * float(model.law(model.v))
    )
    return State(springs, new_friction(model, order), model.v, model.contact == "symmetric")
