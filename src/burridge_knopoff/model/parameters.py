"""The parameters of a model: every number that a study may vary, by its name.

They are a and the law's own numbers, the driver velocity v, and the numbers of the chain that hold for all of its
springs or blocks.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from burridge_knopoff.model.chain import NEIGHBOURS
from burridge_knopoff.values import joined, real_number, refusal

if TYPE_CHECKING:
    from burridge_knopoff.model.model import Model

#: Parameters of the chain.
CHAIN = ("coupling", "pulling", "threshold", "mass", "damping", "pulling_damping")

ONE = "one number for the whole chain"


def names_of(model: Model) -> tuple[str, ...]:
    """Return the names of the parameters of a model: those of its law, of the driver and of the chain."""
    return ("a", *model.law.numbers, "v", *CHAIN)


def value_of(model: Model, name: str) -> float:
    """Return the value of a parameter.

    Raises ValueError, one line, if the model has no parameter of this name, or several numbers in its place.
    """
    given = _given(model, name)
    number = real_number(given)
    if number != number:
        raise refusal(name, given, ONE)
    return number


def at(model: Model, parameters: Mapping[str, float]) -> Model:
    """Return the same model at other values of some of its parameters.

    `pulling` may be a number in place of `neighbours`. Raises ValueError, one line, for a name that is no parameter of
    the model, a value out of range, and a parameter of the chain that has a number for each spring or block.
    """
    changes: dict[str, dict[str, Any]] = {"law": {}, "chain": {}, "driver": {}}
    for name, value in parameters.items():
        given = _given(model, name)
        if not isinstance(given, float) and given != NEIGHBOURS:
            raise refusal(name, given, ONE)
        if real_number(value) != real_number(value):
            raise refusal(name, value, "a number")
        part = "driver" if name == "v" else "chain" if name in CHAIN else "law"
        changes[part][name] = value
    own: dict[str, Any] = {**changes["driver"]}
    if changes["law"]:
        own["law"] = model.law.at(changes["law"].pop("a", None), **changes["law"])
    if changes["chain"]:
        own["chain"] = replace(model.chain, **changes["chain"])
    return replace(model, **own)


def _given(model: Model, name: str) -> Any:
    """Return a parameter in the form in which the model has it."""
    names = names_of(model)
    if name not in names:
        raise ValueError(f"{joined('', name)}: not a parameter of this model, expected {' | '.join(names)}")
    if names.count(name) > 1:
        raise ValueError(f"{name}: got a number of the law {model.law.name} and one of the model, expected one of them")
    if name in CHAIN:
        return getattr(model.chain, name)
    return {"a": model.a, "v": model.v, **model.law.numbers}[name]
