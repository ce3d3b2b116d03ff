"""Springs between all blocks of a row, a ring or a grid: their strength is a formula of the distance."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import numpy as np

from burridge_knopoff.laws.formula import FormulaError, compile_formula
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import FOLLOWS, Field, Keys
from burridge_knopoff.model.ranges import Number, Text
from burridge_knopoff.values import number_in

PREFIX = "distance="
#: Most springs in a network: a run with so many takes 30 GB of memory.
MOST_SPRINGS = 50_000_000

KEYS = Keys(
    {
        "distance": Field(Text("a formula", "[^,=]+"), "a formula of the distance r for the strength of a spring"),
        "cut_off": Field(Number(1.0, 1e6), "distance beyond which there are no springs", FOLLOWS),
    }
)


def distance_form(value: Any, key: str) -> str | None:
    """Return the form of springs by distance, such as `distance=9/r**3,cut_off=5.0`; None if the value is none.

    value : {distance: formula, cut_off: number}, or this form. Raises ValueError, one line, for wrong keys or formulas
    """
    if isinstance(value, str) and value.startswith(PREFIX):
        value = _parse(value)
    if not isinstance(value, Mapping):
        return None
    keys = KEYS.form(value, key)
    try:
        compile_formula(keys["distance"], {}, "r")
    except FormulaError as error:
        raise ValueError(f"{key}.distance: {error}") from None
    return ",".join(f"{name}={item}" for name, item in keys.items())


def is_by_distance(springs: str | None) -> bool:
    """Return whether springs follow a formula of the distance."""
    return springs is not None and springs.startswith(PREFIX)


def _parse(text: str) -> dict[str, Any]:
    parts = (part.partition("=") for part in text.split(","))
    return {name: value if name == "distance" else number_in(value) or value for name, _, value in parts}


def springs_by_distance(
    springs: str, columns: int, rows: int, is_ring: bool, strength: Number
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the springs: the two blocks (0 …) that each spring joins, and its strength, shape (springs,).

    The distance of neighbours is 1. In a ring it is measured along the ring, the shorter way: it is the arc, not the
    chord.

    springs : in the form of `distance_form`; strength : the allowed range

    Raises ValueError, one line, for too many springs and for strengths out of range.
    """
    keys = _parse(springs)
    cut_off = keys.get("cut_off", np.inf)
    parts = []
    # Half of the steps (dx, dy) from a block to others: the other half joins the same pairs.
    reach = int(min(cut_off, max(columns, rows)))
    steps = [
        (dx, dy)
        for dy in range(min(reach, rows - 1) + 1)
        for dx in range(-min(reach, columns - 1), min(reach, columns - 1) + 1)
        if (dy > 0 or dx > 0) and dx * dx + dy * dy <= cut_off**2
    ]
    if is_ring:
        steps = [(dx, 0) for dx, _ in steps if 2 * dx <= columns]
    count = sum((columns - (0 if is_ring else abs(dx))) * (rows - dy) for dx, dy in steps)
    if count > MOST_SPRINGS:
        raise ValueError(f"chain.springs: got {count:.2g} springs, expected at most {MOST_SPRINGS:.0e}: set cut_off")
    distance = np.hypot(*np.array(steps, dtype=float).reshape(-1, 2).T)
    values = np.broadcast_to(compile_formula(keys["distance"], {}, "r").run(distance)[0], distance.shape)
    fits = (values >= strength.least) & (values <= strength.most)
    if not fits.all():
        k = np.argmin(np.where(fits, np.inf, distance))
        got = f"{values[k]:g} at r = {distance[k]:g}"
        raise ValueError(f"chain.springs.distance: got {got}, expected {strength}, or a shorter cut_off")
    ix, iy = np.arange(columns), np.arange(rows)[:, None]
    for (dx, dy), value in zip(steps, values, strict=True):
        first = ix + columns * iy
        if is_ring:
            # Opposite blocks of an even ring are joined once.
            first = first[:, : columns // 2 if 2 * dx == columns else columns]
            second = (first + dx) % columns
        else:
            first = first[: rows - dy, max(-dx, 0) : columns - max(dx, 0)]
            second = first + dx + columns * dy
        parts.append((first.ravel(), second.ravel(), np.full(first.size, value)))
    if not parts:
        raise refusal("chain.blocks", columns * rows, "at least 2 together with chain.springs")
    return tuple(map(np.concatenate, zip(*parts, strict=True)))  # type: ignore[return-value]
