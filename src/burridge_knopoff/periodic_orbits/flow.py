"""Integration of a state over a time: the final state, the events and the mean of J.

Periodic orbits need four functions of a model: `new_runner`, `mean_distance`, `rate` and
`grazing_distances.distances_of`. Another type of model, such as a map, can register functions of its own for them.
"""

from __future__ import annotations

from functools import singledispatch

import numpy as np

from burridge_knopoff.model.model import ChainState, Model, at_recorded_a
from burridge_knopoff.running.runner import Runner, new_observer


class OrbitError(ValueError):
    """A periodic orbit does not exist or was not found; the message gives the reason.

    >>> from burridge_knopoff import Model, OrbitError, synchronized_orbit
    >>> try:
    ...     synchronized_orbit(Model("linearized", a=0.08, threshold=(1, 1, 2)))
    ... except OrbitError as error:
    ...     print(error)
    chain: got a chain that is not its own mirror image, expected one that is
    """


def model_at(model: Model, a: float) -> Model:
    """Return a model at another friction parameter; raises OrbitError if its law does not allow that."""
    try:
        return at_recorded_a(model, a)
    except ValueError as error:
        raise OrbitError(str(error)) from None


@singledispatch
def new_runner(model: Model, perturbations: np.ndarray | None = None) -> Runner:
    """Return a runner of a model that keeps its events and carries perturbations; see `Runner`."""
    return Runner(model, keep_events=True, perturbations=perturbations)


def flow(model: Model, start: ChainState, time: float) -> Runner:
    """Return the runner after a time; raises OrbitError if the run does not complete."""
    runner = new_runner(model)
    state_after(runner, start, time)
    return runner


def state_after(runner: Runner, start: ChainState, time: float) -> ChainState:
    """Return the state a time after a given state, integrated by a runner.

    Raises OrbitError if the run does not complete.
    """
    end = runner.state_after(start, time)
    if end is None:
        raise OrbitError(f"the run ends at τ = {runner.clock!r}, before {time!r}")
    return end


@singledispatch
def mean_distance(model: Model, start: ChainState, period: float) -> float:
    """Return ⟨J⟩ over one period, starting from a state on an orbit."""
    observer = new_observer(model, [0.0, period])
    state_after(Runner(model, observer=observer), start, period)
    return float(observer.results()["batch_integral"][0]) / period


@singledispatch
def rate(model: Model, at: ChainState) -> np.ndarray:
    """Return the time derivative of positions and velocities, shape (2 blocks,)."""
    friction = np.where(at.velocity < 0.0, -1.0, 1.0) * model.friction(np.abs(at.velocity))
    drop = model.chain.thresholds * (model.sliding_friction - friction)
    force = drop - _products(model.chain.stiffness, at.position)
    if model.chain.is_damped:
        force += model.chain.damping_force(at.velocity, model.v)
    return np.concatenate([at.velocity - model.v, np.where(at.stuck, 0.0, force / model.chain.masses)])


def _products(vectors: np.ndarray, of: np.ndarray) -> np.ndarray:
    """Return the product of each row with a vector, with the same order of summation on every machine."""
    return (vectors * of).sum(axis=1)
