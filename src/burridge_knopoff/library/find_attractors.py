"""The attractors of a model in one call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np

from burridge_knopoff.attractors import search as attractors
from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.library.keyword_settings import settings_of, show_settings
from burridge_knopoff.library.state_forms import Initial, state_in
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.model import STARTS, Model
from burridge_knopoff.model.ranges import OneOf
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.values import elements, instance_of


@show_settings(SearchSettings)
def find_attractors(
    model: Model,
    settings: SearchSettings | None = None,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[Initial] = (),
    start: str = "moving",
    **by_name: Any,
) -> tuple[list[Attractor], np.ndarray]:
    """Return the attractors of a model, and the index of the attractor that each initial state reaches.

    settings : of the search, with the number of sampled states; by_name : some or all of them by name (see
        `SearchSettings`)
    motion : how kinds of motion are classified
    starts : initial states in addition to the sampled ones, each in any form that `simulate` takes
    start : moving or tested, see `Model.begin`

    The indices have shape (samples + len(starts),), sampled states first; −1 if a state does not settle on a known
    attractor. Uniform sliding is among the attractors wherever it attracts. Another attractor that no state reaches is
    not found. Attractors are identified by the states at the stops of the outermost block that stops regularly, those
    without stops by the states at the maxima of its velocity. Chaos is followed by an ensemble: `lifetime` says how
    many trajectories left it in which time. If it is not shown to last, its kind is TRANSIENT_CHAOS, and the states
    that reach it have its index. Raises ValueError, one line, for a wrong argument.

    Times are in units of 1/ω. docs/search.md describes the search.

    >>> from burridge_knopoff import Model, find_attractors
    >>> model = Model("linearized", a=0.08)
    >>> attractors, labels = find_attractors(model, starts=["plus"], samples=12, transient=500, window=500)
    >>> for attractor in attractors:
    ...     print(attractor.motion.kind.words, round(attractor.motion.mean_distance, 3))
    synchronized 0.0
    periodic 0.141
    >>> labels.shape, labels[-1].item()
    ((13,), 1)
    """
    instance_of(model, Model, "model")
    instance_of(motion, MotionSettings, "motion")
    OneOf(STARTS).form(start, "start")
    states = elements(starts)
    if states is None:
        raise refusal("starts", starts, "a list of initial states")
    return attractors.find_attractors(
        model,
        settings_of(SearchSettings, settings, by_name),
        motion,
        starts=[state_in(model, state, f"starts[{index}]") for index, state in enumerate(states)],
        start=start,
    )
