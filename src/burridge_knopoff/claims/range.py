"""Ranges of the friction parameter a in the statements of the paper."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise

import numpy as np

# A range is covered if each of so many equal parts of it has a value of a.
PARTS = 10

# Decimals of a grid and of a range may differ in the last bit.
ROUNDING = 1e-9


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

    @property
    def _ends(self) -> tuple[float | None, float | None]:
        return (
            self.first if self.above is None else self.above,
            self.last if self.below is None else self.below,
        )

    @property
    def is_bounded(self) -> bool:
        """Whether the range has a lower and an upper end."""
        return None not in self._ends

    @property
    def words(self) -> str:
        """The range for a sentence: «from 0.005 to 0.065», or «with a > 0» if it has no lower or no upper end."""
        low, high = self._ends
        return f"with {self}" if low is None or high is None else f"from {low:g} to {high:g}"

    def missing(self, a: np.ndarray) -> list[Range]:
        """Return the parts of the range in which values of a are missing; empty if the values cover the range.

        Each tenth of the range, both ends included, needs a value; neighbouring tenths without values are joined. A
        range without a lower or an upper end needs a single value.
        """
        inside = a[self.choose(a)]
        low, high = self._ends
        if low is None or high is None:
            return [] if len(inside) else [self]
        ends = np.linspace(low, high, PARTS + 1)
        margin = ROUNDING * (high - low)
        empty = [not ((inside >= first - margin) & (inside <= last + margin)).any() for first, last in pairwise(ends)]
        borders = np.flatnonzero(np.diff([False, *empty, False])).reshape(-1, 2)
        return [Range(first=float(f"{ends[first]:g}"), last=float(f"{ends[last]:g}")) for first, last in borders]


#: The largest a that the paper names. Statements on larger a without an upper end are judged up to it.
LARGEST = 0.3

#: Where the paper finds synchrony from minus; below and above the transition to chaos; all a at which friction falls
#: with velocity; where two blocks are compared.
SYNCHRONY = Range(first=0.005, last=0.08)
BELOW = Range(above=0.0, below=0.1)
ABOVE = Range(above=0.1, last=LARGEST)
POSITIVE = Range(above=0.0, last=LARGEST)
TWO_BLOCKS = Range(above=0.0, below=LARGEST)
#: Of a statement of theory, which any value of a tests: eigenvalues follow from the springs and from F'(v) alone.
WEAKENING = Range(above=0.0)
