"""The analyses of a model for states in all forms of the library, and settings by name."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import wraps
from typing import Any, TypeVar

from burridge_knopoff.attractors import labels
from burridge_knopoff.basins import edge_state as edges
from burridge_knopoff.catalogue import stability
from burridge_knopoff.library import catalogue
from burridge_knopoff.library.keyword_settings import divide, settings_of, show_settings, unknown_setting
from burridge_knopoff.library.state_forms import begun_state
from burridge_knopoff.model.model import STARTS, ChainState, Model
from burridge_knopoff.motion import chain_synchronization, frequency, modes
from burridge_knopoff.motion import limit_cycle as cycles
from burridge_knopoff.motion import synchronized_orbit as synchrony
from burridge_knopoff.periodic_orbits import hopf, periodic
from burridge_knopoff.values import instance_of

_T = TypeVar("_T")

_STATE = """    {} : also an initial state, which begins as `start` says (`Model.begin`), or a `Run`: its `final`
"""


def _of_states(function: Callable[..., _T], *states: str) -> Callable[..., _T]:
    """Return a function of a model that takes its states in all forms, and the settings that it has also by name.

    states : names of the arguments of `function` that are each a `ChainState`
    """
    signature = inspect.signature(function)
    settings = signature.parameters["settings"].default if "settings" in signature.parameters else None

    @wraps(function, assigned=("__name__", "__qualname__"))
    def call(*arguments: Any, **by_name: Any) -> _T:
        start = by_name.pop("start", "moving") if states else "moving"
        if isinstance(start, ChainState):
            raise ValueError(f"start: got a ChainState, expected {' | '.join(STARTS)}: a state is state=")
        named, by_name = divide(by_name, type(settings)) if settings is not None else ({}, by_name)
        instance_of(arguments[0] if arguments else by_name.get("model"), Model, "model")
        for name in by_name.keys() - signature.parameters.keys():
            raise unknown_setting(name, signature.parameters)
        given = signature.bind(*arguments, **by_name)
        given.apply_defaults()
        values = given.arguments
        if settings is not None:
            values["settings"] = settings_of(type(settings), values["settings"], named)
        model = values["model"]
        if states:
            model.law.check_complete()
        loading = {"loading": values["loading"]} if "loading" in values else {}
        for name in states:
            values[name] = begun_state(model, values[name], name, start=start, **loading)
        return function(**values)

    option = inspect.Parameter("start", inspect.Parameter.KEYWORD_ONLY, default="moving", annotation=str)
    call.__signature__ = signature.replace(  # type: ignore[attr-defined]
        parameters=[*signature.parameters.values(), *([option] if states else [])]
    )
    if settings is not None:
        call = show_settings(type(settings))(call)
    text, mark, examples = str(function.__doc__).partition(">>> ")
    call.__doc__ = f"{text.rstrip()}\n\n{''.join(_STATE.format(name) for name in states)}\n    {mark}{examples}"
    call.__module__ = __name__
    return call


limit_cycle = _of_states(cycles.limit_cycle, "state")
find_periodic_orbit = _of_states(periodic.find_periodic_orbit, "guess")
edge_state = _of_states(edges.edge_state, "state_a", "state_b")
transverse_exponent = _of_states(chain_synchronization.transverse_exponent, "state")
block_frequencies = _of_states(frequency.block_frequencies, "state")
mode_amplitudes = _of_states(modes.mode_amplitudes, "state")
record_events = _of_states(catalogue.record_events, "state")
event_exponents = _of_states(stability.event_exponents, "state")
event_multipliers = _of_states(stability.event_multipliers, "state")
synchronized_orbit = _of_states(synchrony.synchronized_orbit)
hopf_bifurcations = _of_states(hopf.hopf_bifurcations)
label_states = _of_states(labels.label_states)
