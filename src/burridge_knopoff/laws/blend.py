"""Laws derived from other laws: the linear interpolation between two laws, and a law with its slope reversed."""

from __future__ import annotations

import re

from burridge_knopoff.laws.law import FormulaLaw, Law, recorded_a


class CompositeLaw(FormulaLaw):
    """A law whose formula is composed of other formulas, and may be longer than the formula of a user."""

    max_length = 100_000


def blend(first: Law, second: Law, share: float) -> CompositeLaw:
    """Return the law (1 − share) Φ₁ + share Φ₂ for two laws at the same a.

    share : 0 gives the first law, 1 the second

    Raises ValueError for laws at different values of a, and as `Law` does.
    """
    values = [recorded_a(law) for law in (first, second)]
    if values[0] != values[1]:
        raise ValueError(f"a: got {values[1]!r}, expected {values[0]!r}, as in the first law")
    formula = f"{1.0 - share!r}*({_substituted_formula(first)}) + {share!r}*({_substituted_formula(second)})"
    return CompositeLaw(formula, name="blend", **(_a_of(first) | _a_of(second)))


def mirror_law(law: Law, speed: float) -> CompositeLaw:
    """Return the law 2 Φ(speed) − Φ, which has the same friction at this speed and the opposite slope.

    Raises ValueError if the result is not a friction law; see `Law`.
    """
    formula = f"{2.0 * float(law(speed))!r} - ({_substituted_formula(law)})"
    return CompositeLaw(formula, name="mirrored", **_a_of(law))


def _a_of(law: Law) -> dict[str, float]:
    return {name: value for name, value in law.parameters.items() if name == "a"}


def _substituted_formula(law: Law) -> str:
    """Return the formula of a law with the values of its parameters but a in place of their names."""

    def number(name: re.Match[str]) -> str:
        return f"({law.parameters[name[0]]!r})" if name[0] in law.parameters and name[0] != "a" else name[0]

    return re.sub(r"\b[a-zA-Z_]\w*", number, law.formula)
