"""The analyses of a model and its states, for the forms in which the library takes models and states."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from burridge_knopoff.attractors import labels
from burridge_knopoff.basins import edge_state as edges
from burridge_knopoff.catalogue import stability
from burridge_knopoff.laws import Law
from burridge_knopoff.library import catalogue
from burridge_knopoff.library.keyword_settings import divide, settings_of, takes_model
from burridge_knopoff.library.model_forms import GivenLaw, model_of
from burridge_knopoff.library.state_forms import begun_state, state_blocks
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import STARTS, ChainState, Model
from burridge_knopoff.motion import chain_synchronization, frequency, modes
from burridge_knopoff.motion import limit_cycle as cycles
from burridge_knopoff.motion import synchronized_orbit as synchrony
from burridge_knopoff.periodic_orbits import hopf, periodic
from burridge_knopoff.values import is_sequence

_T = TypeVar("_T")

_MODEL = """
    In place of a model: a law, a, chain, blocks, v, contact, and other parameters by name, as for `simulate`.
"""
_STATE = """    {} : also an initial state, which begins as `start` says (`Model.begin`), or a `Run`: its `final`
"""


def _of_law(function: Callable[..., _T], *states: str) -> Callable[..., _T]:
    """Return a function of a model that takes a law as well, and its states in all forms.

    states : names of the arguments of `function` that are each a `ChainState`
    """
    signature = inspect.signature(function)
    names = list(signature.parameters)[1:]
    default = signature.parameters["settings"].default if "settings" in names else None

    @takes_model
    @wraps(function, assigned=("__name__", "__qualname__"))
    def call(law: Model | GivenLaw, a: float | None = None, *others: Any, **by_name: Any) -> _T:
        if names[:1] == ["interval"] and isinstance(law, Model | Law) and is_sequence(a):
            a, others = None, (a, *others)
        own = signature.bind_partial(None, *others, **{name: by_name.pop(name) for name in names if name in by_name})
        begin = {"start": by_name.pop("start", "moving")} if states else {}
        if isinstance(begin.get("start"), ChainState):
            raise ValueError(f"start: got a ChainState, expected {' | '.join(STARTS)}: a state is now state=")
        if "loading" in names:
            begin["loading"] = own.arguments.get("loading", signature.parameters["loading"].default)
        given = own.arguments
        if default:
            named, by_name = divide(by_name, type(default))
            given["settings"] = settings_of(type(default), given.get("settings", default), named)
        model = model_of(
            law,
            a,
            **{name: by_name.pop(name, None) for name in ("chain", "blocks", "contact")},
            state_blocks=next((state_blocks(given[name], name) for name in states if name in given), 3),
            parameters=by_name,
            settings=names,
        )
        for name in states:
            if name in given:
                given[name] = begun_state(model, given[name], name, **begin)
        return function(**{**given, "model": model})

    optional = {
        "a": float | None,
        "chain": Chain | None,
        "blocks": int | None,
        "v": float | None,
        "contact": str | None,
    }
    added = [_keyword(name, None, kind) for name, kind in optional.items()]
    if states:
        added.append(_keyword("start", "moving", str))
    parameters = inspect.Parameter("parameters", inspect.Parameter.VAR_KEYWORD, annotation=Any)
    shown = signature.replace(parameters=[*signature.parameters.values(), *added, parameters])
    call.__signature__ = shown  # type: ignore[attr-defined]
    text, mark, examples = str(function.__doc__).partition(">>> ")
    added_text = _MODEL + "".join(_STATE.format(name) for name in states)
    call.__doc__ = f"{text.rstrip()}\n{added_text}\n    {mark}{examples}"
    call.__module__ = __name__
    return call


def _keyword(name: str, default: Any, kind: Any) -> inspect.Parameter:
    return inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind)


synchronized_orbit = _of_law(synchrony.synchronized_orbit)
limit_cycle = _of_law(cycles.limit_cycle, "state")
find_periodic_orbit = _of_law(periodic.find_periodic_orbit, "guess")
hopf_bifurcations = _of_law(hopf.hopf_bifurcations)
edge_state = _of_law(edges.edge_state, "state_a", "state_b")
transverse_exponent = _of_law(chain_synchronization.transverse_exponent, "state")
block_frequencies = _of_law(frequency.block_frequencies, "state")
mode_amplitudes = _of_law(modes.mode_amplitudes, "state")
record_events = _of_law(catalogue.record_events, "state")
event_exponents = _of_law(stability.event_exponents, "state")
event_multipliers = _of_law(stability.event_multipliers, "state")
label_states = _of_law(labels.label_states)
