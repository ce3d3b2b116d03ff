"""Laws derived from other laws: the linear interpolation between two laws, and a law with its slope reversed."""

from __future__ import annotations

import re

from burridge_knopoff.laws.law import FormulaLaw, Law


class CompositeLaw(FormulaLaw):
    """A law whose formula is composed of other formulas, and may be longer than the formula of a user."""

    max_length = 100_000


def blend(first: Law, second: Law, share: float) -> CompositeLaw:
    """Return the law (1 − share) Φ₁ + share Φ₂ for two laws at the same a.

    share : 0 gives the first law, 1 the second

    Raises ValueError for laws at different values of a, and as `Law` does.
    """
    if first.a != second.a:
        raise ValueError(f"a: got {second.a!r}, expected {first.a!r}, as in the first law")
    formula = f"{1.0 - share!r}*({_substituted_formula(first)}) + {share!r}*({_substituted_formula(second)})"
    return CompositeLaw(first.a, formula, name="blend")


def mirror_law(law: Law, speed: float) -> CompositeLaw:
    """Return the law 2 Φ(speed) − Φ, which has the same friction at this speed and the opposite slope.

    Raises ValueError if the result is not a friction law; see `Law`.
    """
    return CompositeLaw(law.a, f"{2.0 * float(law(speed))!r} - ({_substituted_formula(law)})", name="mirrored")


def _substituted_formula(law: Law) -> str:
    """Return the formula of a law with the values of its parameters in place of their names."""

    def number(name: re.Match[str]) -> str:
        return f"({law.parameters[name[0]]!r})" if name[0] in law.parameters else name[0]

    return re.sub(r"\b[a-zA-Z_]\w*", number, law.formula)
