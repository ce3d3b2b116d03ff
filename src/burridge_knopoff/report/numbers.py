"""Numbers as a reader and as a script of the page need them: rounded, with errors, and as JSON inside HTML."""

from __future__ import annotations

import json
import math
from decimal import Decimal
from typing import Any

import numpy as np
from markupsafe import Markup

#: Significant digits of curves; exact values are kept for the single runs only.
DIGITS = 6
#: A number with this many digits or more has been cut to them; one with fewer is likely to be meant as it is.
STORED_DIGITS = 9

MINUS = "\u2212"


def rounded(values: Any) -> Any:
    """Return numbers, or an array of any shape as nested lists, with DIGITS significant digits; None if not finite."""
    array = np.asarray(values)
    if array.ndim:
        return [rounded(item) for item in array]
    value = array.item()
    if isinstance(value, float):
        return float(f"{value:.{DIGITS}g}") if math.isfinite(value) else None
    return value


def exact(value: float) -> float | str | None:
    """Return a number as it is, infinities as text and NaN as None: JSON knows neither."""
    value = float(value)
    if math.isinf(value):
        return "∞" if value > 0 else f"{MINUS}∞"
    return None if math.isnan(value) else value


def text(value: Any) -> str:
    """Return a number as text with DIGITS significant digits, anything else as it is; a dash if there is nothing."""
    if value is None:
        return "–"
    if isinstance(value, bool) or not isinstance(value, int | float | np.number):
        return str(value)
    if math.isnan(value):
        return "–"
    if math.isinf(value):
        return str(exact(float(value)))
    return f"{value:.{DIGITS}g}".replace("-", MINUS)


def with_error(value: Any, error: Any) -> str:
    """Return value ± error, the error with two significant digits and the value with as many decimals.

    An error of just three digits, half of a step of a grid, keeps them. A value that was stored with fewer digits than
    its error asks for gets none that it does not have. Without an error, or with one that is 0, the value alone.
    """
    numbers = [isinstance(item, int | float) and not isinstance(item, bool) for item in (value, error)]
    if not all(numbers) or not math.isfinite(value) or not math.isfinite(error) or error <= 0.0:
        return text(value)
    digits = 2 if math.isclose(float(f"{error:.2e}"), error) and not math.isclose(float(f"{error:.1e}"), error) else 1
    decimals = digits - math.floor(math.log10(float(f"{error:.{digits}e}")))
    stored = Decimal(repr(float(value))).as_tuple()
    if len(stored.digits) >= STORED_DIGITS and isinstance(stored.exponent, int):
        decimals = min(decimals, -stored.exponent)
    if 0 <= decimals <= 6 or (decimals > 6 and abs(value) >= 1e-3):
        shown = f"{value:z.{decimals}f} ± " + (f"{error:.{decimals}f}" if decimals <= 6 else f"{error:.{digits}e}")
    elif decimals < 0:
        shown = f"{round(value, decimals):z.0f} ± {round(error, decimals):.0f}"
    else:
        # Small numbers share the power of ten of the value.
        power = math.floor(math.log10(max(abs(value), error)))
        places = max(0, decimals + power)
        shown = f"({value / 10**power:z.{places}f} ± {error / 10**power:.{places}f})e{power}"
    return shown.replace("-", MINUS)


def embedded_json(data: Any) -> Markup:
    """Return JSON that can stand in a script element: nothing in it can end the element or begin a comment.

    Raises ValueError where a number is not finite.
    """
    plain = json.dumps(data, separators=(",", ":"), ensure_ascii=False, allow_nan=False)
    for character in "<>&\u2028\u2029":
        plain = plain.replace(character, f"\\u{ord(character):04x}")
    return Markup(plain)
