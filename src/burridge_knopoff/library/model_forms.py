"""The forms in which users give a model: a `Model`, or a law and a with everything else by name."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from types import MappingProxyType
from typing import Any

from burridge_knopoff.laws import LAWS, Law, law_of, unknown_law
from burridge_knopoff.library.keyword_settings import divide, has_own_a
from burridge_knopoff.messages import format_value, full_key, suggestion
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.fields import fields_of
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import (
    CHAIN_PARAMETERS,
    format_parameter_names,
    parameter_key,
    parse_indexed_name,
)
from burridge_knopoff.values import is_sequence

#: A law: a `Law`, the name of a built-in law, or {"formula": …} or {"law": …} with its numbers, as in a config.
GivenLaw = Law | str | Mapping[str, Any]


def model_of(
    law: Model | GivenLaw,
    a: float | None = None,
    *,
    chain: Chain | None = None,
    blocks: int | None = None,
    contact: str | None = None,
    state_blocks: int | None = 3,
    parameters: Mapping[str, Any] = MappingProxyType({}),
    settings: Iterable[str] = (),
) -> Model:
    """Return the model of a law at a, or a model at other values of some parameters.

    law, a : a `Model`, a `Law`, both with their own a, or a law in another form and its a
    chain, blocks : a chain, or a number of blocks of a plain row; by default a row of `state_blocks`, None if not known
    contact : see `Model`
    parameters : further ones by name, as in `Model.at`: v, those of the law and of the chain; None for the model's own
    settings : names of the settings of the call, for messages

    Raises ValueError, one line, for a wrong argument, and for a chain, blocks or contact together with a model, which
    has its own.
    """
    values = {name: value for name, value in parameters.items() if value is not None}
    for name, value in values.items():
        if name in fields_of(Chain) and (name not in CHAIN_PARAMETERS or is_sequence(value)):
            raise ValueError(f"{name}: got {format_value(value)}, expected it in a chain: chain=Chain(…, {name}=…)")
    if isinstance(law, Model):
        for name, value in (("chain", chain), ("blocks", blocks), ("contact", contact)):
            if value is not None:
                raise ValueError(f"{name}: got {format_value(value)} together with a model, which has its own")
        _check_names(law, values, settings)
        return law.at(**(values if a is None else {"a": a, **values}))
    of_chain = {name for name in values if name == "v" or parameter_key(name) in CHAIN_PARAMETERS}
    of_law = {name: value for name, value in values.items() if name not in of_chain}
    made = _law_at(law, a, of_law, settings)
    if chain is not None and blocks is not None:
        raise ValueError(f"blocks: got {format_value(blocks)} together with a chain, which has its own")
    if chain is None:
        number = state_blocks if blocks is None else blocks
        if number is None:
            raise ValueError("blocks: missing, expected a number, which the initial state does not fix, or a chain")
        chain = Chain(number)
    model = Model(chain, made) if contact is None else Model(chain, made, contact=contact)
    others = {name: value for name, value in values.items() if name in of_chain}
    _check_names(model, others, settings)
    return model.at(**others)


def model_and_settings(
    kind: type, law: Model | GivenLaw, a: Any, by_name: Mapping[str, Any], *, v: float | None, **shape: Any
) -> tuple[Model, dict[str, Any]]:
    """Return the model of a call, and the settings of a class among its arguments by name; the others are parameters.

    shape : further arguments of `model_of`, which raises the same errors
    """
    named, parameters = divide(by_name, kind)
    return model_of(law, a, **shape, parameters={"v": v, **parameters}, settings=fields_of(kind)), named


def _law_at(law: GivenLaw, a: float | None, numbers: Mapping[str, Any], settings: Iterable[str]) -> Law:
    """Return a law at a, with these values of its other parameters."""
    if isinstance(law, Law):
        for name in numbers:
            if name not in law.parameters:
                raise _unknown_name(name, ("a", *law.parameters, "v", *CHAIN_PARAMETERS), settings)
        return law.at(a, **numbers)
    if not isinstance(law, str | Mapping):
        raise unknown_law("law", law, '{{"formula": "{}"}}')
    if a is None and not has_own_a(law):
        raise ValueError("a: got None without a Model or a Law, expected a number of at least 0")
    if isinstance(law, Mapping):
        return law_of({**law, **numbers}, a)
    if isinstance(law, str) and law in LAWS:
        for name in numbers:
            if name not in LAWS[law].defaults:
                raise _unknown_name(name, ("a", *LAWS[law].defaults, "v", *CHAIN_PARAMETERS), settings)
    return law_of(law, a, numbers)


def _check_names(model: Model, names: Iterable[str], settings: Iterable[str]) -> None:
    for name in names:
        if name not in model.parameter_names and parse_indexed_name(name) is None:
            raise _unknown_name(name, model.parameter_names, settings)


def _unknown_name(name: str, parameters: Iterable[str], settings: Iterable[str]) -> ValueError:
    allowed = [*parameters, *sorted(settings)]
    return ValueError(
        f"{full_key('', name)}: not a setting or a parameter, expected "
        f"{' | '.join([format_parameter_names(parameters), *sorted(settings)])}{suggestion(name, allowed)}"
    )
