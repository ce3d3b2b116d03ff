"""Units in which the times, lengths and forces of a chain are about those of the paper's chain, whose units are all 1.

Times, lengths and tolerances that suit the paper's chain suit any other chain if they are given in these units.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

# With these factors the unit is 1 for a range of chains around the paper's, whose ends lie between round numbers.
_TIME_FACTOR = math.sqrt(1.5)
_SIZE_FACTOR = math.sqrt(2.0)


@dataclass(frozen=True)
class OwnUnits:
    """Units of time, length and force. They are powers of 2, so that rescaled chains give the same results to the bit.

    >>> from burridge_knopoff import Chain
    >>> slow = Chain(3, coupling=2.0**-18, pulling=tuple(2.0**-18 * n for n in (1, 2, 1)))
    >>> Chain(3).own_units
    OwnUnits(time=1.0, length=1.0, force=1.0)
    >>> slow.own_units
    OwnUnits(time=512.0, length=262144.0, force=1.0)
    """

    time: float = 1.0
    length: float = 1.0
    force: float = 1.0

    @property
    def velocity(self) -> float:
        """The unit of velocities."""
        return self.length / self.time

    @property
    def acceleration(self) -> float:
        """The unit of accelerations."""
        return self.velocity / self.time

    @property
    def slope(self) -> float:
        """The unit of the slope of a friction law, and thus of a."""
        return self.time / self.length

    def state(self, blocks: int) -> np.ndarray:
        """Return the units of positions and velocities, shape (2 blocks,)."""
        return np.repeat([self.length, self.velocity], blocks)


def own_units_of(threshold: np.ndarray, mass: np.ndarray, displacement: np.ndarray) -> OwnUnits:
    """Return the units of a chain, from its displacement by static friction and the acceleration when it is released.

    These are the length and the time of the slowest motion, however stiff the springs between blocks are.

    threshold, mass, displacement : of all blocks, shape (blocks,)
    """
    length = float(threshold @ np.abs(displacement)) / float(threshold.sum())
    acceleration = float(threshold.sum()) / float(mass.sum())
    time = math.ldexp(1.0, math.frexp(_TIME_FACTOR * length / acceleration)[1] // 2)
    unit = time * time * _nearest_power_of_two(acceleration)
    return OwnUnits(time, unit, _nearest_power_of_two(float(threshold.mean())))


def _nearest_power_of_two(size: float) -> float:
    """Return the power of 2 nearest to a number on a logarithmic scale."""
    return math.ldexp(1.0, math.frexp(_SIZE_FACTOR * size)[1] - 1)
