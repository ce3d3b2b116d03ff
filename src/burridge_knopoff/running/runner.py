"""The runner: a solver of one model that starts from an instant, integrates, and reports how the run ended."""

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
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS, instance_of, refusal, shown

NEVER = 1e300

RK4_ORDER = 3

# Real motion stays far below: a slip of a block takes about one time unit or longer.
EVENTS_PER_BLOCK_AND_UNIT = 1000
STEP_LIMIT = 10**10


class Runner:
    """A solver of one model.

    solver : series, map (closed form) or rk4
    step : time step of rk4
    events_from : time from which events are kept with the state; earlier events have time, block and kind only
    keep_events : whether events are kept; otherwise they are only counted
    stops_only : whether only the stops from `events_from` on are kept
    observer : measures the run; without it nothing is measured
    exponents : perturbations from which Lyapunov exponents are computed
    perturbations : tangent vectors to carry along unchanged by the solver, columns of shape (2 blocks, vectors)

    Raises ValueError if the solver needs a closed form and the model has none.
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
                "solver: got 'map', expected series | rk4: map needs a closed form, that is a linear friction law, not "
                "too steep, in a uniform chain of masses 1 with open ends"
            )
        self.model = model
        # These decide the steps: a continued run repeats the steps of the whole run only if they are equal.
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
        """Start from an instant, at its time; raises ValueError if its number of blocks is not the model's."""
        blocks = self.model.blocks
        if not isinstance(at, ChainState) or {np.shape(x) for x in (at.position, at.velocity, at.stuck)} != {(blocks,)}:
            raise refusal("state", at, f"a ChainState of {blocks} blocks")
        self.kernel.begin(at.position, at.velocity, at.stuck, at.time)
        if at.last_step is not None and at.last_step[0] == self.solver:
            self.kernel.resume(at.last_step[1], at.time)

    def final(self) -> ChainState:
        """Return the state at the end of a completed run, from which a run continues with the same steps."""
        at = replace(self.state(), time=self.clock)
        object.__setattr__(at, "last_step", (self.solver, self.kernel.mark()))
        return at

    def carry(self, perturbations: np.ndarray) -> None:
        """Carry the columns of a matrix (2 blocks, vectors) along from now on, without orthonormalising them."""
        self.exponents.carry(perturbations)

    def run(self, until: float | None = None, halting_block: int = -1) -> Status:
        """Integrate to a time, or to the end of the observer's window, and return the status.

        halting_block : halt at each stop of this block; the next call continues from there

        Raises ValueError if `rk4` is given either argument, since it only integrates the observer's window, and if the
        run would keep more than MOST_NUMBERS numbers.
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
        """Return the state a given time after an instant, or None if the run fails."""
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
        """The perturbations carried along, columns of shape (2 blocks, vectors)."""
        return self.exponents.tangent.matrix()

    def events(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return time, block (0 …) and kind (0 stop, 1 start) of the events kept."""
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
    """Return the observer of a run: J averaged over batches, J and states at given times; see `Observer`."""
    apart = float(model.sliding_offset[-1] - model.sliding_offset[0])
    return Observer(model.blocks, order, apart, edge, distance_time, trajectory_time, section_only, section.block)


def new_friction(model: Model, order: int) -> Friction:
    """Return the friction on the blocks of a model, for Taylor series of a given order."""
    law, thresholds = model.law, model.chain.thresholds
    slopes = -float(law.slope(0.0)), float(thresholds.max()) * law.steepest
    columns = -(-model.blocks // WIDTH)
    return Friction(*law.tape.table, law.tape.value, law.tape.slope, law.is_linear, *slopes, columns, order)


def check_kernel(chain: Chain) -> None:
    """Raise ValueError, one line, for a chain that the kernel cannot move: a network, or masses other than 1."""
    if chain.is_network:
        raise ValueError("chain: got a network of springs, expected a row or a ring, which the solvers can move")
    if (chain.masses != 1.0).any():
        raise ValueError(f"chain.mass: got {shown(chain.mass)}, expected 1.0, which the solvers can move")


def _state(model: Model, order: int) -> State:
    chain = model.chain
    check_kernel(chain)
    springs = Springs(
        chain.diagonal, chain.before, chain.after, chain.thresholds, chain.thresholds * float(model.law(model.v))
    )
    return State(springs, new_friction(model, order), model.v, model.contact == "symmetric")
