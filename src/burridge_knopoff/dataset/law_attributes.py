"""What the global attributes of a file say of its friction law."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from burridge_knopoff.laws.formula import formula_names


def has_a(attributes: Mapping[str, Any]) -> bool:
    """Return whether the law that attributes describe contains a, or may contain it."""
    return "a" in formula_names(attributes.get("law_formula", "a"))
