"""The parameters of a model: every number that a study may vary, by its name.

They are a and the other parameters of the law, the driver velocity v, and the parameters of the chain, either of all
its springs or blocks (`mass`) or of one of them (`mass[3]`). Blocks and springs are numbered from 1. Spring i of a row
or a ring joins blocks i and i + 1; the last spring of a ring joins the last block to the first. In a grid,
`coupling[1]` belongs to all springs along rows, and `coupling[2]` to those along columns.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Mapping
from dataclasses import replace
from functools import lru_cache
from typing import Any

from burridge_knopoff.model.chain import BLOCK_PARAMETERS, SPRING_PARAMETERS, Chain
from burridge_knopoff.model.initial import InitialState, PaperState

#: Parameters of the chain, with their ranges.
CHAIN_PARAMETERS = {**SPRING_PARAMETERS, **BLOCK_PARAMETERS}

#: Parameters that scale velocities, distances or times, so that the same numbers are another state relative to them.
SCALES = {"v", "coupling", "pulling", "threshold", "mass"}

_INDEXED_NAME = re.compile(rf"({'|'.join(CHAIN_PARAMETERS)})\[(0|[1-9][0-9]*)\]")
_PLAIN_NAME = re.compile(rf"^({'|'.join(CHAIN_PARAMETERS)})_([0-9]+)$")


def format_parameter_names(names: Iterable[str]) -> str:
    """Return the names of the parameters of a model, see `Model.parameter_names`, for a message."""
    return f"{' | '.join(names)}, or one block or spring, such as mass[1]"


def parse_indexed_name(name: Any) -> tuple[str, int] | None:
    """Return the key and the number of the spring or block, from 1, of a name such as `mass[3]`.

    Returns None for any other name.
    """
    return _parse(name) if isinstance(name, str) else None


@lru_cache(maxsize=256)
def _parse(name: str) -> tuple[str, int] | None:
    match = _INDEXED_NAME.fullmatch(name)
    return (match[1], int(match[2])) if match else None


def parameter_key(name: str) -> str:
    """Return the key of a parameter: `mass` for `mass` and for `mass[3]`."""
    single = parse_indexed_name(name)
    return single[0] if single else name


def plain_name(name: str) -> str:
    """Return the name of a parameter with letters, digits and underscores only, for dimensions and file names.

    >>> from burridge_knopoff.model.parameters import plain_name
    >>> plain_name("mass[3]"), plain_name("sigma")
    ('mass_3', 'sigma')
    """
    single = parse_indexed_name(name)
    return f"{single[0]}_{single[1]}" if single else name


def full_name(name: str) -> str:
    """Return the name of a parameter from its `plain_name`: `mass[3]` for `mass_3`; any other name as it is."""
    return _PLAIN_NAME.sub(r"\1[\2]", name)


def chain_parameter(chain: Chain, name: str) -> Any:
    """Return a parameter of a chain as it is stored: a number, several numbers or a word.

    Raises ValueError, one line, for a spring or a block that the chain does not have.
    """
    single = parse_indexed_name(name)
    if not single:
        return getattr(chain, name)
    key, number = single
    count, of = chain.parameter_count(key), "spring" if key in SPRING_PARAMETERS else "block"
    if key in SPRING_PARAMETERS and chain.springs:
        raise ValueError(f"{name}: got one spring of a network, expected {key}: only rows and rings number springs")
    if key in SPRING_PARAMETERS and chain.grid:
        of = "direction"
    if not 1 <= number <= count:
        allowed = f"1 to {count}" if count else "none, as a single block has no neighbour"
        raise ValueError(f"{name}: got {of} {number}, expected {allowed}")
    return float(chain.parameter_values(key)[number - 1])


def set_chain_parameters(chain: Chain, values: Mapping[str, Any]) -> Chain:
    """Return a chain with other values of some of its parameters.

    A value for one spring or block, such as `mass[3]`, takes precedence over a value for all of them. Raises
    ValueError, one line, for a value out of range.
    """
    numbers: dict[str, Any] = {}
    changed = replace(chain, **{name: value for name, value in values.items() if not parse_indexed_name(name)})
    for name, value in values.items():
        if single := parse_indexed_name(name):
            chain_parameter(changed, name)
            key, number = single
            of_all = numbers.setdefault(key, changed.parameter_values(key).tolist())
            of_all[number - 1] = CHAIN_PARAMETERS[key].form(value, name)
    return replace(changed, **numbers) if numbers else changed


def remarks_on_states(states: Iterable[InitialState], varied: Iterable[str]) -> list[str]:
    """Return a line for the initial states whose numbers are the same while parameters vary that scale the motion.

    varied : names of the parameters that vary
    """
    scales = [name for name in varied if parameter_key(name) in SCALES]
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
