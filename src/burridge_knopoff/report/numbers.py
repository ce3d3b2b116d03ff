"""Numbers for the scripts of the page: JSON inside HTML."""

from __future__ import annotations

import json
import math
from typing import Any

from markupsafe import Markup

from burridge_knopoff.study.formatting import text


def exact(value: float) -> float | str | None:
    """Return a number unchanged, an infinity as text and NaN as None, since JSON has neither."""
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
