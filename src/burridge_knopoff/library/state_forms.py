"""The forms in which users give a state: the paper's names, numbers, a state of a motion, or a run."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import replace
from typing import Any

import numpy as np

from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.fields import Field, Keys, fields_of
from burridge_knopoff.model.initial import (
    CONTINUED,
    OWN,
    PAPER_STATES,
    STATE_NAME,
    InitialState,
    StartedState,
    has_paper_numbers,
    initial_state,
)
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.cost import cost_note, is_dense, is_stiff
from burridge_knopoff.running.runner import check_state
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.trajectory import Trajectory
from burridge_knopoff.values import elements, is_sequence

#: A state: minus or plus, an `InitialState`, {"position": …, "velocity": …} or (position, velocity); or that of a
#: motion, a `ChainState` or a run, meaning its final state.
Initial = str | InitialState | Mapping[str, Any] | Sequence[Sequence[float]] | np.ndarray | ChainState | Trajectory

_KEYS = Keys({"name": Field(STATE_NAME, "name of the state", OWN), **fields_of(InitialState)})
_FORMS = f"{' | '.join(PAPER_STATES)}, InitialState, {{'position': …, 'velocity': …}}, (position, velocity), or a Run"


def given_state(initial: Any, key: str = "initial") -> InitialState:
    """Return an initial state from any of its forms.

    Raises ValueError, one line, for anything else, and for other values under one of the paper's names.
    """
    state = initial if isinstance(initial, InitialState) else _state(initial, key)
    if isinstance(state, StartedState):
        # In another model the numbers are not those of the paper's state.
        return replace(state, name=OWN) if state.name in PAPER_STATES else state
    if state.name in PAPER_STATES and not has_paper_numbers(state):
        raise refusal(f"{key}.name", state.name, "another name: the paper has a different state of that name")
    return state


def _state(initial: Any, key: str) -> InitialState:
    if isinstance(initial, str):
        return initial_state(initial, key=key)
    if isinstance(initial, Mapping):
        return InitialState(**_KEYS.form(initial, key))
    pair = elements(initial) or []
    if len(pair) != 2 or not all(map(is_sequence, pair)):
        raise ValueError(f"{key}: got {format_value(initial)}, expected {_FORMS}, with one number per block")
    return InitialState(**_KEYS.form(dict(zip(("position", "velocity"), pair, strict=True)), key))


def has_several_names(initial: Any) -> bool:
    """Return whether a value is a list of states, and not positions and velocities, or a mapping of named states."""
    if isinstance(initial, Mapping):
        return bool(initial) and all(isinstance(item, Mapping) for item in initial.values())
    items = elements(initial)
    return items is not None and not (
        len(items) == 2 and all(is_sequence(x) and not any(map(is_sequence, x)) for x in items)
    )


def named_states(initial: Any) -> dict[str, InitialState | ChainState | Trajectory]:
    """Return states by name, from one state, a list, or {NAME: numbers}: numbers alone are `own`, motions `continued` …

    Raises ValueError, one line, for what is no state, for numbers without a name in a list, and for equal names.
    """
    several = has_several_names(initial)
    items = elements(initial) or [] if several else [initial]
    if several and isinstance(initial, Mapping):
        items = [{"name": name, **numbers} for name, numbers in initial.items()]
    states: dict[str, Any] = {}
    for number, item in enumerate(items):
        key = f"initial[{number}]" if several else "initial"
        if several and not isinstance(item, str | Mapping | InitialState | ChainState | Trajectory):
            named = '{"name": …, "position": …, "velocity": …}'
            raise ValueError(f"{key}: got {format_value(item)}, expected a state with a name, such as {named}")
        state = item if isinstance(item, ChainState | Trajectory) else given_state(item, key)
        motions = sum(not isinstance(other, InitialState) for other in states.values())
        name = state.name if isinstance(state, InitialState) else f"{CONTINUED}{f'_{motions + 1}' * (motions > 0)}"
        if name in states:
            raise ValueError(f"{key}: got the name {name!r} twice, expected another one: InitialState(name, …)")
        states[name] = state
    if not states:
        raise ValueError("initial: got no state, expected at least one")
    return states


def state_in(model: Model, initial: Initial, key: str = "initial") -> InitialState | ChainState:
    """Return a state in any form as the model takes it: of a run its final state.

    The final state of a run of another model keeps its positions relative to the driver, its velocities and which of
    its blocks stick, on its own clock; a warning says so. Raises ValueError, one line, for what is no state, and for
    another number of blocks.
    """
    if isinstance(initial, Trajectory):
        state, remark = final_state(model, initial, key)
        if remark:
            warnings.warn(remark, stacklevel=3)
        return state
    if isinstance(initial, StartedState):
        return _restarted(model, initial)
    if not isinstance(initial, ChainState):
        return given_state(initial, key)
    check_state(model, initial)
    return initial


def _restarted(model: Model, state: StartedState) -> InitialState:
    """Return the state from which a run started as that of another run: the paper's, if it has these numbers at v."""
    paper = PAPER_STATES.get(state.name)
    if paper and np.array_equal(model.initial_coordinates(paper), state.coordinates(model.blocks)):
        return paper
    return given_state(state)


def final_state(model: Model, run: Trajectory, key: str = "initial") -> tuple[ChainState, str]:
    """Return the final state of a run in a model, and a remark if the run is of another one, see `state_in`."""
    if model.blocks != run.model.blocks:
        raise ValueError(f"{key}: got a run of {run.model.blocks} blocks, expected {model.blocks}")
    try:
        model.check_same(run.model, key)
    except ValueError as difference:
        position = run.final.position + run.model.sliding_offset - model.sliding_offset
        return replace(run.final, position=position), (
            f"{difference}: the run keeps its positions relative to the driver, its velocities and its stuck blocks"
        )
    return run.final, ""


def initial_numbers(model: Model, initial: Initial, key: str = "initial") -> InitialState:
    """Return the positions U and velocities of a state in any form, of a motion as if it had begun there at τ = 0."""
    state = state_in(model, initial, key)
    if not isinstance(state, ChainState):
        return state
    position = state.position + model.sliding_offset
    # A velocity below 0 is rounding there.
    velocity = np.maximum(state.velocity, 0.0) if model.contact == "one_sided" else state.velocity
    return InitialState(OWN, tuple(position.tolist()), tuple(velocity.tolist()))


def begun_state(
    model: Model,
    initial: Initial,
    key: str = "initial",
    start: str = "moving",
    loading: str = "steady",
) -> ChainState:
    """Return the state at which the motion from a state in any form begins in a model.

    start, loading : see `Model.begin`, for states that are not those of a motion
    """
    state = state_in(model, initial, key)
    return state if isinstance(state, ChainState) else model.begin(state, start, loading)


def warn_of_run(model: Model, initial: InitialState | ChainState, settings: Settings) -> None:
    """Warn, before it starts, of a run that drops given velocities, and of a long one.

    A long one takes more than a minute, since springs or dashpots are stiff, or springs are very many.
    """
    if isinstance(initial, InitialState) and (remark := model.dropped_velocities(initial, settings.start)):
        warnings.warn(remark, stacklevel=3)
    if is_stiff(model.chain) or is_dense(model.chain):
        begun = initial if isinstance(initial, ChainState) else model.begin(initial, settings.start)
        if note := cost_note(model, begun, settings):
            warnings.warn(note, stacklevel=3)
