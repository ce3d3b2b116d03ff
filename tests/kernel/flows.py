"""Running the kernel's solvers from one instant to another, with perturbations, for tests of the tangent dynamics."""

import numpy as np

from burridge_knopoff.kernel.event_driven import EventDriven
from burridge_knopoff.kernel.events import EventLog
from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.kernel.observe import Observer
from burridge_knopoff.simulation import RUNNING, SERIES_ORDER, STEP_LIMIT, new_state
from burridge_knopoff.stability.flow import NEVER, instant, new_solver

COMPLETED, HALTED = 0, -2


def to_end(solver):
    """Run a solver on until it ends or halts; return why."""
    while (code := solver.run()) == RUNNING:
        pass
    return code


def solver_with(model, exponents, *, closed_form=None, keep=False):
    """Return a solver that carries these exponents; the motion comes from normal modes or from series."""
    blocks = model.chain.blocks
    solver = EventDriven(
        new_state(model.chain, model.friction, model.v, model.contact),
        EventLog(blocks, 0.0, keep, 1000 * blocks),
        Observer(blocks, SERIES_ORDER, [NEVER, NEVER], [], []),
        exponents,
        SERIES_ORDER,
        model.friction.law == "linearized" if closed_form is None else closed_form,
        STEP_LIMIT,
    )
    solver.observing = False
    return solver


def closed_form_or_series(model, solver_name, perturbations):
    """Return a solver for the linearized law that takes the motion from the normal modes or from the series."""
    exponents = Exponents(model.chain.blocks, perturbations.shape[1], SERIES_ORDER, NEVER, [NEVER, NEVER])
    exponents.carry(perturbations)
    return solver_with(model, exponents, closed_form=solver_name == "map", keep=True)


def later(model, start, end):
    """Return the instant that a state reaches at time `end`."""
    solver = new_solver(model)
    solver.end = end
    solver.begin(start.position, start.velocity, start.stuck)
    assert to_end(solver) == COMPLETED
    return instant(solver)


def growth_from(model, start, end, vectors):
    """Return the exponents' kernel after a run from `start` to `end`, all of it in one batch from τ = 0."""
    exponents = Exponents(model.chain.blocks, vectors, SERIES_ORDER, 0.0, [0.0, end])
    solver = solver_with(model, exponents)
    solver.end = end
    solver.begin(start.position, start.velocity, start.stuck)
    assert to_end(solver) == COMPLETED
    return exponents.results()


def carry(model, start, end, perturbations=None):
    """Return the solver at time `end` and the events on the way: a list of (time, block from 1, 0 stop | 1 start)."""
    blocks = model.chain.blocks
    log = EventLog(blocks, 0.0, True, 1000 * blocks)
    solver = new_solver(model, log, perturbations)
    solver.end = end
    solver.begin(start.position, start.velocity, start.stuck)
    assert to_end(solver) == COMPLETED
    return solver, [
        (time, int(row[0]), int(row[1])) for time, row in zip(log.events.times(), log.events.values(), strict=True)
    ]


def directions(start):
    """Return all perturbations that the state allows as columns: a stuck block has no velocity to perturb."""
    return np.diag(np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))
