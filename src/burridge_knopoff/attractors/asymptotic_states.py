"""What given states end on: an attractor, however long chaos lasts before, or synchrony that is approached slowly.

A run of some thousand time units shows what a state does by then. Next to the loss of synchrony perturbations take
longer than that to die out, chaos may be a transient, and motion of a small exponent looks now like a torus, now like
chaos. So states are given the attractors that a search from them finds, and all that end on one have its numbers.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED, advance, label
from burridge_knopoff.attractors.lifetime import EXPOSURE, lifetimes
from burridge_knopoff.attractors.search import find_attractors
from burridge_knopoff.attractors.settings import SEARCH, SearchSettings
from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import ChainState, Model
from burridge_knopoff.motion.classification import Classifier
from burridge_knopoff.motion.kind import CHAOS, MotionKind
from burridge_knopoff.motion.limit_cycle import limit_cycle
from burridge_knopoff.motion.mirror import pair_distances, symmetrized
from burridge_knopoff.motion.observables import SteadyMotion
from burridge_knopoff.motion.section_returns import state_of
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.periodic_orbits.floquet import multipliers
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

# Batches of a long window: their scatter, and so the error of ⟨J⟩ in chaos, is known to a sixth.
BATCHES = 20


@dataclass(frozen=True)
class AsymptoticState:
    """The motion that a state ends in.

    kind : undetermined where the state reaches nothing that is known to last, and then nothing else is known
    mean_distance, mean_distance_error : ⟨J⟩ and its standard error, NaN if undetermined
    section_period : upward section points after which the state of all blocks repeats, 0 if it does not
    """

    kind: MotionKind = MotionKind.UNDETERMINED
    mean_distance: float = math.nan
    mean_distance_error: float = math.nan
    section_period: int = 0


def asymptotic_states(
    model: Model,
    initial: Sequence[InitialState],
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    *,
    start: str = "moving",
) -> list[AsymptoticState]:
    """Return what each initial state ends on.

    settings : of the search for attractors, which is made from these states alone; motion : how kinds of motion are
        told apart
    start : moving or tested, see `Model.begin`

    Raises ValueError if an initial state does not fit the model.
    """
    settings = replace(settings, samples=0)
    attractors, labels = find_attractors(model, settings, motion, starts=initial, start=start)
    lives = lifetimes(model, attractors, settings)
    lasting = [index for index, life in enumerate(lives) if life is None or life.is_longer_than(settings.lifetime)]
    starts = [model.begin(state, start) for state in initial]
    # Out of chaos that ends, and out of what the search has given up, states are followed for as long as labels are.
    late = [k for k, index in enumerate(labels.tolist()) if index not in lasting]
    there, _ = label(model, [attractors[index] for index in lasting], [starts[k] for k in late], settings.label_limit)
    labels[late] = [lasting[index] if index != UNDETERMINED else UNDETERMINED for index in there.tolist()]
    # A mirror image has the same ⟨J⟩ and the same kind.
    labels = np.array([*(min(index, one.partner) for index, one in enumerate(attractors)), UNDETERMINED])[labels]
    reached = {*labels.tolist()} - {UNDETERMINED}
    known = {index: _state_on(model, attractors, index, settings) for index in reached}
    lost = np.flatnonzero(labels == UNDETERMINED).tolist()
    ends = advance(model, [starts[k] for k in lost], settings.label_limit) if lost else []
    slow = {k: _slow_synchrony(model, end, settings, motion) for k, end in zip(lost, ends, strict=True)}
    return [slow[k] if k in slow else known[index] for k, index in enumerate(labels.tolist())]


def _state_on(model: Model, attractors: Sequence[Attractor], index: int, settings: SearchSettings) -> AsymptoticState:
    """Return the motion on an attractor, ⟨J⟩ of chaos from the time for which it is followed to see whether it lasts.

    The search's own window leaves ⟨J⟩ of chaos an error of half a percent and more: too much where that decides.
    """
    motion = attractors[index].motion
    found = _from_motion(motion)
    if motion.kind not in CHAOS:
        return found
    window = EXPOSURE * settings.lifetime
    options = Settings(
        transient=0.0,
        window=window,
        batches=BATCHES,
        sampling=window,
        trajectory=0.0,
        event_window=min(settings.window, window),
        lyapunov_exponents=0,
    )
    trajectory = run(model, motion.state(), options)
    if trajectory.status != "completed" or not len(trajectory.event_time):
        return found
    last = np.concatenate([trajectory.event_position[-1] - model.sliding_offset, trajectory.event_velocity[-1]])
    at, _ = label(model, attractors, [state_of(last)], settings.time_limit)
    # Chaos that lasts may end all the same, and the average is then one of two motions.
    if at[0] not in (index, attractors[index].partner):
        return found
    return replace(found, mean_distance=trajectory.mean_distance, mean_distance_error=trajectory.mean_distance_error)


def _slow_synchrony(model: Model, end: ChainState, settings: SearchSettings, motion: MotionSettings) -> AsymptoticState:
    """Return the ending in synchrony of a state that is on its way there; undetermined if it is not.

    Next to the loss of synchrony a state neither reaches it nor leaves it in the time it has: whether it attracts is
    told by the multipliers of the synchronized orbit.
    """
    if not model.chain.is_mirror_symmetric or pair_distances(end).max() > settings.resolution * model.scale:
        return AsymptoticState()
    symmetric = symmetrized(end)
    try:
        orbit = limit_cycle(model, symmetric)
    except OrbitError:
        return AsymptoticState()
    if orbit.symmetry != Symmetry.SYNCHRONIZED or multipliers(orbit).unstable:
        return AsymptoticState()
    found = Classifier(model, settings.transient, settings.window, motion).measure(symmetric)
    return _from_motion(found) if found is not None else AsymptoticState()


def _from_motion(motion: SteadyMotion) -> AsymptoticState:
    return AsymptoticState(motion.kind, motion.mean_distance, motion.mean_distance_error, motion.section_period)
