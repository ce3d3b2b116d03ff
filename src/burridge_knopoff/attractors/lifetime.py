"""Lifetimes of chaos: the mean lifetime of a chaotic set from an ensemble of trajectories that begin on it.

Transient chaos ends at a constant rate. Lifetimes are therefore exponentially distributed, and the number of
trajectories that leave in a given total time has a Poisson distribution.

Reference: C. Grebogi, E. Ott and J. A. Yorke, "Crises, sudden changes in chaotic attractors, and transient chaos",
Physica D 7 (1983) 181-200; for the interval F. Garwood, Biometrika 28 (1936) 437-442.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import replace
from functools import partial

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor, Lifetime, perturb
from burridge_knopoff.attractors.capture_radius import LONGEST_PATIENCE
from burridge_knopoff.attractors.labels import UNDETERMINED, advance, label, label_arrays, stack_states
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.motion.section_returns import ReturnSection, state_of
from burridge_knopoff.motion.set_distance import SPACINGS

#: Number of trajectories that are followed, and their total time, in units of the lifetime above which chaos counts as
#: an attractor. If none of them leaves, the lifetime is above this limit with 98 % certainty.
TRAJECTORIES = 32
EXPOSURE = 4.0

# If some leave, these many times as many are added in turn, until `Lifetime.is_decided`.
EXTENSIONS = (1, 2, 3, 4)

# Time, in capture times of another attractor, after which counting starts. Trajectories that leave at once are captured
# by then; counted earlier, they would make chaos seem to last longer.
CAPTURE_MARGIN = 2.0

# Distance, for v = 0.1, from which escaping trajectories approach another attractor; and the number of trajectories
# left at the start of counting below which all captures are counted instead.
ESCAPE_DISTANCE = 0.2
FEWEST_LEFT = 8

# Perturbation, in resolutions, that separates trajectories of the ensemble, and its largest size as a fraction of the
# capture radius. The radius of thin chaos rests on few perturbations; from the full radius a third may leave.
ENSEMBLE_PERTURBATION = 0.1
ENSEMBLE_RADIUS_SHARE = 0.01


def lifetimes(
    model: Model, attractors: Sequence[Attractor], settings: SearchSettings, exposure: float = EXPOSURE
) -> list[Lifetime | None]:
    """Return the lifetime of each attractor that is chaotic, None for the others; mirror images share theirs.

    settings : its `lifetime` is the limit above which chaos counts as an attractor
    exposure : total time in units of this limit, see EXPOSURE
    """
    lives: list[Lifetime | None] = []
    for index, attractor in enumerate(attractors):
        if attractor.motion.kind not in CHAOS:
            lives.append(None)
        elif attractor.partner < index:
            lives.append(lives[attractor.partner])
        else:
            lives.append(_lifetime(model, attractors, index, settings, exposure))
    return lives


def mark_transients(model: Model, attractors: Sequence[Attractor], settings: SearchSettings) -> list[Attractor]:
    """Return attractors with the lifetimes of those that are chaotic; chaos that is not shown to last is transient.

    settings : its `lifetime` is the limit above which chaos counts as an attractor
    """
    marked = []
    for attractor, life in zip(attractors, lifetimes(model, attractors, settings), strict=True):
        motion = attractor.motion
        if life is not None and not life.is_longer_than(settings.lifetime):
            motion = replace(motion, kind=MotionKind.TRANSIENT_CHAOS)
        marked.append(replace(attractor, motion=motion, lifetime=life))
    return marked


def _lifetime(
    model: Model, attractors: Sequence[Attractor], index: int, settings: SearchSettings, exposure: float
) -> Lifetime:
    """Return the lifetime of a chaotic set, from more trajectories until these decide whether it is above the limit."""
    generator = np.random.default_rng(settings.seed)
    follow = partial(_follow, model, attractors, index, settings, exposure, generator)
    lifetime = follow(TRAJECTORIES)
    for times in EXTENSIONS if lifetime.ends else ():
        if lifetime.is_decided(settings.lifetime):
            break
        extension = follow(TRAJECTORIES * times)
        lifetime = Lifetime(lifetime.ends + extension.ends, lifetime.time + extension.time)
    return lifetime


def _follow(
    model: Model,
    attractors: Sequence[Attractor],
    index: int,
    settings: SearchSettings,
    exposure: float,
    generator: np.random.Generator,
    count: int,
) -> Lifetime:
    """Follow `count` trajectories from a chaotic set, and count those that leave it and its mirror image."""
    attractor = attractors[index]
    time = exposure * settings.lifetime / TRAJECTORIES
    returns = attractor.motion.returns
    size = min(ENSEMBLE_PERTURBATION * settings.resolution * model.scale, ENSEMBLE_RADIUS_SHARE * attractor.radius)
    chosen = generator.integers(len(returns), size=count)
    starts = [perturb(state_of(returns[k]), size, generator) for k in chosen]
    targets = [target for k, target in enumerate(attractors) if k not in (index, attractor.partner)]
    # Trajectories leave chaos at a constant rate, and are captured elsewhere at the same rate once the first have had
    # time for it. Captures before that time are not counted.
    late = max((_capture_time(model, target) for target in targets), default=0.0)
    gone, when, last = label_arrays(model, targets, *stack_states(starts), late + time)
    is_captured = gone != UNDETERMINED

    # The radius of thin chaos may be smaller than the distances between its returns, and would miss its own states.
    sets = [
        replace(item, radius=max(item.radius, SPACINGS * item.motion.spacing))
        if k in (index, attractor.partner)
        else item
        for k, item in enumerate(attractors)
    ]

    def find_undetermined(chosen: np.ndarray, there: list[ChainState]) -> np.ndarray:
        """Return which of the chosen trajectories, now in these states, reach no known attractor."""
        return chosen[label(model, sets, there, settings.time_limit)[0] == UNDETERMINED]

    # A trajectory that reaches no known set has left at an unknown time, some before counting starts.
    lost = find_undetermined(np.flatnonzero(~is_captured), [state_of(state) for state in last[~is_captured]])
    early = find_undetermined(lost, advance(model, [starts[k] for k in lost], late) if len(lost) else [])
    if count - np.count_nonzero(is_captured & (when <= late)) - len(early) < FEWEST_LEFT:
        # Chaos this short is over before counting starts; all captures are counted.
        spent = np.where(is_captured, when, late + time)
        spent[lost] = 0.5 * late
        return Lifetime(int(is_captured.sum()) + len(lost), float(spent.sum()))
    ends = is_captured & (when > late)
    ends[lost] = True
    spent = np.where(is_captured, np.maximum(when - late, 0.0), time)
    spent[lost] = 0.5 * time
    ends[early], spent[early] = False, 0.0
    return Lifetime(int(ends.sum()), float(spent.sum()))


def _capture_time(model: Model, attractor: Attractor) -> float:
    """Return a time within which an attractor captures trajectories that have left chaos.

    They approach a periodic orbit at the rate of its second exponent until they are within its radius, and then need
    `close_returns` returns. For a torus, for chaos, and for an orbit to which a torus is locked this exponent gives no
    such rate.
    """
    motion, rate = attractor.motion, -attractor.motion.exponent[1]
    if rate < 1.0 / LONGEST_PATIENCE:
        return LONGEST_PATIENCE
    nearer = math.log(ESCAPE_DISTANCE * model.scale / attractor.radius) / rate
    stops = motion.section == ReturnSection.STOPS
    close = attractor.close_returns / (motion.stop_rate[motion.block - 1] if stops else motion.return_rate)
    return CAPTURE_MARGIN * (max(nearer, 0.0) + close)
