"""Friction laws: the built-in ones, one file each, and laws given by a formula."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.laws.carlson_langer import CarlsonLanger
from burridge_knopoff.laws.exponential import Exponential
from burridge_knopoff.laws.law import FormulaLaw, Law
from burridge_knopoff.laws.linearized import Linearized
from burridge_knopoff.laws.nonlinear import Nonlinear
from burridge_knopoff.laws.stribeck import Stribeck
from burridge_knopoff.values import refusal

__all__ = ["LAWS", "FormulaLaw", "Law", "law_of"]

#: The built-in laws by name.
LAWS: Mapping[str, type[Law]] = {
    "linearized": Linearized,
    "nonlinear": Nonlinear,
    "carlson_langer": CarlsonLanger,
    "exponential": Exponential,
    "stribeck": Stribeck,
}


def law_of(name: str, a: float, description: Mapping[str, Any] | None = None) -> Law:
    """Return a friction law by its name, at one a.

    description : for a law by formula, `formula` and its numbers; for a built-in law, its numbers, and `law`, the name
        of the built-in law, if `name` is another one

    Raises ValueError if there is no such law, or if it refuses its numbers.

    Built-in laws are linearized and nonlinear (the paper's), carlson_langer, exponential and stribeck. Their modules in
    `burridge_knopoff.laws` give formula and source.

    >>> from burridge_knopoff import law_of
    >>> law_of("carlson_langer", 0.5, {"sigma": 0.02})
    <law carlson_langer: (1 - sigma)/(1 + a*u/(1 - sigma)), a=0.5, sigma=0.02>
    >>> law_of("mine", 0.5, {"formula": "(1 - drop)*exp(-a*u)", "drop": 0.02}).name
    'mine'
    """
    if not isinstance(description, Mapping | None):
        raise refusal("description", description, "the numbers of a law by name, and its formula")
    values = dict(description or {})
    if "name" in values:
        raise ValueError(f"{name}.name: not a number of a law")
    if "formula" in values:
        if "law" in values:
            raise ValueError(f"{name}: got law and formula, expected one of them")
        return FormulaLaw(a, values.pop("formula"), name=name, **values)
    kind = values.pop("law", name)
    if not isinstance(kind, str) or kind not in LAWS:
        raise refusal("law", kind, f"{' | '.join(LAWS)}, or a formula")
    return LAWS[kind](a, name=name, **values)
