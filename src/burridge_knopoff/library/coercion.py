"""Convert the forms in which users give initial states and models."""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from burridge_knopoff.laws import Law, law_of
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import Field, Keys, fields_of
from burridge_knopoff.model.initial import PAPER_STATES, STATE_NAME, InitialState, has_paper_numbers, initial_state
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.running.cost import cost_note, is_stiff
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.values import elements, is_sequence

#: An initial state: minus or plus, an `InitialState`, {"position": …, "velocity": …}, or (position, velocity).
Initial = str | InitialState | Mapping[str, Any] | Sequence[Sequence[float]] | np.ndarray

#: A law: a `Law`, the name of a built-in law, or {"formula": …} or {"law": …} with its numbers, as in a config.
GivenLaw = Law | str | Mapping[str, Any]

#: The name of a state that is given without a name.
OWN = "own"

_KEYS = Keys({"name": Field(STATE_NAME, "name of the state", OWN), **fields_of(InitialState)})
_FORMS = f"{' | '.join(PAPER_STATES)}, InitialState, {{'position': …, 'velocity': …}}, or (position, velocity)"


def given_state(initial: Initial) -> InitialState:
    """Return an initial state from any of its forms.

    Raises ValueError, one line, for anything else, and for other values under one of the paper's names.
    """
    state = initial if isinstance(initial, InitialState) else _state(initial)
    if state.name in PAPER_STATES and not has_paper_numbers(state):
        raise refusal("initial.name", state.name, "another name: the paper has a different state of that name")
    return state


def _state(initial: str | Mapping[str, Any] | Sequence[Sequence[float]] | np.ndarray) -> InitialState:
    if isinstance(initial, str):
        return initial_state(initial)
    if isinstance(initial, Mapping):
        return InitialState(**_KEYS.form(initial, "initial"))
    pair = elements(initial) or []
    if len(pair) != 2 or not all(map(is_sequence, pair)):
        raise ValueError(f"initial: got {format_value(initial)}, expected {_FORMS}, with one number per block")
    return InitialState(**_KEYS.form(dict(zip(("position", "velocity"), pair, strict=True)), "initial"))


def given_model(
    law: Model | GivenLaw,
    a: float | None,
    blocks: int | None,
    chain: Chain | None,
    v: float | None,
    contact: str | None,
) -> Model:
    """Return a model as it is, or the model of a law and the other arguments.

    blocks : number of blocks without a chain; None if it is not known
    Raises ValueError, one line, for a wrong argument, and for arguments together with a model, which has its own.
    """
    if isinstance(law, Model):
        if any(option is not None for option in (a, chain, v, contact)):
            raise ValueError(
                "a, chain, v, contact: got some together with a model, expected none: the model has its own"
            )
        return law
    if a is None:
        raise ValueError("a: got None without a Model, expected a number of at least 0")
    if isinstance(law, Mapping):
        law = law_of(law.get("law", "formula"), a, law)
    if chain is None and blocks is None:
        raise ValueError("chain: missing, expected a Chain for an initial state that does not fix the number of blocks")
    chain = Chain(blocks) if chain is None else chain  # type: ignore[arg-type]
    options: dict[str, Any] = {name: value for name, value in (("v", v), ("contact", contact)) if value is not None}
    return Model(chain, law.at(a) if isinstance(law, Law) else law_of(law, a), **options)


def warn_of_cost(model: Model, initial: InitialState | ChainState, settings: Settings) -> None:
    """Warn of a run of more than a minute whose step is set by stiff dashpots or springs, before it starts."""
    if is_stiff(model.chain):
        begun = initial if isinstance(initial, ChainState) else model.begin(initial, settings.start)
        if note := cost_note(model, begun, settings):
            warnings.warn(note, stacklevel=3)
