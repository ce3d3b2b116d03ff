"""The flow of a chain from one instant to another, without the observables of a whole run."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from burridge_knopoff.chain import Chain
from burridge_knopoff.friction import Friction
from burridge_knopoff.initial import InitialState
from burridge_knopoff.kernel.event_driven import EventDriven
from burridge_knopoff.kernel.events import EventLog
from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.kernel.observe import Observer
from burridge_knopoff.simulation import EVENTS_PER_BLOCK_AND_UNIT, SERIES_ORDER, STEP_LIMIT, new_state, starts_stuck

NEVER = 1e300

#: What a solver's `run` returns, besides the codes of a failed run.
HALTED, RUNNING, COMPLETED = -2, -1, 0


@dataclass(frozen=True)
class Model:
    """Chain, friction law, driver velocity v and convention of contact: all that the equations of motion need."""

    chain: Chain
    friction: Friction
    v: float = 0.1
    contact: str = "one_sided"

    @property
    def scale(self) -> float:
        """Motion is in proportion to v (for the linearized law exactly): factor on distances, given for v = 0.1."""
        return self.v / 0.1

    @property
    def sliding_offset(self) -> np.ndarray:
        """Positions e of uniform sliding relative to the driver, shape (blocks,)."""
        return self.chain.sliding_offset(float(self.friction(self.v)))


@dataclass(frozen=True, eq=False)
class Instant:
    """The state of all blocks at one instant, arrays of shape (blocks,).

    position : co-moving x_i = U_i − vτ − e_i; velocity : U_i'; stuck : which blocks stick
    """

    position: np.ndarray
    velocity: np.ndarray
    stuck: np.ndarray

    def mirrored(self) -> Instant:
        """Return the state seen from the other end of the chain."""
        return Instant(self.position[::-1].copy(), self.velocity[::-1].copy(), self.stuck[::-1].copy())

    def vector(self) -> np.ndarray:
        """Return positions and velocities in one array, shape (2 blocks,)."""
        return np.concatenate([self.position, self.velocity])


def begin(model: Model, initial: InitialState, start: str = "moving") -> Instant:
    """Return the state at τ = 0 of a run that begins from an initial state under a convention of start."""
    stuck = starts_stuck(model.chain, np.array(initial.position), start)
    position = np.array(initial.position) - model.sliding_offset
    return Instant(position, np.where(stuck, 0.0, np.array(initial.velocity)), stuck)


def instant(solver: EventDriven) -> Instant:
    """Return the present state of a solver."""
    position, velocity, slip = solver.state.values()
    return Instant(position, velocity, slip == 0)


def new_solver(
    model: Model,
    log: EventLog | None = None,
    perturbations: np.ndarray | None = None,
    observer: Observer | None = None,
) -> EventDriven:
    """Return a solver of its own: `map` for the linearized law, `series` for the nonlinear one.

    log : where events are kept; without one they are only counted
    perturbations : tangent vectors to carry along, columns of shape (2 blocks, vectors); see `kernel.tangent`
    observer : what measures the run, and ends it; without one nothing is measured

    Set its `end` and `halting_block`, call `begin(position, velocity, stuck)` and then `run()`, which returns HALTED
    each time that block has just stopped, COMPLETED at the end, RUNNING if it is to be called again.
    """
    blocks = model.chain.blocks
    never = [NEVER, NEVER]
    exponents = Exponents(blocks, 0 if perturbations is None else perturbations.shape[1], SERIES_ORDER, NEVER, never)
    if perturbations is not None:
        exponents.carry(perturbations)
    solver = EventDriven(
        new_state(model.chain, model.friction, model.v, model.contact),
        EventLog(blocks, 0.0, False, EVENTS_PER_BLOCK_AND_UNIT * blocks) if log is None else log,
        Observer(blocks, SERIES_ORDER, never, [], []) if observer is None else observer,
        exponents,
        SERIES_ORDER,
        model.friction.law == "linearized",
        STEP_LIMIT,
    )
    solver.observing = observer is not None
    return solver
