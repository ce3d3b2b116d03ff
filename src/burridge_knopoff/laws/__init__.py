"""Friction laws: the built-in ones, one file each, and laws given by a formula."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from burridge_knopoff.laws.carlson_langer import CarlsonLanger
from burridge_knopoff.laws.exponential import Exponential
from burridge_knopoff.laws.law import FormulaLaw, Law
from burridge_knopoff.laws.linearized import Linearized
from burridge_knopoff.laws.nonlinear import Nonlinear
from burridge_knopoff.laws.stribeck import Stribeck
from burridge_knopoff.messages import cut, refusal, suggestion

__all__ = ["LAWS", "FormulaLaw", "Law", "law_of"]

#: The built-in laws by name.
LAWS: Mapping[str, type[Law]] = {
    "linearized": Linearized,
    "nonlinear": Nonlinear,
    "carlson_langer": CarlsonLanger,
    "exponential": Exponential,
    "stribeck": Stribeck,
}


#: A law as in a config, see `law_of`.
Description = Mapping[str, Any]


def law_of(
    name: str | Description, a: float | None = None, description: Description | None = None, **parameters: Any
) -> Law:
    """Return a friction law by name, at a value of a, which a formula without a does not need.

    name : or, in its place, the description of a law without a name of its own
    parameters : those of the law other than a, such as sigma
    description : the same as a mapping, as in a config: for a law given by a formula, `formula` and its parameters; for
        a built-in law, its parameters, and `law`, the name of the built-in law, if `name` is a different one

    Raises ValueError if there is no such law, or if the law does not accept these parameters.

    The built-in laws are linearized and nonlinear (the paper's), carlson_langer, exponential and stribeck. Formulas and
    sources are in the modules of `burridge_knopoff.laws`.

    >>> from burridge_knopoff import law_of
    >>> law_of("carlson_langer", 0.5, sigma=0.02)
    <law carlson_langer: (1 - sigma)/(1 + a*u/(1 - sigma)), a=0.5, sigma=0.02>
    >>> law_of("mine", 0.5, formula="(1 - drop)*exp(-a*u)", drop=0.02).name
    'mine'
    >>> law_of({"formula": "1/(1 + a*u)"}, 0.5)
    <law formula: 1/(1 + a*u), a=0.5>
    """
    if not isinstance(description, Mapping | None):
        raise refusal("description", description, "a mapping with the parameters of a law, and its formula if any")
    if isinstance(name, Mapping):
        return law_of(name.get("law", "formula"), a, {**name, **(description or {})}, **parameters)
    values = dict(description or {})
    for key in values.keys() & parameters.keys():
        raise ValueError(f"{key}: got two values, expected one")
    values |= parameters
    if "name" in values:
        raise ValueError(f"{name}.name: not a parameter of a law")
    if "formula" in values:
        if "law" in values:
            raise ValueError(f"{name}: got law and formula, expected one of them")
        return FormulaLaw(a, values.pop("formula"), name=name, **values)
    kind = values.pop("law", name)
    if not isinstance(kind, str) or kind not in LAWS:
        raise unknown_law("law", kind, '{{"formula": "{}"}}')
    return LAWS[kind](a, name=name, **values)


def unknown_law(key: str, name: Any, way: str = 'NAME: {{formula: "{}"}}') -> ValueError:
    """Return the error for a name that is not that of a built-in law: the closest name, or how to give a formula.

    way : how a formula is given, with {} in its place; by default in a config
    """
    formula = cut(name) if isinstance(name, str) and re.search(r"\bu\b", name) else "1 - a*u"
    hint = suggestion(name, LAWS) or f": {way.format(formula)}"
    return refusal(key, name, f"{' | '.join(LAWS)}, or a formula{hint}")
