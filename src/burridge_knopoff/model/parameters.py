"""The parameters of a model: every number that a study may vary, by its name.

They are a and the law's own numbers, the driver velocity v, and the numbers of the chain: of all its springs or blocks
(`mass`), or of one of them (`mass[3]`). Blocks are numbered from 1. Springs are too: spring i of a row or a ring joins
blocks i and i + 1, and the last one of a ring joins the last block to the first.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from burridge_knopoff.model.chain import BLOCK_NUMBERS, NEIGHBOURS, SPRING_NUMBERS
from burridge_knopoff.values import joined, real_number, refusal

if TYPE_CHECKING:
    from burridge_knopoff.model.chain import Chain
    from burridge_knopoff.model.model import Model

#: Parameters of the chain, and the range of each number.
CHAIN = {**SPRING_NUMBERS, **BLOCK_NUMBERS}

ONE = "one number for the whole chain"

_SINGLE = re.compile(rf"({'|'.join(CHAIN)})\[(0|[1-9][0-9]*)\]")


def names_of(model: Model) -> tuple[str, ...]:
    """Return the names of the parameters of a model: those of its law, of the driver and of the whole chain."""
    return ("a", *model.law.parameters, "v", *CHAIN)


def words_of(model: Model) -> str:
    """Return the names of the parameters of a model for a message."""
    return f"{' | '.join(names_of(model))}, or one block or spring, as mass[1]"


def single_of(name: Any) -> tuple[str, int] | None:
    """Return the key of the chain and the number, from 1, of the spring or block that a name such as `mass[3]` means.

    None for any other name.
    """
    found = _SINGLE.fullmatch(name) if isinstance(name, str) else None
    return (found[1], int(found[2])) if found else None


def plain_name(name: str) -> str:
    """Return the name of a parameter in letters, digits and underscores, as dimensions and file names have it.

    >>> from burridge_knopoff.model.parameters import plain_name
    >>> plain_name("mass[3]"), plain_name("sigma")
    ('mass_3', 'sigma')
    """
    single = single_of(name)
    return f"{single[0]}_{single[1]}" if single else name


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

    `pulling` may be a number in place of `neighbours`. A number for one spring or block, as `mass[3]`, makes the chain
    have one for each; it takes precedence over one for all. Raises ValueError, one line, for a name that is no
    parameter of the model, a value out of range, and a parameter for the whole chain that has a number for each spring
    or block.
    """
    changes: dict[str, dict[str, Any]] = {"law": {}, "chain": {}, "single": {}, "driver": {}}
    for name, value in parameters.items():
        given = _given(model, name)
        if not isinstance(given, float) and given != NEIGHBOURS:
            raise refusal(name, given, ONE)
        if real_number(value) != real_number(value):
            raise refusal(name, value, "a number")
        single = single_of(name)
        part = "single" if single else "driver" if name == "v" else "chain" if name in CHAIN else "law"
        changes[part][name] = CHAIN[single[0]].form(value, name) if single else value
    own: dict[str, Any] = {**changes["driver"]}
    if changes["law"]:
        own["law"] = model.law.at(changes["law"].pop("a", None), **changes["law"])
    if changes["chain"] or changes["single"]:
        own["chain"] = _with_singles(replace(model.chain, **changes["chain"]), changes["single"])
    return replace(model, **own)


def _with_singles(chain: Chain, values: Mapping[str, float]) -> Chain:
    """Return a chain at other values of the numbers of some springs and blocks."""
    numbers: dict[str, Any] = {}
    for name, value in values.items():
        key, number = single_of(name)  # type: ignore[misc]
        numbers.setdefault(key, chain.numbers_of(key).tolist())[number - 1] = value
    return replace(chain, **numbers) if numbers else chain


def _given(model: Model, name: str) -> Any:
    """Return a parameter in the form in which the model has it."""
    single = single_of(name)
    if single:
        return _single(model.chain, name, *single)
    names = names_of(model)
    if name not in names:
        raise ValueError(f"{joined('', name)}: not a parameter of this model, expected {words_of(model)}")
    if names.count(name) > 1:
        raise ValueError(f"{name}: got a number of the law {model.law.name} and one of the model, expected one of them")
    if name in CHAIN:
        return getattr(model.chain, name)
    return {"a": model.a, "v": model.v, **model.law.parameters}[name]


def _single(chain: Chain, name: str, key: str, number: int) -> float:
    """Return the number of one spring or block, by its name and the parts of it."""
    count, of = chain.count_of(key), "spring" if key in SPRING_NUMBERS else "block"
    if key in SPRING_NUMBERS and chain.is_network:
        raise ValueError(f"{name}: got one spring of a network, expected {key}: only rows and rings number them")
    if not 1 <= number <= count:
        allowed = f"1 to {count}" if count else "none: a single block has no neighbour"
        raise ValueError(f"{name}: got {of} {number}, expected {allowed}")
    return float(chain.numbers_of(key)[number - 1])
