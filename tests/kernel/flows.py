"""Running models from one instant to another, with perturbations, for tests of the tangent dynamics."""

import numpy as np

from burridge_knopoff.kernel.exponents import Exponents
from burridge_knopoff.running.runner import SERIES_ORDER, Runner
from burridge_knopoff.running.status import Status


def later(model, start, end):
    """Return the instant that a state reaches at time `end`."""
    reached = Runner(model).after(start, end)
    assert reached is not None
    return reached


def growth_from(model, start, end, vectors):
    """Return the exponents' kernel after a run from `start` to `end`, all of it in one batch from τ = 0."""
    exponents = Exponents(model.blocks, vectors, SERIES_ORDER, 0.0, [0.0, end])
    solver = Runner(model, exponents=exponents)
    solver.begin(start)
    assert solver.run(end) == Status.COMPLETED
    return exponents.results()


def carry(model, start, end, perturbations=None, solver_name="series"):
    """Return the solver at time `end` and the events on the way: a list of (time, block from 1, 0 stop | 1 start)."""
    solver = Runner(model, solver_name, keep_events=True, perturbations=perturbations)
    solver.begin(start)
    assert solver.run(end) == Status.COMPLETED
    time, block, kind = solver.events()
    return solver, list(zip(time.tolist(), (block + 1).tolist(), kind.tolist(), strict=True))


def directions(start):
    """Return all perturbations that the state allows as columns: a stuck block has no velocity to perturb."""
    return np.diag(np.concatenate([np.ones(len(start.stuck)), ~start.stuck]))
