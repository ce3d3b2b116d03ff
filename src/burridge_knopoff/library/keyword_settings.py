"""Settings by name, for type checkers, editors and completion in notebooks."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from typing import Any, TypedDict, TypeVar

from burridge_knopoff.messages import full_key, suggestion
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.running.section import Section
from burridge_knopoff.values import instance_of

_F = TypeVar("_F", bound=Callable[..., Any])
_T = TypeVar("_T")


class RunSettings(TypedDict, total=False):
    """The settings of a run by name: the fields of `Settings`, which has their ranges, defaults and descriptions."""

    start: str
    solver: str
    step: float
    transient: float
    window: float
    batches: int
    sampling: float
    trajectory: float
    trajectory_sampling: float
    events: str
    event_window: float
    section: Section
    lyapunov_exponents: int
    lyapunov_alignment: float


class SearchOptions(TypedDict, total=False):
    """Settings of a search by name: fields of `SearchSettings`, with their ranges, defaults and descriptions."""

    fraction_width: float
    position: Sequence[float]
    velocity: Sequence[float]
    transient: float
    window: float
    time_limit: float
    resolution: float
    perturbations: int
    lifetime: float


class AttractorOptions(SearchOptions, total=False):
    """All settings of a search by name: also the number of sampled initial states, and their seed."""

    samples: int
    seed: int


def show_settings(kind: type) -> Callable[[_F], _F]:
    """Return a decorator that replaces `**` in the signature of a function by the settings of a class."""

    def decorate(function: _F) -> _F:
        signature = inspect.signature(function)
        named = [item for item in signature.parameters.values() if item.kind is not inspect.Parameter.VAR_KEYWORD]
        settings = [
            inspect.Parameter(
                name, inspect.Parameter.KEYWORD_ONLY, default=field.default, annotation=type(field.default).__name__
            )
            for name, field in fields_of(kind).items()
            if name not in signature.parameters
        ]
        function.__signature__ = signature.replace(parameters=[*named, *settings])  # type: ignore[attr-defined]
        return function

    return decorate


def settings_of(kind: type[_T], settings: _T | None, by_name: Mapping[str, Any]) -> _T:
    """Return settings of a class, with the values given by name; raises ValueError, one line, for other names."""
    if settings is not None:
        instance_of(settings, kind, "settings")
    names = fields_of(kind)
    for name in by_name:
        if name not in names:
            raise ValueError(
                f"{full_key('', name)}: not a setting, expected {' | '.join(sorted(names))}{suggestion(name, names)}"
            )
    return kind(**by_name) if settings is None else replace(settings, **by_name)  # type: ignore[type-var]
