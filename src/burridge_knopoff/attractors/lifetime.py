"""How long chaos lasts: the mean lifetime of a chaotic set from an ensemble of trajectories that begin on it.

Chaos may be a transient. Then it ends at a constant rate, whatever has gone before, so that lifetimes are exponentially
distributed, and the number of ends in a total time of all trajectories has a Poisson distribution.

Reference: C. Grebogi, E. Ott and J. A. Yorke, "Crises, sudden changes in chaotic attractors, and transient chaos",
Physica D 7 (1983) 181-200; for the interval F. Garwood, Biometrika 28 (1936) 437-442.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import scipy.special

from burridge_knopoff.attractors.attractor import Attractor, perturb
from burridge_knopoff.attractors.capture_radius import LONGEST_PATIENCE
from burridge_knopoff.attractors.labels import UNDETERMINED, advance, label, label_arrays, stack_states
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.model.sampling import CONFIDENCE
from burridge_knopoff.motion.kind import CHAOS
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.set_distance import SPACINGS

#: Trajectories of chaos that are followed, and the time for all of them together, in units of the lifetime beyond which
#: it counts as lasting. If none of them leaves it, its lifetime is beyond that with 98 % certainty.
TRAJECTORIES = 32
EXPOSURE = 4.0

# Where these leave open whether the lifetime is below or beyond, or where fewer than FEWEST_ENDS leave, so many times
# more are followed: stopping at few ends would favour samples in which, by chance, many left. Looking twice leaves 96
# %.
EXTENSION = 10
FEWEST_ENDS = 30

# Times, in those that another attractor takes to capture a trajectory, after which those who left at once and are not
# yet captured no longer make chaos seem to last.
CAPTURE_MARGIN = 2.0

# Distance, for v = 0.1, from which they come, and how few that are left by then make the captures before count instead.
ESCAPE_DISTANCE = 0.2
FEWEST_LEFT = 8

# Perturbation, in resolutions, that parts trajectories which begin at different times of one and the same; and the
# share of the radius that it has at most. The radius of thin chaos rests on few perturbations: of as large ones a third
# may leave.
ENSEMBLE_PERTURBATION = 0.1
ENSEMBLE_RADIUS_SHARE = 0.01


@dataclass(frozen=True)
class Lifetime:
    """What was seen of the ends of a chaotic motion.

    ends : trajectories that left it for another attractor; time : for which all of them together were on it
    """

    ends: int
    time: float

    @property
    def mean(self) -> float:
        """Mean lifetime; infinite if no trajectory left."""
        return self.time / self.ends if self.ends else math.inf

    @property
    def interval(self) -> tuple[float, float]:
        """95 % confidence interval of the mean lifetime; its upper end is infinite if no trajectory left."""
        tail = 0.5 * (1.0 - CONFIDENCE)
        low = self.time / float(scipy.special.gammainccinv(self.ends + 1, tail))
        return low, self.time / float(scipy.special.gammaincinv(self.ends, tail)) if self.ends else math.inf

    def is_longer_than(self, least: float) -> bool:
        """Tell whether the mean lifetime is certain to be above that."""
        return self.interval[0] > least


def lifetimes(
    model: Model, attractors: Sequence[Attractor], settings: SearchSettings, exposure: float = EXPOSURE
) -> list[Lifetime | None]:
    """Return the lifetime of each attractor that is chaotic, None for the others; mirror images have the same one.

    settings : `lifetime` says how long chaos is followed; exposure : see EXPOSURE
    """
    found: list[Lifetime | None] = []
    for index, attractor in enumerate(attractors):
        if attractor.motion.kind not in CHAOS:
            found.append(None)
        elif attractor.partner < index:
            found.append(found[attractor.partner])
        else:
            found.append(_lifetime(model, attractors, index, settings, exposure))
    return found


def _lifetime(
    model: Model, attractors: Sequence[Attractor], index: int, settings: SearchSettings, exposure: float
) -> Lifetime:
    """Follow trajectories from states on a chaotic set, and more where few left it or where it is open if it lasts."""
    generator = np.random.default_rng(settings.seed)
    follow = partial(_follow, model, attractors, index, settings, exposure, generator)
    first = follow(TRAJECTORIES)
    low, high = first.interval
    if (not first.ends or first.ends >= FEWEST_ENDS) and not low <= settings.lifetime < high:
        return first
    more = follow(TRAJECTORIES * EXTENSION)
    return Lifetime(first.ends + more.ends, first.time + more.time)


def _follow(
    model: Model,
    attractors: Sequence[Attractor],
    index: int,
    settings: SearchSettings,
    exposure: float,
    generator: np.random.Generator,
    count: int,
) -> Lifetime:
    """Follow so many trajectories from a chaotic set and see which are still on it, or on its mirror image."""
    attractor = attractors[index]
    time = exposure * settings.lifetime / TRAJECTORIES
    returns = attractor.motion.returns
    size = min(ENSEMBLE_PERTURBATION * settings.resolution * model.scale, ENSEMBLE_RADIUS_SHARE * attractor.radius)
    chosen = generator.integers(len(returns), size=count)
    starts = [perturb(state_of(returns[k]), size, generator) for k in chosen]
    others = [other for k, other in enumerate(attractors) if k not in (index, attractor.partner)]
    # Chaos is left at a constant rate, and so is, once the first have had the time for it, the state of not being
    # certain of another attractor: what comes before that time says nothing.
    late = max((_capture_time(model, other) for other in others), default=0.0)
    gone, when, last = label_arrays(model, others, *stack_states(starts), late + time)
    known = gone != UNDETERMINED

    # The radius of thin chaos may be smaller than the distances within it: by that it does not know its own states.
    sets = [
        replace(one, radius=max(one.radius, SPACINGS * one.motion.spacing)) if k in (index, attractor.partner) else one
        for k, one in enumerate(attractors)
    ]

    def find_undetermined(chosen: np.ndarray, there: list[ChainState]) -> np.ndarray:
        """Return which of the chosen trajectories come from where they are to nothing that is known."""
        return chosen[label(model, sets, there, settings.time_limit)[0] == UNDETERMINED]

    # A trajectory that reaches no known set has left at an unknown time; some had left already by then.
    lost = find_undetermined(np.flatnonzero(~known), [state_of(state) for state in last[~known]])
    early = find_undetermined(lost, advance(model, [starts[k] for k in lost], late) if len(lost) else [])
    if count - np.count_nonzero(known & (when <= late)) - len(early) < FEWEST_LEFT:
        # Chaos that is as short as that: captures are all that is seen.
        spent = np.where(known, when, late + time)
        spent[lost] = 0.5 * late
        return Lifetime(int(known.sum()) + len(lost), float(spent.sum()))
    ends = known & (when > late)
    ends[lost] = True
    spent = np.where(known, np.maximum(when - late, 0.0), time)
    spent[lost] = 0.5 * time
    ends[early], spent[early] = False, 0.0
    return Lifetime(int(ends.sum()), float(spent.sum()))


def _capture_time(model: Model, attractor: Attractor) -> float:
    """Return a time within which trajectories that have left chaos are certain to be on an attractor.

    By its second exponent they come from afar to the radius of a closed orbit, and then so often close to it as they
    have to. Of a torus, of chaos, and of an orbit to which a torus is locked this exponent tells nothing.
    """
    motion, rate = attractor.motion, -attractor.motion.exponent[1]
    if rate < 1.0 / LONGEST_PATIENCE:
        return LONGEST_PATIENCE
    nearer = math.log(ESCAPE_DISTANCE * model.scale / attractor.radius) / rate
    close = attractor.close_returns / motion.stop_rate[motion.block - 1]
    return CAPTURE_MARGIN * (max(nearer, 0.0) + close)
