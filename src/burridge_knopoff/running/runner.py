"""The runner: a solver of one model that starts from a state, integrates, and reports how the run ended."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from burridge_knopoff.kernel._core import Catalogue, EventLog, Exponents, Observer, Run, TimeStepping, run_in_lockstep
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.kernel_model import kernel_model
from burridge_knopoff.running.loading import check_loading
from burridge_knopoff.running.normal_modes import normal_modes
from burridge_knopoff.running.section import SUM, Section
from burridge_knopoff.running.solvers import RUN_SOLVERS, SOLVERS
from burridge_knopoff.running.status import Status
from burridge_knopoff.values import MOST_NUMBERS, instance_of, real_array, real_number

#: Solvers with a fixed step.

# Real motion stays far below this rate: a slip of a block takes about one time unit or longer.
EVENTS_PER_BLOCK_AND_UNIT = 1000
STEP_LIMIT = 10**10

#: Number of runs that are best carried out in lockstep: enough to fill the lanes, few enough for the processor's cache.
LOCKSTEP_RUNS = 64

# Velocity of either sign that rounding may leave to a block when it stops at the same instant as another block. It is
# relative to the largest of 1, the driver velocity and the speed of the fastest block.
ROUNDING = 1e-12

# A window that never begins, and no times at which anything is measured.
NEVER, NONE = np.full(2, math.inf), np.zeros(0)


class Runner:
    """A solver of one model.

    solver : series, map (closed form), rk4, or euler for comparison (explicit)
    step : time step of rk4 and euler
    events_from : time from which events are stored with the state; earlier events have time, block and kind only
    keep_events : whether events are stored; otherwise they are only counted
    stops_only : whether only the stops after `events_from` are stored
    observer : measures the run; without it nothing is measured
    exponents : perturbations from which Lyapunov exponents are computed
    perturbations : tangent vectors to propagate without orthonormalisation, columns of shape (2 blocks, vectors)
    groups : whether sets of blocks that slip together are integrated separately; None for whichever is faster
    catalogue : records slip events
    loading : steady, or quasistatic (with the solver series and without an observer). Under quasi-static loading the
        times of states and of `run` are those of the loading clock τ, the displacement of the driver divided by v; the
        slip clock of events runs while blocks slip; exponents are rates per unit of the loading clock

    Raises ValueError if the solver needs a closed form and the model has none, and for quasi-static loading if friction
    does not drop at the start of a slip: a block at its threshold would never move.
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
        groups: bool | None = None,
        catalogue: Catalogue | None = None,
        loading: str = "steady",
    ) -> None:
        instance_of(model, Model, "model")
        kind = SOLVERS[solver]
        if kind.closed_form and not model.has_closed_form:
            others = " | ".join(name for name in RUN_SOLVERS if not SOLVERS[name].closed_form)
            raise ValueError(
                f"solver: got {solver!r}, expected {others}: it needs a closed form, a friction law that is linear and "
                "not too steep, in a uniform chain with open ends and without dashpots"
            )
        check_loading(loading, model, solver)
        self.model = model
        # A continued run repeats the steps of the whole run only if these are equal.
        self.step_key = model, solver, step if kind.has_fixed_step else None, loading
        blocks = model.blocks
        rate_limit = EVENTS_PER_BLOCK_AND_UNIT * blocks
        self.log = EventLog(blocks, events_from, keep_events, rate_limit, stops_only, MOST_NUMBERS)
        nothing = 0.0, NEVER, NONE, NONE, NONE, False, 0, MOST_NUMBERS
        self.observer = observer if observer is not None else Observer(blocks, *nothing)
        if exponents is None:
            exponents = Exponents(blocks, 0 if perturbations is None else perturbations.shape[1], math.inf, NEVER)
        self.exponents = exponents
        self.kernel: Run | TimeStepping
        if kind.has_fixed_step:
            self.kernel = TimeStepping(kernel_model(model), self.log, self.observer, step, kind.order == 1)
        else:
            choice = 0 if kind.closed_form else -1 if groups is None else int(groups)
            self.kernel = Run(
                kernel_model(model, loading),
                self.log,
                self.observer,
                exponents,
                observer is not None,
                choice,
                STEP_LIMIT,
                model.v if loading == "quasistatic" else 0.0,
            )
            if kind.closed_form:
                self.kernel.use_modes(partial(normal_modes, model.chain))
        self.catalogue = catalogue
        if catalogue is not None:
            self.kernel.record(catalogue)
        if perturbations is not None:
            self.carry(perturbations)

    def begin(self, at: ChainState, clock: float | None = None) -> None:
        """Start from a state.

        clock : time τ at which the run starts. By default it is the time of the state, and the run first repeats the
            last step before this state

        Raises ValueError as `check_state` does.
        """
        check_state(self.model, at)
        self._place(at, at.time if clock is None else clock)
        if clock is None and at.last_step is not None and at.last_step[0] == self.step_key:
            self.kernel.resume(at.last_step[1], at.time)

    def _place(self, at: ChainState, clock: float) -> None:
        position, velocity = (np.asarray(x, dtype=float) for x in (at.position, at.velocity))
        self.kernel.begin(position, velocity, np.asarray(at.stuck, dtype=bool), clock)

    def final(self, status: Status = Status.COMPLETED) -> ChainState:
        """Return the state at the end of a run. If the run completed, another run can continue with the same steps."""
        at = replace(self.state(), time=self.clock)
        if status != Status.COMPLETED:
            return at
        object.__setattr__(at, "last_step", (self.step_key, self.kernel.mark()))
        return at

    def carry(self, perturbations: np.ndarray) -> None:
        """Propagate the columns of a matrix (2 blocks, vectors) from now on, without orthonormalising them."""
        self.exponents.carry(np.ascontiguousarray(perturbations, dtype=float))

    def run(self, until: float | None = None, halting_block: int = -1) -> Status:
        """Integrate to a time, or to the end of the observer's window, and return the status.

        halting_block : halt at each stop of this block; the next call continues from there

        Raises ValueError if the solver is rk4 or euler and an argument is given, since these solvers integrate only
        over the observer's window, and if the run would store more than MOST_NUMBERS numbers.
        """
        if isinstance(self.kernel, Run):
            self.kernel.halting_block = halting_block
            self.kernel.end = self.observer.end if until is None else until
        elif until is not None or halting_block >= 0:
            raise ValueError(f"solver: got {self.step_key[1]!r}, expected series | map for a run to a time or a stop")
        return self.status_of(self.kernel.run())

    def status_of(self, how: int) -> Status:
        """Return the status for the number with which the kernel ended a run. Raises ValueError as `run` does."""
        status = Status(how)
        for key, table, remedy in (
            ("catalogue", self.catalogue, "a shorter window, or none of the profiles"),
            ("events", self.log.earlier_events, "none, or a shorter transient or window"),
            ("events", self.log.events, "none, or a shorter event_window or window"),
            ("window", self.observer.crossings, "a shorter one"),
        ):
            if table is not None and table.full:
                most = f"{MOST_NUMBERS:.0e} numbers to store by τ = {self.clock:.6g}"
                raise ValueError(f"{key}: got more than {most}, expected {remedy}")
        return status

    def state_after(self, at: ChainState, time: float) -> ChainState | None:
        """Return the state after a given time, or None if the run fails. The clock starts at 0.

        at : the initial state. It may be one that no motion reaches, since Newton's method passes through such states
        """
        _check_blocks(self.model, at)
        self._place(at, 0.0)
        return self.state() if self.run(time) == Status.COMPLETED else None

    def state(self) -> ChainState:
        """Return the present state."""
        position, velocity, slip = self.kernel.values()
        return ChainState(position, velocity, slip == 0)

    @property
    def clock(self) -> float:
        """The present time τ; under quasi-static loading, the time of the loading clock."""
        return self.kernel.clock

    @property
    def perturbations(self) -> np.ndarray:
        """The propagated perturbations, columns of shape (2 blocks, vectors)."""
        return self.exponents.matrix()

    def events(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return time, block (0 …) and kind (0 stop, 1 start) of the stored events."""
        values = self.log.events.values()
        return self.log.events.times(), values[:, 0].astype(int) - 1, values[:, 1].astype(int)


def run_together(runners: Sequence[Runner]) -> list[int]:
    """Integrate several runs to the ends of their observers' windows; return the numbers for `Runner.status_of`.

    Each run gives the same results as alone, to the bit. Runs of models that differ only in parameters are faster
    together.
    """
    kernels = [runner.kernel for runner in runners]
    for runner, kernel in zip(runners, kernels, strict=True):
        if isinstance(kernel, Run):
            kernel.end = runner.observer.end
    together = iter(run_in_lockstep([kernel for kernel in kernels if isinstance(kernel, Run)]))
    return [next(together) if isinstance(kernel, Run) else kernel.run() for kernel in kernels]


def check_state(model: Model, at: ChainState) -> None:
    """Check that a state is possible in a model.

    Raises ValueError, one line, for another number of blocks, for numbers that are not finite, for a stuck block with a
    velocity, and for a block that slips backward under one-sided contact.
    """
    _check_blocks(model, at)
    position, velocity = real_array(at.position, "state.position"), real_array(at.velocity, "state.velocity")
    for name, values in (("position", position), ("velocity", velocity)):
        if not np.isfinite(values).all():
            raise refusal(f"state.{name}", values[~np.isfinite(values)][0], "finite numbers")
    if not math.isfinite(real_number(at.time)):
        raise refusal("state.time", at.time, "a finite number")
    moving = np.flatnonzero(np.asarray(at.stuck, dtype=bool) & (velocity != 0.0))
    if len(moving):
        raise refusal(f"state.velocity[{moving[0]}]", velocity[moving[0]], "0 because this block sticks")
    model.check_directions(velocity, "state.velocity", ROUNDING * max(1.0, model.v, np.abs(velocity).max()))


def _check_blocks(model: Model, at: ChainState) -> None:
    blocks = model.blocks
    if not isinstance(at, ChainState) or {at.position.shape, at.velocity.shape, at.stuck.shape} != {(blocks,)}:
        raise refusal("state", at, f"a ChainState of {blocks} blocks")


def new_observer(
    model: Model,
    edge: np.ndarray | list[float],
    distance_time: np.ndarray | list[float] = (),  # type: ignore[assignment]
    trajectory_time: np.ndarray | list[float] = (),  # type: ignore[assignment]
    section_only: bool = False,
    section: Section = SUM,
    level: Sequence[float] = (),
) -> Observer:
    """Return the observer of a run: J averaged over batches, J and states at given times, its last times at levels.

    See `Observer`.
    """
    apart = float(model.sliding_offset[-1] - model.sliding_offset[0])
    edges, at, through, levels = (np.asarray(x, dtype=float) for x in (edge, distance_time, trajectory_time, level))
    return Observer(model.blocks, apart, edges, at, through, levels, section_only, section.block, MOST_NUMBERS)
