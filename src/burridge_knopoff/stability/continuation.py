"""The attractors of one law along a: found at each a from states and from the attractors beside it, and refined.

Between neighbouring values of a at which the attractors differ, values are put in until the change lies between two
that are near enough to each other.

Reference: G. Datseris, K. Luiz Rossi and A. Wagemakers, "Framework for global stability analysis of dynamical systems",
Chaos 33 (2023) 073151: the search at each parameter begins from the attractors at the one before.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from burridge_knopoff.model.initial import InitialState
from burridge_knopoff.model.model import Instant, Model
from burridge_knopoff.stability.attractor import Attractor
from burridge_knopoff.stability.attractors import Search
from burridge_knopoff.stability.labels import UNDETERMINED
from burridge_knopoff.stability.lifetime import Lifetime, lifetimes
from burridge_knopoff.stability.matching import branches
from burridge_knopoff.stability.refinement import refined
from burridge_knopoff.stability.settings import MOTION, REFINE, SEARCH, MotionSettings, Refine, SearchSettings
from burridge_knopoff.stability.tuning import TUNING, Tuning


@dataclass(frozen=True, eq=False)
class Continuation:
    """The attractors of one law along a.

    models : at each a, ascending: those that were given, and those that were put in between them
    grid : positions in `models` of those that were given
    attractors : for each given model those that coexist there; for the others those that change there
    lifetimes : for each model and attractor its lifetime if it is chaotic, None if it is not
    branch, side : for each model and attractor the number of its branch and its side of it; see `matching.branches`
    upward, downward : for each given model and attractor the index of the attractor reached at the next or the previous
        given one, −1 where it is undetermined or there is none
    samples : for each given model the index reached by each state that was drawn for the basin fractions
    """

    models: list[Model]
    grid: list[int]
    attractors: list[list[Attractor]]
    lifetimes: list[list[Lifetime | None]]
    branch: list[np.ndarray]
    side: list[np.ndarray]
    upward: list[np.ndarray]
    downward: list[np.ndarray]
    samples: list[np.ndarray]


def continue_attractors(
    models: Sequence[Model],
    settings: SearchSettings = SEARCH,
    motion: MotionSettings = MOTION,
    refine: Refine = REFINE,
    *,
    starts: Sequence[InitialState] = (),
    start: str = "moving",
    tuning: Tuning = TUNING,
) -> Continuation:
    """Find the attractors of all models, of ascending a, from initial states and from each other, and match them.

    settings, motion, starts, start, tuning : see `find_attractors`
    refine : how near in a a change is looked for

    Raises ValueError if an initial state does not fit the models.
    """
    generator = np.random.default_rng(settings.seed)

    def seeds(search: Search) -> list[Instant]:
        return [search.seed_of(attractor, generator) for attractor in search.attractors]

    searches = [Search(model, settings, motion, tuning) for model in models]
    for k, search in enumerate(searches):
        before = seeds(searches[k - 1]) if k else []
        search.labels([*before, *search.starts(starts, start)])
    for k in range(len(searches) - 2, -1, -1):
        searches[k].labels(seeds(searches[k + 1]), check=False)
    for k in range(1, len(searches)):
        searches[k].labels(seeds(searches[k - 1]), check=False)
    samples = [search.drawn_labels(start) for search in searches]

    # The sets of attractors are complete now: what follows only reads them.
    inner = [refined(*pair, refine, generator) for pair in pairwise(searches)]
    whole = [search for one, more in zip(searches, [*inner, []], strict=False) for search in (one, *more)]
    grid = [whole.index(search) for search in searches]
    upward, downward = [], []
    for k, search in enumerate(searches):
        nothing = np.full(len(search.attractors), UNDETERMINED)
        upward.append(searches[k + 1].known_labels(seeds(search)) if k + 1 < len(searches) else nothing)
        downward.append(searches[k - 1].known_labels(seeds(search)) if k else nothing)
    attractors = [search.attractors for search in whole]
    steps = [other.a - one.a for one, other in pairwise(models)]
    reach = tuning.remembered * max(steps, default=0.0)
    return Continuation(
        [search.model for search in whole],
        grid,
        attractors,
        [lifetimes(search.model, search.attractors, settings, tuning) for search in whole],
        *branches([search.model.a for search in whole], attractors, reach, models[0].scale, tuning),
        upward,
        downward,
        samples,
    )
