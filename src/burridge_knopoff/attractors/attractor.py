"""One attractor: a settled motion, its mirror symmetry, its capture radius, and its lifetime if it is chaotic."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
import scipy.special

from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.sampling import CONFIDENCE
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.period import orbit_length
from burridge_knopoff.motion.section_returns import Returns
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.runner import ROUNDING
from burridge_knopoff.values import each_instance_of

#: Successive returns within the capture radius after which a trajectory counts as captured. A trajectory that only
#: passes by does not return that often.
CLOSE_RETURNS = 8

# Longest orbit, in returns, of which a trajectory has to complete two periods; it bounds the cost of a label.
LONGEST_ORBIT = 100

# Confidence of the interval of a lifetime that has to lie above or below the limit before no more trajectories are
# followed. A lifetime below it needs FEWEST_ENDS as well: stopping at few ends would favour samples in which many left
# by chance. If the lifetime equals the limit, 3.5 % of these tests find it above.
EARLY_CONFIDENCE = 0.995
FEWEST_ENDS = 30


@dataclass(frozen=True)
class Lifetime:
    """Lifetime of a chaotic motion, from observed escapes.

    ends : number of trajectories that left it for another attractor
    time : total time that all trajectories spent on it
    """

    ends: int
    time: float

    @property
    def words(self) -> str:
        """How long the motion was followed, and how often it ended."""
        return f"{self.ends or 'no'} escape{'s' * (self.ends != 1)} in {self.time:.4g} time units"

    @property
    def mean(self) -> float:
        """Mean lifetime; infinite if no trajectory left."""
        return self.time / self.ends if self.ends else math.inf

    @property
    def interval(self) -> tuple[float, float]:
        """95 % confidence interval of the mean lifetime; its upper end is infinite if no trajectory left."""
        return self._interval(CONFIDENCE)

    def _interval(self, confidence: float) -> tuple[float, float]:
        tail = 0.5 * (1.0 - confidence)
        low = self.time / float(scipy.special.gammainccinv(self.ends + 1, tail))
        return low, self.time / float(scipy.special.gammaincinv(self.ends, tail)) if self.ends else math.inf

    def is_decided(self, least: float) -> bool:
        """Return whether enough trajectories have been followed to tell if the mean lifetime is above `least`."""
        low, high = self._interval(EARLY_CONFIDENCE)
        return low > least or (high < least and self.ends >= FEWEST_ENDS)

    def is_longer_than(self, least: float) -> bool:
        """Return whether the 95 % interval of the mean lifetime lies above `least`."""
        return self.interval[0] > least


@dataclass(frozen=True, eq=False)
class Attractor:
    """An attractor of a model, represented by a settled motion.

    partner : index of its mirror image among the attractors of the same a; its own index if the mirror image is the
        same set, or if there is none
    radius : capture radius, the distance from its returns within which trajectories are captured
    slow : whether the motion on the set is too slow to settle, so that its returns are those of perturbed states
    close_returns : successive returns within the radius after which a trajectory counts as captured
    patience : time by which a captured trajectory may still reach a periodic orbit embedded in the attractor; 0 if
        there is no such orbit
    lifetime : of chaos, where it was measured: `find_attractors` does; None otherwise. Chaos that it does not show to
        last has the kind TRANSIENT_CHAOS

    Distances are the largest difference of a position or a velocity, in the units of `Model`.

    >>> from burridge_knopoff import Model, SearchSettings, find_attractors
    >>> model = Model("linearized", a=0.08)
    >>> settings = SearchSettings(samples=12, transient=500, window=500)
    >>> attractors, labels = find_attractors(model, settings)
    >>> attractors[1].symmetry.name, attractors[1].partner
    ('SYMMETRIC', 1)
    """

    model: Model
    motion: SteadyMotion
    symmetry: Symmetry
    partner: int
    radius: float = np.inf
    slow: bool = False
    close_returns: int = field(kw_only=True)
    patience: float = 0.0
    lifetime: Lifetime | None = None

    def __setstate__(self, state: dict[str, Any]) -> None:
        """Refuse a pickle without a model."""
        if "model" not in state:
            raise ValueError("attractor: got a pickle without its model, expected one of this version: search again")
        vars(self).update(state)

    def __repr__(self) -> str:
        life = f"; {self.lifetime.words}" if self.lifetime else ""
        return f"<Attractor, {self.symmetry.name.lower()}: {self.motion.words}{life}>"


def attractors_of(model: Model, attractors: Sequence[Attractor]) -> list[Attractor]:
    """Return a list of attractors; raises ValueError, one line, unless all are attractors of this model."""
    attractors = each_instance_of(attractors, Attractor, "attractors")
    for index, attractor in enumerate(attractors):
        model.check_same(attractor.model, f"attractors[{index}].model")
    return attractors


def required_returns(section: Returns, tolerance: float) -> int:
    """Return the number of successive returns that capture requires: at least two periods of a periodic orbit."""
    if not section.has_periodic_spacing(tolerance):
        return CLOSE_RETURNS
    return max(CLOSE_RETURNS, 2 * orbit_length(section.returns, 10.0 * tolerance, LONGEST_ORBIT))


def perturb(start: ChainState, size: float, generator: np.random.Generator) -> ChainState:
    """Return a state with positions, and velocities of slipping blocks, changed at random by at most `size`.

    The direction of slip is not reversed.
    """
    blocks = len(start.position)
    change = generator.uniform(-size, size, 2 * blocks)
    moved = start.velocity + change[blocks:]
    # Smaller velocities of either sign are rounding errors at a stop.
    backward = start.velocity < -ROUNDING * max(1.0, np.abs(start.velocity).max())
    velocity = np.where(start.stuck | (np.where(backward, -moved, moved) < 0.0), 0.0, moved)
    return ChainState(start.position + change[:blocks], velocity, start.stuck)
