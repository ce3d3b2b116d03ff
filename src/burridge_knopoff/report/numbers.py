"""Numbers of the page, and JSON inside HTML."""

from __future__ import annotations

import json
import math
from typing import Any

from markupsafe import Markup

from burridge_knopoff.study.formatting import text, with_error

#: A number below this, without an error, is one of the order of rounding errors.
ROUNDING = 1e-9


def json_number(value: float) -> float | str | None:
    """Return a finite number unchanged, an infinity as text and NaN as None, since JSON has neither."""
    value = float(value)
    if math.isinf(value):
        return text(value)
    return None if math.isnan(value) else value


def embedded_json(data: Any) -> Markup:
    """Return JSON for a script element: nothing in it can end the element or start a comment.

    Raises ValueError if a number is not finite.
    """
    plain = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    for character in "<>&\u2028\u2029":
        plain = plain.replace(character, f"\\u{ord(character):04x}")
    return Markup(plain)


def format_measured(value: Any, error: Any) -> str:
    """Format a measured number with its error, and a rounding error with one digit."""
    if error is None and isinstance(value, float) and 0.0 < abs(value) < ROUNDING:
        return text(float(f"{value:.0e}"))
    return with_error(value, error)
