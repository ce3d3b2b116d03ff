"""Numbers for the blocks: one for all blocks, one per block, or random with a fixed seed."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Any

import numpy as np

from burridge_knopoff.messages import refusal
from burridge_knopoff.model.fields import Field, Keys
from burridge_knopoff.model.ranges import Number, OneOf, Range, Whole
from burridge_knopoff.values import number_in

#: One number for all blocks, a list with one number per block, or random numbers by their keys or as text.
Numbers = float | Sequence[float] | Mapping[str, Any] | str

SEED = Whole(0, 2**32 - 1)


@dataclass(eq=False, repr=False)
class RandomNumbers(Range):
    """The keys of independent random numbers for the blocks, uniform between `low` and `high`.

    number : range of `low` and `high`

    The form is a text for files and command lines, such as `random=uniform,low=0.9,high=1.1,seed=1`.
    """

    number: Number

    @property
    def keys(self) -> Keys:
        """The keys that describe the numbers."""
        return Keys(
            {
                "random": Field(OneOf(("uniform",)), "the distribution, uniform"),
                "low": Field(self.number, "the smallest number"),
                "high": Field(self.number, "the largest number"),
                "seed": Field(SEED, "a seed; the same seed draws the same numbers"),
            }
        )

    def _fit(self, value: Any, key: str) -> str | None:
        if isinstance(value, str) and value.startswith("random="):
            value = _parse(value)
        if not isinstance(value, Mapping):
            return None
        drawn = self.keys.form(value, key)
        if drawn["high"] < drawn["low"]:
            raise refusal(f"{key}.high", drawn["high"], f"at least low ({drawn['low']!r})")
        return ",".join(f"{name}={item}" for name, item in drawn.items())

    def __str__(self) -> str:
        return "{random: uniform, low, high, seed}"


def _parse(text: str) -> dict[str, Any]:
    parts = (part.partition("=") for part in text.split(","))
    return {name: value if (number := number_in(value)) is None else number for name, _, value in parts}


def block_values(numbers: Numbers, blocks: int, name: str) -> np.ndarray:
    """Return the numbers of all blocks, shape (blocks,).

    name : of the quantity; different quantities with the same seed are independent

    The sequence does not depend on the number of blocks.
    """
    if not isinstance(numbers, str):
        return np.array(np.broadcast_to(numbers, blocks), dtype=float)  # type: ignore[arg-type]
    drawn = _parse(numbers)
    unit = np.random.default_rng([drawn["seed"], *name.encode()]).random(blocks)
    return np.minimum(drawn["low"] + (drawn["high"] - drawn["low"]) * unit, drawn["high"])
