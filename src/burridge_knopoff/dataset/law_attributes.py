"""What the global attributes of a file say of its friction law."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from burridge_knopoff.laws.formula import formula_names

if TYPE_CHECKING:
    from burridge_knopoff.laws.law import Law


def without_a(laws: Sequence[Law]) -> dict[str, str]:
    """Return what tells `has_a` that none of the laws of a file contains a: the formula of the first."""
    return {} if any("a" in law.names for law in laws) else {"law_formula": laws[0].formula}


def has_a(attributes: Mapping[str, Any]) -> bool:
    """Return whether the law that attributes describe contains a, or may contain it."""
    return "a" in formula_names(attributes.get("law_formula", "a"))
