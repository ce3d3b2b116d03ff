"""The grid of a study: lists of numbers and ranges for each of its parameters, and their names in file names."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from decimal import Decimal
from typing import Any

from burridge_knopoff.laws.formula import formula_names
from burridge_knopoff.messages import format_value, refusal
from burridge_knopoff.model.parameters import plain_name

#: Limit on the values of a list and on the points of a study. Snakemake plans so many jobs in minutes, or in seconds if
#: each job makes a chunk of points.
MAXIMUM_POINTS = 100_000

#: Names that a parameter of a grid cannot have, since wildcards or dimensions have them.
_RESERVED = ("law", "initial", "solver", "chunk", "exponent")


def resolve_grid(config: Mapping[str, Any]) -> Mapping[str, Any]:
    """Return a config as given, with either `a` or `grid`; a grid of a alone becomes `a`.

    If no law has a in its formula, a may be missing, and is 0.

    Raises ValueError, one line, if it has both or neither, or a grid without a.
    """
    grid = config.get("grid")
    if _lacks_a(config.get("laws")):
        if grid and isinstance(grid, Mapping):
            config = {**config, "grid": (grid := {"a": [0.0], **grid})}
        elif not grid:
            config = {"a": [0.0], **config}
    if not grid and "a" not in config:
        raise ValueError("a: missing, expected friction parameters, or a grid of several parameters")
    if not (grid and isinstance(grid, Mapping)):
        return config
    # A complete config has an empty list.
    if config.get("a", []) != []:
        raise ValueError(f"a: got {format_value(config['a'])} together with grid, expected one of them")
    if "a" not in grid:
        raise ValueError("grid.a: missing, expected friction parameters; a single one is enough")
    plain = [plain_name(f"{name}") for name in grid]
    for name in plain:
        if name in _RESERVED or plain.count(name) > 1:
            raise refusal("grid", name, "another name for the law's parameter")
    others = {key: value for key, value in config.items() if key not in ("a", "grid")}
    return {**others, "grid": grid} if len(grid) > 1 else {**others, "a": grid["a"]}


def _lacks_a(laws: Any) -> bool:
    """Return whether all laws of a config are formulas without a."""
    if not (laws and isinstance(laws, Mapping)):
        return False
    formulas = [item.get("formula") if isinstance(item, Mapping) else None for item in laws.values()]
    return all(isinstance(text, str) and "a" not in formula_names(text) for text in formulas)


def parameters_of(config: Mapping[str, Any]) -> dict[str, dict[str, float]]:
    """Return {parameter: {name: value}} of a config; a alone unless it has a `grid`, whose order is kept."""
    lists = {name: (f"grid.{name}", items) for name, items in config["grid"].items()} or {"a": ("a", config["a"])}
    return {name: _named(name, *listed, config["a_digits"]) for name, listed in lists.items()}


def _named(parameter: str, place: str, items: Sequence[Any], digits: int) -> dict[str, float]:
    """Return {name: value} in ascending order; every value is the double nearest to its decimal.

    Raises ValueError as `values_of` does, and for values with the same name.
    """
    grid: dict[str, float] = {}
    for value in values_of(items, place):
        name = f"{value:.{digits}f}"
        if name in grid:
            raise ValueError(
                f"{place}: got {grid[name]!r} and {value!r}, which share the file name {parameter}{name}.nc; expected "
                "values that differ within a_digits decimals"
            )
        grid[name] = value
    return grid


def values_of(items: Sequence[Any], place: str) -> list[float]:
    """Return the numbers and the values of the ranges in a list, each value once, in ascending order.

    Raises ValueError, one line that starts with the place, for too many values.
    """
    values: set[float] = set()
    for position, item in enumerate(items):
        # Adding 0 turns -0.0 into 0.0.
        values.update([float(item) + 0.0] if not isinstance(item, dict) else _range(item, f"{place}[{position}]"))
        if len(values) > MAXIMUM_POINTS:
            raise ValueError(f"{place}: got more than {MAXIMUM_POINTS} values, expected at most that many")
    return sorted(values)


def _range(item: Mapping[str, float], place: str) -> list[float]:
    first, last, step = (Decimal(repr(item[key])) for key in ("from", "to", "step"))
    if last < first:
        raise refusal(f"{place}.to", item["to"], f"at least from ({item['from']!r})")
    count = (last - first) / step
    if count >= MAXIMUM_POINTS:
        raise refusal(f"{place}.step", item["step"], f"at most {MAXIMUM_POINTS} values in a range")
    if count != int(count):
        raise refusal(f"{place}.step", item["step"], f"one that divides the range {item['from']!r} to {item['to']!r}")
    return [float(first + step * k) for k in range(int(count) + 1)]
