"""The motion in which given states end, after chaotic transients and slow approaches to synchrony.

A run of a few thousand time units does not always show this motion. Near the loss of synchrony perturbations decay more
slowly than that, chaos may be a transient, and motion with a small exponent may look like a torus or like chaos.
Therefore the attractors are searched for from the given states, and all states that reach one attractor get its values.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.labels import UNDETERMINED, advance, label
from burridge_knopoff.attractors.lifetime import EXPOSURE
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
from burridge_knopoff.periodic_orbits.floquet import unstable_count
from burridge_knopoff.periodic_orbits.flow import OrbitError
from burridge_knopoff.periodic_orbits.symmetry import Symmetry
from burridge_knopoff.running.settings import Settings
from burridge_knopoff.running.simulation import run

# Batches of a long window. Their scatter, and thus the error of ⟨J⟩ in chaos, has a relative error of about 1/6.
BATCHES = 20


@dataclass(frozen=True)
class AsymptoticState:
    """The motion in which a state ends.

    kind : undetermined if the state reaches no motion that is known to persist; the other values are then not known
    mean_distance, mean_distance_error : ⟨J⟩ and its standard error, NaN if undetermined
    section_period : number of upward section points after which the state of all blocks repeats, 0 if it does not
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
    """Return the asymptotic state of each initial state.

    settings : of the search for attractors, which starts from these states alone
    motion : how kinds of motion are distinguished
    start : moving or tested, see `Model.begin`

    Raises ValueError if an initial state does not fit the model.
    """
    settings = replace(settings, samples=0)
    attractors, labels = find_attractors(model, settings, motion, starts=initial, start=start)
    lasting = [k for k, attractor in enumerate(attractors) if attractor.motion.kind != MotionKind.TRANSIENT_CHAOS]
    starts = [model.begin(state, start) for state in initial]
    # States in transient chaos, and those that the search has given up, are followed up to the limit of labels.
    late = [k for k, index in enumerate(labels.tolist()) if index not in lasting]
    late_labels, _ = label(
        model, [attractors[index] for index in lasting], [starts[k] for k in late], settings.label_limit
    )
    labels[late] = [lasting[index] if index != UNDETERMINED else UNDETERMINED for index in late_labels.tolist()]
    # A mirror image has the same ⟨J⟩ and the same kind.
    labels = np.array([*(min(index, attractor.partner) for index, attractor in enumerate(attractors)), UNDETERMINED])[
        labels
    ]
    reached = {*labels.tolist()} - {UNDETERMINED}
    states = {index: _state_on(model, attractors, index, settings) for index in reached}
    lost = np.flatnonzero(labels == UNDETERMINED).tolist()
    ends = advance(model, [starts[k] for k in lost], settings.label_limit) if lost else []
    slow = {k: _slow_synchrony(model, end, settings, motion) for k, end in zip(lost, ends, strict=True)}
    return [slow[k] if k in slow else states[index] for k, index in enumerate(labels.tolist())]


def _state_on(model: Model, attractors: Sequence[Attractor], index: int, settings: SearchSettings) -> AsymptoticState:
    """Return the motion on an attractor, with ⟨J⟩ of chaos averaged over the time in which its lifetime is measured.

    In the window of the search ⟨J⟩ of chaos has an error of half a percent or more.
    """
    motion = attractors[index].motion
    state = _from_motion(motion)
    if motion.kind not in CHAOS:
        return state
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
        return state
    last = np.concatenate([trajectory.event_position[-1] - model.sliding_offset, trajectory.event_velocity[-1]])
    at, _ = label(model, attractors, [state_of(last)], settings.time_limit)
    # Even chaos that persists may end in this time. The average would then mix two motions.
    if at[0] not in (index, attractors[index].partner):
        return state
    return replace(state, mean_distance=trajectory.mean_distance, mean_distance_error=trajectory.mean_distance_error)


def _slow_synchrony(model: Model, end: ChainState, settings: SearchSettings, motion: MotionSettings) -> AsymptoticState:
    """Return synchrony if a state approaches it slowly, and an undetermined state otherwise.

    Near the loss of synchrony a state neither reaches it nor leaves it within the time limit. The multipliers of the
    synchronized orbit decide whether it attracts.
    """
    # The state is NaN if its run did not complete.
    if not model.chain.is_mirror_symmetric or not pair_distances(end).max() <= settings.resolution * model.scale:
        return AsymptoticState()
    symmetric = symmetrized(end)
    try:
        orbit = limit_cycle(model, symmetric)
    except OrbitError:
        return AsymptoticState()
    if orbit.symmetry != Symmetry.SYNCHRONIZED or unstable_count(orbit) != 0:
        return AsymptoticState()
    steady_motion = Classifier(model, settings.transient, settings.window, motion).measure(symmetric)
    return _from_motion(steady_motion) if steady_motion is not None else AsymptoticState()


def _from_motion(motion: SteadyMotion) -> AsymptoticState:
    return AsymptoticState(motion.kind, motion.mean_distance, motion.mean_distance_error, motion.section_period)
