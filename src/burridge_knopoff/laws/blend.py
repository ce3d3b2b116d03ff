"""A law between two others, on the straight line along which a motion under one is followed to the other."""

from __future__ import annotations

import re

from burridge_knopoff.laws.law import FormulaLaw, Law


def blend(first: Law, second: Law, share: float) -> FormulaLaw:
    """Return the law (1 − share) Φ₁ + share Φ₂ of two laws at the same a.

    share : 0 is the first law, 1 the second

    Raises ValueError for laws at different a, and as `Law` does.
    """
    if first.a != second.a:
        raise ValueError(f"a: {second.a!r} is not allowed: that of the first law, {first.a!r}")
    formula = f"{1.0 - share!r}*({_with_numbers(first)}) + {share!r}*({_with_numbers(second)})"
    return FormulaLaw(first.a, formula, name="blend")


def _with_numbers(law: Law) -> str:
    """Return the formula of a law with its numbers in the place of their names."""
    return re.sub(r"\b[a-zA-Z_]\w*", lambda name: repr(law.numbers.get(name[0], name[0])).strip("'"), law.formula)
