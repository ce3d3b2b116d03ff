"""Numbers of the page, and JSON inside HTML."""

from __future__ import annotations

import json
import math
import re
from typing import Any

from markupsafe import Markup

from burridge_knopoff.study.formatting import MINUS, text, with_error

#: A number below this is one of the order of rounding errors.
ROUNDING = 1e-9

#: Significant digits of a measured number without an error.
DIGITS = 4

# A number in the notation of computers; the factor 1 is left out.
_EXPONENT = re.compile(r"(?<![\w.])(?:1(?=e)|(\d[\d.]*|\([^()]*\)))e([-−+]?)0*(\d+)(?!\w)")
_SUPERSCRIPTS = str.maketrans("-−0123456789", "⁻⁻⁰¹²³⁴⁵⁶⁷⁸⁹")


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


def with_powers_of_ten(words: str) -> str:
    """Write numbers in words, such as 2.1e-15, with a power of ten: 2.1 × 10⁻¹⁵."""

    def power(match: re.Match[str]) -> str:
        exponent = f"10{(match[2].strip('+') + match[3]).translate(_SUPERSCRIPTS)}"
        return f"{match[1]}\N{NO-BREAK SPACE}×\N{NO-BREAK SPACE}{exponent}" if match[1] else exponent

    return _EXPONENT.sub(power, words)


def format_measured(value: Any, error: Any = None, digits: int = DIGITS) -> str:
    """Format a measured number with its error, or without one with so many digits; at the level of rounding it is 0."""
    if isinstance(value, float) and math.isfinite(value):
        if max(abs(value), error or 0.0) < ROUNDING:
            return "0"
        if error is None and abs(value) < 10.0**digits:
            return with_powers_of_ten(f"{value:.{digits}g}".replace("-", MINUS))
    return with_powers_of_ten(with_error(value, error))
