"""Numbers as the scripts of the page need them: as JSON inside HTML."""

from __future__ import annotations

import json
import math
from typing import Any

from markupsafe import Markup

from burridge_knopoff.study.formatting import text


def exact(value: float) -> float | str | None:
    """Return a number as it is, infinities as text and NaN as None: JSON knows neither."""
    value = float(value)
    if math.isinf(value):
        return text(value)
    return None if math.isnan(value) else value


def embedded_json(data: Any) -> Markup:
    """Return JSON that can stand in a script element: nothing in it can end the element or begin a comment.

    Raises ValueError where a number is not finite.
    """
    plain = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    for character in "<>&\u2028\u2029":
        plain = plain.replace(character, f"\\u{ord(character):04x}")
    return Markup(plain)
