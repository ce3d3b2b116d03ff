"""Labels: which of several known attractors a trajectory reaches, and at what time this is certain."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from burridge_knopoff.attractors.attractor import Attractor, attractors_of
from burridge_knopoff.attractors.settings import SEARCH
from burridge_knopoff.kernel._core import Clouds
from burridge_knopoff.model.model import STARTS, ChainState, Model
from burridge_knopoff.model.ranges import Number, OneOf
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.running.cores import chosen_cores
from burridge_knopoff.running.ensemble import new_ensemble
from burridge_knopoff.running.settings import LONGEST
from burridge_knopoff.running.threads import map_in_threads
from burridge_knopoff.values import instance_of, real_array

#: Label of a state that reaches no known attractor.
UNDETERMINED = -1


def label(
    model: Model, attractors: Sequence[Attractor], starts: Sequence[ChainState], time_limit: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return the label of each state, and the time at which it was certain, both of shape (n,).

    A label is the index of an attractor, or −1 if none is reached by the time limit.
    """
    if not len(attractors) or not len(starts):
        return np.full(len(starts), UNDETERMINED, dtype=np.intc), np.zeros(len(starts))
    return label_arrays(model, attractors, *stack_states(starts), time_limit)[:2]


def stack_states(starts: Sequence[ChainState]) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return positions, velocities and stuck blocks of states as arrays, each of shape (n, blocks)."""
    position, velocity, stuck = (
        np.array([getattr(start, name) for start in starts]) for name in ("position", "velocity", "stuck")
    )
    return position, velocity, stuck


def label_arrays(
    model: Model,
    attractors: Sequence[Attractor],
    position: np.ndarray,
    velocity: np.ndarray,
    stuck: np.ndarray,
    time_limit: float,
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return labels and times as `label` does, for states x_i, U_i' and stuck blocks, each of shape (n, blocks).

    The third array contains the states at the time limit, shape (n, 2 blocks), NaN if a label was certain before.

    A state has reached an attractor when `close_returns` of its successive returns lie within the capture radius of
    returns of the attractor. If the attractor has a patience, a state that reaches an attractor without one within this
    time is assigned to the latter.
    """

    def first(
        attractors: Sequence[Attractor], states: np.ndarray | slice, end: float
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        clouds = Clouds(
            [attractor.motion.returns for attractor in attractors],
            2 * model.blocks,
            [attractor.radius for attractor in attractors],
        )
        returns = [attractor.close_returns for attractor in attractors]
        block = [attractor.motion.block - 1 for attractor in attractors]
        section = [int(attractor.motion.section) for attractor in attractors]
        begun = position[states], velocity[states], stuck[states].astype(bool)
        return new_ensemble(model).label(*begun, clouds, returns, block, section, end)

    labels, times, last = first(attractors, slice(None), time_limit)
    prompt = [index for index, attractor in enumerate(attractors) if not attractor.patience]
    for index, attractor in enumerate(attractors):
        near = np.flatnonzero(labels == index)
        if not (attractor.patience and prompt and len(near)):
            continue
        prompt_labels, when, _ = first([attractors[k] for k in prompt], near, min(attractor.patience, time_limit))
        gone = prompt_labels != UNDETERMINED
        labels[near[gone]], times[near[gone]] = np.array(prompt)[prompt_labels[gone]], when[gone]
    return labels, times, last


def advance(model: Model, starts: Sequence[ChainState], time: float) -> list[ChainState]:
    """Return the states after a time."""
    end = new_ensemble(model).run(*stack_states(starts), [time])
    return [state_of(state) for state in np.concatenate([end["position"][:, 0], end["velocity"][:, 0]], axis=1)]


def label_states(
    model: Model,
    attractors: Sequence[Attractor],
    position: ArrayLike,
    velocity: ArrayLike,
    *,
    start: str = "moving",
    time_limit: float = SEARCH.time_limit,
    cores: int | None = None,
) -> tuple[np.ndarray, np.ndarray]:
    """Return the attractor that each initial state reaches, and the time τ at which this is certain, shape (n,) each.

    model, attractors : as `find_attractors` takes and returns them; the attractors are those of this model
    position, velocity : U(0) and U'(0), shape (n, blocks); start : moving or tested, see `Model.begin`
    time_limit : time by which a state has to reach one of them
    cores : number of cores that share the trajectories, by default all; the labels do not depend on it

    A label is the index of an attractor, or −1 if none is reached. Raises ValueError, one line, for attractors of
    another model, for shapes, times or a start that are not allowed, for numbers that are not finite, and for
    velocities below 0 under one-sided contact.

    >>> import numpy as np
    >>> from burridge_knopoff import Model, SearchSettings, find_attractors, label_states
    >>> model = Model("linearized", a=0.08)
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> position = np.array([[-0.989, -0.993, -0.991], [0.989, -0.993, -0.991]])
    >>> velocity = np.array([[0.099, 0.1012, 0.1023]] * 2)
    >>> labels, times = label_states(model, attractors, position, velocity)
    >>> labels.tolist(), times.round().tolist()
    ([0, 1], [62.0, 355.0])
    """
    instance_of(model, Model, "model").law.check_complete()
    attractors = attractors_of(model, attractors)
    position, velocity = real_array(position, "position"), real_array(velocity, "velocity")
    if not position.shape == velocity.shape == (*position.shape[:1], model.blocks):
        raise ValueError(
            f"position, velocity: got shapes {position.shape}, {velocity.shape}, expected (n, {model.blocks}) for both"
        )
    slowest = 0.0 if model.contact == "one_sided" else -np.inf
    if not (np.isfinite(position).all() and np.isfinite(velocity).all() and (velocity >= slowest).all()):
        raise ValueError(
            f"position, velocity: expected finite numbers, and velocities of at least {slowest:g} under {model.contact}"
        )
    OneOf(STARTS).form(start, "start")
    time_limit = Number(0.0, 10.0 * LONGEST, above=True).form(time_limit, "time_limit")
    cores = chosen_cores(cores)
    cores = max(1, min(cores, len(position)))
    stuck = model.stuck_blocks(position, velocity, start)
    labels = np.full(len(position), UNDETERMINED, dtype=np.intc)
    times = np.zeros(len(position))
    if not attractors:
        return labels, times
    offset = position - model.sliding_offset
    edges = np.linspace(0, len(position), cores + 1).astype(int)

    def work(first: int, last: int) -> None:
        part = slice(first, last)
        labels[part], times[part], _ = label_arrays(
            model, attractors, offset[part], velocity[part], stuck[part], time_limit
        )

    map_in_threads(cores, work, edges[:-1], edges[1:])
    return labels, times
