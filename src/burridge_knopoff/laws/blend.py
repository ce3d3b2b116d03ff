"""Laws made of others: the linear interpolation between two laws, and the mirror image of a law at a speed."""

from __future__ import annotations

import re

from burridge_knopoff.laws.law import FormulaLaw, Law


class MadeLaw(FormulaLaw):
    """A law whose formula is composed of other formulas, and may be longer than one that a user gives."""

    longest = 100_000


def blend(first: Law, second: Law, share: float) -> MadeLaw:
    """Return the law (1 − share) Φ₁ + share Φ₂ for two laws at the same a.

    share : 0 gives the first law, 1 the second

    Raises ValueError for laws at different a, and as `Law` does.
    """
    if first.a != second.a:
        raise ValueError(f"a: got {second.a!r}, expected that of the first law, {first.a!r}")
    formula = f"{1.0 - share!r}*({_with_numbers(first)}) + {share!r}*({_with_numbers(second)})"
    return MadeLaw(first.a, formula, name="blend")


def mirrored(law: Law, speed: float) -> MadeLaw:
    """Return the law 2 Φ(speed) − Φ, with the same friction at that speed and the opposite slope.

    Raises ValueError if the result is not a friction law, see `Law`.
    """
    return MadeLaw(law.a, f"{2.0 * float(law(speed))!r} - ({_with_numbers(law)})", name="mirrored")


def _with_numbers(law: Law) -> str:
    """Return the formula of a law with the values of its numbers in place of their names."""

    def number(name: re.Match[str]) -> str:
        return f"({law.numbers[name[0]]!r})" if name[0] in law.numbers else name[0]

    return re.sub(r"\b[a-zA-Z_]\w*", number, law.formula)
