"""The attractors of a model in one call."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Unpack

import numpy as np

from burridge_knopoff.attractors import search as attractors
from burridge_knopoff.attractors.attractor import Attractor
from burridge_knopoff.attractors.settings import SearchSettings
from burridge_knopoff.library.coercion import GivenLaw, Initial, given_model, given_state
from burridge_knopoff.library.keyword_settings import AttractorOptions, settings_of, show_settings
from burridge_knopoff.messages import refusal
from burridge_knopoff.model.chain import Chain
from burridge_knopoff.model.model import STARTS, Model
from burridge_knopoff.model.ranges import OneOf
from burridge_knopoff.motion.settings import MOTION, MotionSettings
from burridge_knopoff.values import elements, instance_of


@show_settings(SearchSettings)
def find_attractors(
    law: Model | GivenLaw,
    a: Any = None,
    settings: SearchSettings | None = None,
    motion: MotionSettings = MOTION,
    *,
    starts: Sequence[Initial] = (),
    start: str = "moving",
    chain: Chain | None = None,
    v: float | None = None,
    contact: str | None = None,
    **by_name: Unpack[AttractorOptions],
) -> tuple[list[Attractor], np.ndarray]:
    """Return the attractors of a model, and the index of the attractor that each initial state reaches.

    law, a, chain, v, contact : as for `simulate`; a `Model` takes the place of law and a, and settings may follow it
    settings : of the search, with the number of sampled states; by_name : some or all of them by name (see
        `SearchSettings`)
    motion : how kinds of motion are classified
    starts : initial states in addition to the sampled ones, each in any form that `simulate` takes
    start : moving or tested, see `Model.begin`

    The indices have shape (samples + len(starts),), sampled states first; −1 if a state does not settle on a known
    attractor. An attractor that no state reaches is not found. Motion without stops is not found either, since
    attractors are identified by the states at the stops of the outermost block that stops regularly. Raises ValueError,
    one line, for a wrong argument.

    Times are in units of 1/ω. docs/search.md describes the search.

    >>> from burridge_knopoff import find_attractors
    >>> attractors, labels = find_attractors(
    ...     "linearized", 0.08, starts=["plus"], samples=12, transient=500, window=500
    ... )
    >>> for attractor in attractors:
    ...     print(attractor.motion.kind.words, round(attractor.motion.mean_distance, 3))
    synchronized 0.0
    periodic 0.141
    >>> labels.shape, labels[-1].item()
    ((13,), 1)
    """
    if isinstance(law, Model) and isinstance(a, SearchSettings):
        if settings is not None:
            raise ValueError("settings: got two, expected one")
        a, settings = None, a
    instance_of(motion, MotionSettings, "motion")
    OneOf(STARTS).form(start, "start")
    given_starts = elements(starts)
    if given_starts is None:
        raise refusal("starts", starts, "a list of initial states")
    states = [given_state(state) for state in given_starts]
    # Without states and chain, the paper's chain.
    blocks = states[0].blocks if states else 3
    model = given_model(law, a, blocks, chain, v, contact)
    return attractors.find_attractors(
        model, settings_of(SearchSettings, settings, by_name), motion, starts=states, start=start
    )
