"""Settings in the arguments of the library: by name, shown for completion in notebooks, or as one object."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterable, Mapping
from dataclasses import replace
from typing import Any, TypeVar

from burridge_knopoff.messages import full_key, suggestion
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.values import instance_of

_F = TypeVar("_F", bound=Callable[..., Any])
_T = TypeVar("_T")


def divide(by_name: Mapping[str, Any], kind: type) -> tuple[dict[str, Any], dict[str, Any]]:
    """Return the settings of a class among arguments by name, and the other arguments."""
    names = fields_of(kind)
    settings = {name: value for name, value in by_name.items() if name in names}
    return settings, {name: value for name, value in by_name.items() if name not in names}


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
            raise unknown_setting(name, sorted(names))
    return kind(**by_name) if settings is None else replace(settings, **by_name)  # type: ignore[type-var]


def unknown_setting(name: str, names: Iterable[str]) -> ValueError:
    """Return the error for an argument by name that is not among `names`; one that a model has belongs there."""
    if name in ("a", "v", "contact", "law", "chain", *fields_of(Chain)):
        return ValueError(f"{name}: not a setting, expected it in the model: Model(…, {name}=…)")
    return ValueError(f"{full_key('', name)}: not a setting, expected {' | '.join(names)}{suggestion(name, names)}")
