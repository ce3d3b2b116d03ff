"""What pictures say of the model: names of its parameters, and in titles the numbers that are not the paper's."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from typing import Any

import numpy as np
import xarray

from burridge_knopoff.dataset.law_attributes import has_a
from burridge_knopoff.dataset.variables import TIMES
from burridge_knopoff.laws import LAWS
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.initial import PAPER_V
from burridge_knopoff.model.model import Model
from burridge_knopoff.model.parameters import CHAIN_PARAMETERS, full_name, parameter_key

GREEK = ("alpha", "beta", "gamma", "delta", "epsilon", "eta", "theta", "kappa", "mu", "nu", "sigma", "tau", "phi")

#: The numbers of the paper's model other than a.
PAPER = {"v": PAPER_V, **{name: getattr(Chain, name) for name in CHAIN_PARAMETERS}}

# Coordinates of runs that are numbers, but no parameters of the model.
_OF_RUNS = {"batch", "level", "trajectory_time", *TIMES.values()}


def symbol(name: str) -> str:
    """Return the name of a parameter for mathematical text: a Latin or Greek letter slanted, a word upright."""
    if name in GREEK:
        return f"\\{name}"
    return name if len(name) == 1 else r"\mathrm{" + full_name(name).replace("_", r"\_") + "}"


def parameter_words(name: str, value: float) -> str:
    """Return a parameter with its value for a title: «a = 0.1» as a formula, «coupling 1.5» in words."""
    is_letter = len(name) == 1 or name in GREEK
    return f"${symbol(name)}={value:g}$" if is_letter else f"{full_name(name).replace('_', ' ')} {value:g}"


def model_title(model: Model, axes: Collection[str] = ()) -> str:
    """Return the title of a picture of one model: its law, a, and the numbers that are not the paper's.

    axes : names of the parameters on the axes of the picture, which are left out
    """
    law = dict(model.law.parameters)
    numbers = {**{key: law.pop(key) for key in ("a",) if key in law}, "v": model.v, **law}
    numbers |= {name: getattr(model.chain, name) for name in CHAIN_PARAMETERS}
    return ", ".join([f"{model.law.name} law", *_words(numbers, [model.law.defaults], axes)])


def friction_parameter(run: xarray.Dataset) -> list[str]:
    """Return a of a run for a title, «a = 0.1» as a formula; none under a law without a."""
    return [parameter_words("a", run["a"].item())] if has_a(run.attrs) else []


def fixed_numbers(data: xarray.Dataset, axes: Collection[str] = ()) -> list[str]:
    """Return what a title says of a Dataset: a, if it is the same everywhere, and the numbers that are not the paper's.

    axes : as for `model_title`
    """
    numbers = {"v": data.attrs["v"]} if "v" in data.attrs else {}
    for key, value in data.attrs.items():
        part, _, name = str(key).partition("_")
        if (part == "chain" and name in CHAIN_PARAMETERS) or (part == "law" and name and name != "formula"):
            numbers[name] = value
    for key, item in data.coords.items():
        name = full_name(f"{key}")
        if item.size != 1:
            numbers.pop(name, None)
        elif item.dtype.kind == "f" and key not in _OF_RUNS and {*item.dims} <= {key}:
            numbers[name] = item.item()
    if not has_a(data.attrs):
        numbers.pop("a", None)
    laws = np.atleast_1d(constant(data, "law")).tolist()
    return _words(numbers, [LAWS[law].defaults if law in LAWS else {} for law in laws], axes)


def constant(data: xarray.Dataset, name: str) -> np.ndarray:
    """Return the values of a coordinate; without it, of the attribute of that name, which files may have instead."""
    return data[name].values if name in data.coords else np.array(data.attrs.get(name, ""))


def _words(numbers: Mapping[str, Any], defaults: Sequence[Mapping[str, float]], axes: Collection[str]) -> list[str]:
    """Return the words for a, v, parameters of the law and of the chain, if not the paper's nor defaults of the law."""
    words = []
    for name, value in sorted(numbers.items(), key=lambda item: _order(item[0])):
        usual: list[Any] = [of_law[name] for of_law in defaults if name in of_law] or [PAPER.get(parameter_key(name))]
        if np.ndim(value):
            of_blocks = {f"{name}[{k}]": item for k, item in enumerate(value, 1) if item != usual[0]}
            others = [(key, item) for key, item in of_blocks.items() if key not in axes]
            words += [f"{name} not uniform"] if len(others) > 1 else [parameter_words(*item) for item in others]
        elif name not in axes and any(value != number for number in usual):
            # Random numbers are described by a mapping or, in a file, by a text.
            is_number = isinstance(value, int | float | np.number)
            words.append(parameter_words(name, value) if is_number else f"{name} not uniform")
    return words


def _order(name: str) -> tuple[bool, bool, bool]:
    return name != "a", name != "v", parameter_key(name) in CHAIN_PARAMETERS
