"""Laws made of others: on the straight line between two of them, and the mirror image of one at a speed."""

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


def mirrored(law: Law, speed: float) -> FormulaLaw:
    """Return the law 2 Φ(speed) − Φ, which has the same friction at that speed and the slope reversed.

    Raises ValueError where that is no friction law, see `Law`.
    """
    return FormulaLaw(law.a, f"{2.0 * float(law(speed))!r} - ({_with_numbers(law)})", name="mirrored")


def _with_numbers(law: Law) -> str:
    """Return the formula of a law with its numbers in the place of their names."""
    return re.sub(r"\b[a-zA-Z_]\w*", lambda name: repr(law.numbers.get(name[0], name[0])).strip("'"), law.formula)
