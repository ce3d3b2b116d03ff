"""Arguments of the library: settings by name, shown for completion in notebooks, and where a may be left out."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Mapping
from dataclasses import replace
from functools import wraps
from typing import Any, TypeVar

from burridge_knopoff.laws import Law
from burridge_knopoff.laws.formula import formula_names
from burridge_knopoff.messages import full_key, suggestion
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.model import Model
from burridge_knopoff.values import elements, instance_of, is_sequence, real_number

_F = TypeVar("_F", bound=Callable[..., Any])
_T = TypeVar("_T")


def takes_model(function: _F) -> _F:
    """Return a function of law and a that takes a model as well, also by its name, and does without a.

    After a `Model` or a `Law`, which have their own a, a state or settings may follow at once. A law that has a
    parameter of the same name as an argument that is given is refused: either may be meant.
    """
    names = inspect.signature(function).parameters

    @wraps(function)
    def call(*arguments: Any, **by_name: Any) -> Any:
        if "model" in by_name:
            by_name["law"] = by_name.pop("model")
        for law in arguments[:1] or [by_name.get("law")]:
            for name in _numbers(law) & by_name.keys() & names.keys():
                raise ValueError(
                    f"{name}: got a parameter of the law with the name of a setting, expected another name"
                )
        if len(arguments) > 1:
            has_a = "a" not in by_name and _can_be_a(arguments[1], has_own_a(arguments[0]))
            arguments = arguments if has_a else (arguments[0], by_name.pop("a", None), *arguments[1:])
        return function(*arguments, **by_name)

    return call  # type: ignore[return-value]


def has_own_a(law: Any) -> bool:
    """Return whether a law needs no a beside it: a `Model`, a `Law`, or a formula without a."""
    is_formula = isinstance(law, Mapping) and isinstance(law.get("formula"), str)
    return isinstance(law, Model | Law) or (is_formula and "a" not in formula_names(law["formula"]))


def _numbers(law: Any) -> set[str]:
    """Return the names of the parameters of a law or of a list of laws, in any form."""
    if is_sequence(law):
        return {name for item in law for name in _numbers(item)}
    law = law.law if isinstance(law, Model) else law
    return {*(law if isinstance(law, Mapping) else law.parameters if isinstance(law, Law) else ())}


def _can_be_a(value: Any, is_optional: bool) -> bool:
    """Return whether an argument is meant for a: None, a number, or a sequence that begins with a number.

    is_optional : whether a may be missing; an empty sequence is then something else
    """
    items = elements(value)
    if items is None:
        return value is None or real_number(value) == real_number(value) or not is_optional
    return real_number(items[0]) == real_number(items[0]) if items else not is_optional


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
            raise ValueError(
                f"{full_key('', name)}: not a setting, expected {' | '.join(sorted(names))}{suggestion(name, names)}"
            )
    return kind(**by_name) if settings is None else replace(settings, **by_name)  # type: ignore[type-var]
