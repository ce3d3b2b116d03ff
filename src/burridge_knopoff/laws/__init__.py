"""Friction laws: the built-in ones, one file each, and laws given by a formula."""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any

from burridge_knopoff.laws.carlson_langer import CarlsonLanger
from burridge_knopoff.laws.exponential import Exponential
from burridge_knopoff.laws.law import FormulaLaw, Law, check_names
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


#: A law: a `Law`, the name of a built-in law, or a description as in a config.
GivenLaw = Law | str | Mapping[str, Any]


def law_of(law: GivenLaw, *others: Any, **parameters: Any) -> Law:
    """Return a friction law, with these values of its parameters.

    law : a `Law`; the name of a built-in law; or a description as in a config: {"formula": …} or {"law": NAME} with
        values of parameters, or with a name of its own, {NAME: {"formula": …}}
    parameters : by their names; others, without a name, are refused

    Raises ValueError, one line, if there is no such law, or if the law does not accept these parameters.

    The built-in laws are linearized and nonlinear (the paper's), carlson_langer, exponential and stribeck. Formulas and
    sources are in the modules of `burridge_knopoff.laws`. A parameter without a default, such as a, may be left open.

    >>> from burridge_knopoff import law_of
    >>> law_of("carlson_langer", a=0.5, sigma=0.02)
    <law carlson_langer: (1 - sigma)/(1 + a*u/(1 - sigma)), a=0.5, sigma=0.02>
    >>> law_of({"mine": {"formula": "(1 - drop)*exp(-a*u)", "drop": 0.02}}, a=0.5).name
    'mine'
    >>> law_of({"formula": "1/(1 + u/10)"})
    <law formula: 1/(1 + u/10)>
    """
    check_names(others)
    if isinstance(law, Law):
        return law.at(**parameters) if parameters else law
    description: Mapping[str, Any] = {"law": law} if isinstance(law, str) else law
    if not isinstance(description, Mapping):
        raise unknown_law("law", law, '{{"formula": "{}"}}')
    values, name = dict(description), None
    if len(values) == 1 and isinstance(next(iter(values.values())), Mapping):
        ((name, values),) = values.items()
        values = dict(values)
        if not values.keys() & {"law", "formula"}:
            values["law"] = name
    if "name" in values:
        raise ValueError(f"{name or 'law'}.name: not a parameter of a law")
    for key in values.keys() & parameters.keys():
        raise ValueError(f"{key}: got two values, expected one")
    values |= parameters
    if "formula" in values:
        if "law" in values:
            raise ValueError(f"{name or 'law'}: got law and formula, expected one of them")
        return FormulaLaw(values.pop("formula"), name=name or "formula", **values)
    kind = values.pop("law", None)
    if not isinstance(kind, str) or kind not in LAWS:
        raise unknown_law("law", kind, '{{"formula": "{}"}}')
    return LAWS[kind](name=name or kind, **values)


def unknown_law(key: str, name: Any, way: str = 'NAME: {{formula: "{}"}}') -> ValueError:
    """Return the error for a name that is not that of a built-in law: the closest name, or how to give a formula.

    way : how a formula is given, with {} in its place; by default in a config
    """
    formula = cut(name) if isinstance(name, str) and re.search(r"\bu\b", name) else "1 - a*u"
    hint = suggestion(name, LAWS) or f": {way.format(formula)}"
    return refusal(key, name, f"{' | '.join(LAWS)}, or a formula{hint}")
