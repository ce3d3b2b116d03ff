"""Ranges of the friction parameter a in the statements of the paper."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np


@dataclass(frozen=True)
class Range:
    """A range of the friction parameter: includes `first` and `last`, excludes `above` and `below`."""

    first: float | None = None
    last: float | None = None
    above: float | None = None
    below: float | None = None

    def __str__(self) -> str:
        if self.above is not None and self.last is None and self.below is None:
            return f"a > {self.above:g}"
        low = f"{self.first:g} ≤ " if self.first is not None else f"{self.above:g} < " if self.above is not None else ""
        high = f" ≤ {self.last:g}" if self.last is not None else f" < {self.below:g}" if self.below is not None else ""
        return f"{low}a{high}"

    def choose(self, a: np.ndarray) -> np.ndarray:
        """Return which values lie in the range, same shape as a."""
        chosen = np.ones(np.shape(a), dtype=bool)
        if self.first is not None:
            chosen &= a >= self.first
        if self.last is not None:
            chosen &= a <= self.last
        if self.above is not None:
            chosen &= a > self.above
        if self.below is not None:
            chosen &= a < self.below
        return chosen


#: Where the paper finds synchrony from minus; below and above the transition to chaos; all a at which friction falls
#: with velocity; where two blocks are compared.
SYNCHRONY = Range(first=0.005, last=0.08)
BELOW = Range(above=0.0, below=0.1)
ABOVE = Range(above=0.1)
POSITIVE = Range(above=0.0)
TWO_BLOCKS = Range(above=0.0, below=0.3)
