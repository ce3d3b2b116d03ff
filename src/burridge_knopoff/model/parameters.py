"""The parameters of a model: every number that a study may vary, by its name.

They are a and the other parameters of the law, the driver velocity v, and the parameters of the chain, either of all
its springs or blocks (`mass`) or of one of them (`mass[3]`). Blocks and springs are numbered from 1. Spring i of a row
or a ring joins blocks i and i + 1; the last spring of a ring joins the last block to the first.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from typing import TYPE_CHECKING, Any

from burridge_knopoff.messages import full_key, refusal
from burridge_knopoff.model.chain import BLOCK_PARAMETERS, NEIGHBOURS, SPRING_PARAMETERS
from burridge_knopoff.model.initial import InitialState, PaperState
from burridge_knopoff.values import real_number

if TYPE_CHECKING:
    from burridge_knopoff.model.chain import Chain
    from burridge_knopoff.model.model import Model

#: Parameters of the chain, with their ranges.
CHAIN_PARAMETERS = {**SPRING_PARAMETERS, **BLOCK_PARAMETERS}

#: Parameters that scale velocities, distances or times, so that the same numbers are another state relative to them.
SCALES = {"v", "coupling", "pulling", "threshold", "mass"}

ONE = "one number for the whole chain"

_INDEXED_NAME = re.compile(rf"({'|'.join(CHAIN_PARAMETERS)})\[(0|[1-9][0-9]*)\]")


def parameter_names(model: Model) -> tuple[str, ...]:
    """Return the names of the parameters of the law, the driver and the whole chain."""
    return ("a", *model.law.parameters, "v", *CHAIN_PARAMETERS)


def format_parameter_names(model: Model) -> str:
    """Return the names of the parameters of a model, for a message."""
    return f"{' | '.join(parameter_names(model))}, or one block or spring, such as mass[1]"


def parse_indexed_name(name: Any) -> tuple[str, int] | None:
    """Return the key and the number of the spring or block, from 1, of a name such as `mass[3]`.

    Returns None for any other name.
    """
    match = _INDEXED_NAME.fullmatch(name) if isinstance(name, str) else None
    return (match[1], int(match[2])) if match else None


def plain_name(name: str) -> str:
    """Return the name of a parameter with letters, digits and underscores only, for dimensions and file names.

    >>> from burridge_knopoff.model.parameters import plain_name
    >>> plain_name("mass[3]"), plain_name("sigma")
    ('mass_3', 'sigma')
    """
    single = parse_indexed_name(name)
    return f"{single[0]}_{single[1]}" if single else name


def parameter_value(model: Model, name: str) -> float:
    """Return the value of a parameter.

    Raises ValueError, one line, if the model has no parameter of this name, or several values for it.
    """
    value = _stored_value(model, name)
    number = real_number(value)
    if number != number:
        raise refusal(name, value, ONE)
    return number


def parameter_scale(model: Model, name: str) -> float:
    """Return the natural size of a parameter, whatever its value, which may be 0.

    It is the chain's own unit for a parameter of the chain, 1 for one of the law, and 0 for v, whose size is its value.
    """
    units, key = model.chain.own_units, (parse_indexed_name(name) or (name,))[0]
    if name in model.law.parameters:
        return 1.0
    if key == "threshold":
        return units.force
    if key == "mass":
        return units.force / units.acceleration
    if key in CHAIN_PARAMETERS:
        return units.force / (units.velocity if key in ("damping", "pulling_damping") else units.length)
    return 0.0


def set_parameters(model: Model, parameters: Mapping[str, float]) -> Model:
    """Return the same model at other values of some of its parameters.

    `pulling` may be a number in place of `neighbours`. A value for one spring or block, such as `mass[3]`, takes
    precedence over a value for all of them. Raises ValueError, one line, for a name that is not a parameter of the
    model, a value out of range, and a parameter of the whole chain that has several values.
    """
    changes: dict[str, dict[str, Any]] = {"law": {}, "chain": {}, "single": {}, "driver": {}}
    for name, value in parameters.items():
        stored = _stored_value(model, name)
        if not isinstance(stored, float) and stored != NEIGHBOURS:
            raise refusal(name, stored, ONE)
        if real_number(value) != real_number(value):
            raise refusal(name, value, "a number")
        single = parse_indexed_name(name)
        part = "single" if single else "driver" if name == "v" else "chain" if name in CHAIN_PARAMETERS else "law"
        changes[part][name] = CHAIN_PARAMETERS[single[0]].form(value, name) if single else value
    arguments: dict[str, Any] = {**changes["driver"]}
    if changes["law"]:
        arguments["law"] = model.law.at(changes["law"].pop("a", None), **changes["law"])
    if changes["chain"] or changes["single"]:
        arguments["chain"] = _set_indexed_parameters(replace(model.chain, **changes["chain"]), changes["single"])
    return replace(model, **arguments)


def remarks_on_states(states: Iterable[InitialState], varied: Iterable[str]) -> list[str]:
    """Return a line for the initial states whose numbers are the same while parameters vary that scale the motion.

    varied : names of the parameters that vary
    """
    scales = [name for name in varied if (parse_indexed_name(name) or (name,))[0] in SCALES]
    names: dict[tuple[str, ...], list[str]] = {}
    for state in states:
        ignored = tuple(name for name in scales if name != "v" or not isinstance(state, PaperState))
        names.setdefault(ignored, []).append(state.name)
    return [
        f"initial: {', '.join(group)}: {'in proportion to v, but ' * (set(ignored) < set(scales))}the same numbers at "
        f"every {' and '.join(ignored)}"
        for ignored, group in names.items()
        if ignored
    ]


def _set_indexed_parameters(chain: Chain, values: Mapping[str, float]) -> Chain:
    """Return a chain with other values at some springs and blocks."""
    numbers: dict[str, Any] = {}
    for name, value in values.items():
        key, number = parse_indexed_name(name)  # type: ignore[misc]
        numbers.setdefault(key, chain.parameter_values(key).tolist())[number - 1] = value
    return replace(chain, **numbers) if numbers else chain


def _stored_value(model: Model, name: str) -> Any:
    """Return a parameter as the model stores it: a number, several numbers or a word."""
    single = parse_indexed_name(name)
    if single:
        return _indexed_value(model.chain, name, *single)
    names = parameter_names(model)
    if name not in names:
        raise ValueError(
            f"{full_key('', name)}: not a parameter of this model, expected {format_parameter_names(model)}"
        )
    if names.count(name) > 1:
        raise ValueError(f"{name}: got a parameter of both the law {model.law.name} and the model, expected only one")
    if name in CHAIN_PARAMETERS:
        return getattr(model.chain, name)
    return {"a": model.a, "v": model.v, **model.law.parameters}[name]


def _indexed_value(chain: Chain, name: str, key: str, number: int) -> float:
    """Return the value at one spring or block; `key` and `number` are the parts of its name."""
    count, of = chain.parameter_count(key), "spring" if key in SPRING_PARAMETERS else "block"
    if key in SPRING_PARAMETERS and chain.is_network:
        raise ValueError(f"{name}: got one spring of a network, expected {key}: only rows and rings number springs")
    if not 1 <= number <= count:
        allowed = f"1 to {count}" if count else "none, as a single block has no neighbour"
        raise ValueError(f"{name}: got {of} {number}, expected {allowed}")
    return float(chain.parameter_values(key)[number - 1])
